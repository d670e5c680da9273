#!/usr/bin/env bash
# The long version of everything that checks, and its record: Testing/Report. An hour or several.
# usage: bash Testing/long.sh [STAGE...]
# Stages, in this order where none is named:
#   accuracy    Release: the statistical, stress and regression tests with long budgets
#   seeds       the short matrix with twenty seed bases
#   addresses   the whole suite under AddressSanitizer and UndefinedBehaviorSanitizer
#   threads     the whole suite under ThreadSanitizer, with a oneTBB that it can see into
#   clang       the whole suite built by clang
# and only where they are named:
#   fuzz        every fuzz target for ten minutes
#   record      nothing but the record
# Each stage leaves a fragment in build/report; the record is made of those that are there.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../Resources/setup.sh"
fragments=$top/build/report
record=$top/Testing/Report
labels=(unit statistical stress regression cli)

# run_labels FRAGMENT FOLDER LABEL...: runs tests by label and writes a table of what came of them.
# `without` may hold an expression of tests to leave out.
without=
run_labels() {
  local fragment=$1 folder=$2 failed=0
  shift 2
  {
    printf '| tests | passed | skipped | failed | seconds |\n|---|---|---|---|---|\n'
    local label log start
    for label in "$@"; do
      log=$(mktemp)
      start=$SECONDS
      ctest --test-dir "$folder" -L "^$label\$" ${without:+-E "$without"} -j"$(nproc)" \
        --output-on-failure >"$log" 2>&1 || failed=1
      printf '| %s | %s | %s | %s | %s |\n' "$label" "$(grep -c '   Passed ' "$log")" \
        "$(grep -c '\*\*\*Skipped' "$log")" "$(grep -cE '\*\*\*(Failed|Timeout|Exception)' "$log")" \
        $((SECONDS - start))
      [ "$failed" -eq 0 ] || cp "$log" "$fragments/$(basename "$fragment" .md)-$label.log"
      rm -f "$log"
    done
  } >"$fragment.new"
  mv "$fragment.new" "$fragment"
  [ "$failed" -eq 0 ] || say "some tests failed: see $fragment and the logs beside it"
}

stage_accuracy() {
  build release -DFENESTRA_BUILD_TESTS=ON
  rm -f "$fragments/references.md"
  FENESTRA_LONG=1 FENESTRA_REPORT=$fragments \
    run_labels "$fragments/accuracy.md" "$top/build" statistical stress regression
}

# seed_row SEED: a row of the table, in $rows/SEED.
seed_row() {
  local held=yes out
  out=$(FENESTRA_SEED=$1 "$top/build/bin/MatrixTests" --gtest_filter='*fast') || held=no
  printf '| %s | %s%s |\n' "$1" \
    "$(sed -n 's/.*: probability \([^ ]*\) .*/\1 | /p' <<<"$out" | tr -d '\n')" "$held" >"$rows/$1"
}

stage_seeds() {
  build release -DFENESTRA_BUILD_TESTS=ON
  local rows
  rows=$(mktemp -d)
  export -f seed_row
  seq 20 | top=$top rows=$rows xargs -P "$(nproc)" -I{} bash -c 'seed_row {}'
  {
    printf '| seed base | %s | all hold |\n|---|---|---|---|---|---|---|---|\n' \
      'pixel | tile | picture | tiles uniform | pictures uniform | mean is 0'
    local seed
    for seed in $(seq 20); do
      cat "$rows/$seed"
    done
  } >"$fragments/seeds.md.new"
  mv "$fragments/seeds.md.new" "$fragments/seeds.md"
  rm -r "$rows"
}

# Sanitizers look at what is computed, not at its error: a fourth of the samples, a tenth of the
# matrix, and nothing of the renderer's copy with errors planted in it.
planted=^PlantedErrors

stage_addresses() {
  local without=$planted
  install_packages clang libclang-rt-14-dev
  (cd "$top" && cmake --preset asan-ubsan >/dev/null && cmake --build build-asan-ubsan)
  LSAN_OPTIONS="suppressions=$top/Testing/lsan.supp" FENESTRA_BRIEF=4 FENESTRA_COMBINATIONS=24 \
    run_labels "$fragments/addresses.md" "$top/build-asan-ubsan" "${labels[@]}"
}

# A oneTBB under ThreadSanitizer: what Debian ships hides how its threads wait for each other. Says
# where it lies.
seen_tbb() {
  local folder=$top/build-tsan/onetbb
  if [ ! -e "$folder/libtbb.so" ]; then
    mkdir -p "$folder/source"
    sed 's/^Types: deb$/Types: deb-src/' /etc/apt/sources.list.d/debian.sources >"$folder/debian.sources"
    local apt=(-o "Dir::Etc::SourceList=$folder/debian.sources" -o Dir::Etc::SourceParts=-
      -o "Dir::State::Lists=$folder/lists")
    mkdir -p "$folder/lists/partial"
    (cd "$folder/source" && apt-get "${apt[@]}" update && apt-get "${apt[@]}" source --download-only onetbb &&
      tar xf onetbb_*.orig.tar.* --strip-components=1)
    cmake -S "$folder/source" -B "$folder/build" -G Ninja -DCMAKE_BUILD_TYPE=None \
      -DCMAKE_CXX_FLAGS="-O1 -g -fsanitize=thread" -DTBB_TEST=OFF -DTBB_STRICT=OFF -DTBBMALLOC_BUILD=OFF
    cmake --build "$folder/build"
    cp -P "$folder"/build/*/libtbb.so* "$folder"
  fi >&2
  printf '%s' "$folder"
}

stage_threads() {
  local without=$planted
  (cd "$top" && cmake --preset tsan >/dev/null && cmake --build build-tsan)
  local tbb
  tbb=$(seen_tbb)
  LD_LIBRARY_PATH=$tbb TSAN_OPTIONS=halt_on_error=1 FENESTRA_BRIEF=4 FENESTRA_COMBINATIONS=24 \
    run_labels "$fragments/threads.md" "$top/build-tsan" "${labels[@]}"
}

stage_clang() {
  install_packages clang
  (cd "$top" && cmake --preset dev -B build-clang -DCMAKE_CXX_COMPILER=clang++ >/dev/null &&
    cmake --build build-clang)
  run_labels "$fragments/clang.md" "$top/build-clang" "${labels[@]}"
}

stage_fuzz() {
  bash "$top/Testing/Fuzz/run.sh" 600 >"$fragments/fuzz.log" 2>&1 ||
    say "fuzzing found something: $fragments/fuzz.log"
}

stage_record() { :; }

# section TITLE FRAGMENT: a part of the record, where it was made.
section() {
  [ -e "$fragments/$2" ] || return 0
  printf '\n## %s\n\n' "$1"
  cat "$fragments/$2"
}

write_record() {
  mkdir -p "$record"
  {
    printf '# How far Fenestra can be trusted: the record\n\n'
    printf 'Made by `bash Testing/long.sh`. What the tests are: [Statistical](../Statistical/README.md),'
    printf ' [the oracle](../Oracle/README.md), [planted errors](../Statistical/Faults/README.md),'
    printf ' [stress](../Stress/README.md).\n'
    section 'Long version' accuracy.md
    [ ! -e "$fragments/matrix.md" ] || { printf '\n'; cat "$fragments/matrix.md"; }
    section 'Twenty seed bases of the short matrix' seeds.md
    [ ! -e "$fragments/faults.md" ] || { printf '\n'; cat "$fragments/faults.md"; }
    if [ -e "$fragments/references.md" ]; then
      printf '\n## Pictures converged by independent renderers\n\n'
      printf '| who, scene | values | mean of z | deviation of z | image means in errors |\n|---|---|---|---|---|\n'
      sort -u "$fragments/references.md"
    fi
    section 'AddressSanitizer and UndefinedBehaviorSanitizer' addresses.md
    section 'ThreadSanitizer' threads.md
    section 'clang' clang.md
  } >"$record/README.md"
  [ ! -e "$fragments/probabilities.svg" ] || cp "$fragments/probabilities.svg" "$record"
}

mkdir -p "$fragments"
install_packages "${build_packages[@]}" libgmock-dev libboost-dev libbenchmark-dev
[ $# -gt 0 ] || set -- accuracy seeds addresses threads clang
for name in "$@"; do
  say "$name"
  "stage_$name"
  write_record
done
say "The record is $record/README.md"
