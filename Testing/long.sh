#!/usr/bin/env bash
# The long version of everything that checks, and its record: Testing/Report. An hour or several.
# usage: bash Testing/long.sh [STAGE...]
# Stages, in this order where none is named:
#   accuracy      Release: the statistical, stress and regression tests with long budgets
#   seeds         the short matrix with twenty seed bases, on every instruction set
#   planted       the errors planted in a copy of the renderer
#   instructions  the statistical tests and the planted errors on every instruction set
#   addresses     the whole suite under AddressSanitizer and UndefinedBehaviorSanitizer, each access
#                 checked
#   threads       the whole suite under ThreadSanitizer, with a oneTBB that it can see into
#   clang         the whole suite, and the benchmarks that nothing tests, built by clang
#   headers       each header of the renderer compiled alone
#   faults        every fault that Testing/Faults makes, and 20,000 damaged files
#   films         200 kills of a render that keeps a film, a picture merged from 16 parts, and
#                 pictures by up to 7 ranks of mpirun
#   study         a study of 12 cases, killed half way; jobs of a real Slurm
#   paths         instructions a path, against the record in Testing/Benchmarks/Report
#   package       the archive in a root with busybox alone, in Debian 11, in the extension's package; built
#                 twice; the Debian package by lintian
# and only where it is named:
#   fuzz          10^6 executions of every fuzz target, in an hour each at most, and 10^4 damaged
#                 files through the child that reads DICOM and transforms
#   boundary      the clipping surface's boundary on sub-pixel rays; what its record says of the
#                 figures is written by hand
# Each stage writes a file of its own there and leaves the others as they are; logs of what failed
# are in build/report.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../Resources/setup.sh"
record=$top/Testing/Report
logs=$top/build/report
labels=(unit statistical stress regression cli slicer)
sets=(AVX3 AVX2 SSE4 SCALAR) # instruction sets, by Highway's names

# in_record FILE COMMAND...: the file of the record becomes what the command prints.
in_record() {
  local file=$record/$1
  shift
  "$@" >"$file.tmp"
  mv "$file.tmp" "$file"
}

# counts LOG START: cells of a table: what passed, was skipped, failed, and seconds since START.
counts() {
  printf '%s | %s | %s | %s' "$(grep -c '   Passed ' "$1")" "$(grep -c '\*\*\*Skipped' "$1")" \
    "$(grep -cE '\*\*\*(Failed|Timeout|Exception)' "$1")" $((SECONDS - $2))
}

# run_labels TITLE FOLDER LABEL...: runs tests by label and prints a table of what came of them.
run_labels() {
  local title=$1 folder=$2
  shift 2
  printf '# %s\n\n' "$title"
  printf '| tests | passed | skipped | failed | seconds |\n|---|---|---|---|---|\n'
  local label start log
  for label in "$@"; do
    log=$logs/$(basename "$folder")-$label.log
    start=$SECONDS
    ctest --test-dir "$folder" -L "^$label\$" -j"$(nproc)" \
      --output-on-failure >"$log" 2>&1 || say "some $label tests failed: see $log" >&2
    printf '| %s | %s |\n' "$label" "$(counts "$log" "$start")"
  done
}

stage_accuracy() {
  build release -DFENESTRA_BUILD_TESTS=ON -DFENESTRA_TEST_READERS=ON
  {
    printf '# Pictures converged by independent renderers\n\n'
    printf '| who, scene | values | mean of z | deviation of z | image means in errors |\n|---|---|---|---|---|\n'
  } >"$record/references.md"
  FENESTRA_LONG=1 FENESTRA_REPORT=$record in_record accuracy.md \
    run_labels 'Statistical, stress and regression tests with long budgets' "$top/build" \
    statistical stress regression
}

# machine_has SET: whether programs can be pinned to an instruction set here.
machine_has() {
  FENESTRA_INSTRUCTIONS=$1 "$top/build/bin/MatrixTests" --gtest_list_tests >/dev/null 2>&1
}

# seed_row SET SEED: a row of the table, in $rows/SET-SEED.
seed_row() {
  local held=yes out
  out=$(FENESTRA_INSTRUCTIONS=$1 FENESTRA_SEED=$2 "$top/build/bin/MatrixTests" --gtest_filter='*fast') || held=no
  printf '| %s | %s | %s%s |\n' "$1" "$2" \
    "$(sed -n 's/.*: probability \([^ ]*\) .*/\1 | /p' <<<"$out" | tr -d '\n')" "$held" >"$rows/$1-$2"
}

# print_seeds FOLDER: the table of the rows in it.
print_seeds() {
  printf '# Twenty seed bases of the short matrix, on every instruction set\n\n'
  printf '| instructions | seed base | %s | all hold |\n|---|---|---|---|---|---|---|---|---|\n' \
    'pixel | tile | picture | tiles uniform | pictures uniform | mean is 0'
  local name seed
  for name in "${sets[@]}"; do
    for seed in $(seq 20); do
      [ ! -e "$1/$name-$seed" ] || cat "$1/$name-$seed"
    done
  done
}

stage_seeds() {
  build release -DFENESTRA_BUILD_TESTS=ON -DFENESTRA_TEST_READERS=ON
  local rows name
  rows=$(mktemp -d)
  export -f seed_row
  for name in "${sets[@]}"; do
    machine_has "$name" || continue
    seq 20 | top=$top rows=$rows xargs -P "$(nproc)" -I{} bash -c "seed_row $name {}"
  done
  in_record seeds.md print_seeds "$rows"
  rm -r "$rows"
}

# Builds what looks for planted errors, for run_planted.
build_planted() {
  build release -DFENESTRA_BUILD_TESTS=ON -DFENESTRA_TEST_READERS=ON
  cmake --build "$top/build" --target PlantedTests
}

# run_planted LOG: looks for them, on FENESTRA_INSTRUCTIONS where that is set.
run_planted() {
  "$top/build/bin/PlantedTests" >"$1" 2>&1
}

stage_planted() {
  build_planted
  FENESTRA_REPORT=$record run_planted "$logs/planted.log" ||
    say "not all planted errors are found: see $logs/planted.log"
}

# run_instructions: prints a table of the statistical tests on each that the machine has.
run_instructions() {
  printf '# The statistical tests on every instruction set\n\nAn error planted in both transports counts as two.\n\n'
  printf '| instructions | passed | skipped | failed | seconds | planted errors found |\n|---|---|---|---|---|---|\n'
  local name start log row
  for name in "${sets[@]}"; do
    machine_has "$name" || continue
    log=$logs/instructions-$name.log
    start=$SECONDS
    FENESTRA_INSTRUCTIONS=$name ctest --test-dir "$top/build" -L '^statistical$' -j"$(nproc)" \
      --output-on-failure >"$log" 2>&1 || say "some tests failed on $name: see $log" >&2
    row=$(counts "$log" "$start")
    log=$logs/planted-$name.log
    FENESTRA_INSTRUCTIONS=$name run_planted "$log" || say "not all planted errors are found on $name: see $log" >&2
    printf '| %s | %s | %s |\n' "$name" "$row" "$(sed -n 's/^planted errors found: //p' "$log")"
  done
}

stage_instructions() {
  build_planted
  in_record instructions.md run_instructions
}

# Sanitizers look at what is computed, not at its error: a fourth of the samples, a tenth of the
# matrix.
smaller=', brief: a fourth of the samples, 24 combinations'

stage_addresses() {
  install_packages clang libclang-rt-14-dev
  (cd "$top" && cmake --preset asan-ubsan -DFENESTRA_CHECK_ACCESSES=ON >/dev/null &&
    cmake --build build-asan-ubsan)
  LSAN_OPTIONS="suppressions=$top/Testing/lsan.supp" FENESTRA_BRIEF=4 FENESTRA_COMBINATIONS=24 \
    in_record addresses.md run_labels "AddressSanitizer and UndefinedBehaviorSanitizer$smaller" \
    "$top/build-asan-ubsan" "${labels[@]}"
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
  (cd "$top" && cmake --preset tsan >/dev/null && cmake --build build-tsan)
  local tbb
  tbb=$(seen_tbb)
  LD_LIBRARY_PATH=$tbb TSAN_OPTIONS=halt_on_error=1 FENESTRA_BRIEF=4 FENESTRA_COMBINATIONS=24 \
    in_record threads.md run_labels "ThreadSanitizer$smaller" "$top/build-tsan" "${labels[@]}"
}

stage_clang() {
  install_packages clang
  (cd "$top" && cmake --preset dev -B build-clang -DCMAKE_CXX_COMPILER=clang++ >/dev/null &&
    cmake --build build-clang --target all MicroBenchmarks ChangeBenchmark LoadingBenchmark)
  in_record clang.md run_labels 'clang' "$top/build-clang" "${labels[@]}"
}

stage_headers() {
  (cd "$top" && cmake --preset dev -B build-headers -DCMAKE_VERIFY_INTERFACE_HEADER_SETS=ON \
    -DFENESTRA_BUILD_TESTS=OFF >/dev/null &&
    cmake --build build-headers --target all_verify_interface_header_sets) >"$logs/headers.log" ||
    say "a header does not stand alone: $logs/headers.log"
}

stage_faults() {
  build release -DFENESTRA_BUILD_TESTS=ON -DFENESTRA_TEST_READERS=ON
  "$top/build/bin/Faults" "$top/build/bin/fenestra" >"$record/faults-in-turn.md" ||
    say "faults do harm: see $record/faults-in-turn.md"
  "$top/build/bin/Mutations" "$top/build/bin/fenestra" 1 20000 >"$record/mutations.md" ||
    say "damaged files do harm: see $record/mutations.md"
}

stage_films() {
  build release -DFENESTRA_BUILD_TESTS=ON -DFENESTRA_TEST_READERS=ON
  "$top/Testing/Cli/kills.sh" "$top/build/bin/fenestra" 200 150 >"$logs/films.log" 2>&1 ||
    say "a killed render does not go on: $logs/films.log"
  FENESTRA_LONG=1 "$top/build/bin/CommandTests" --gtest_filter='MergeCommand.*' >>"$logs/films.log" 2>&1 ||
    say "merged parts are not the picture: $logs/films.log"
  local status=0
  "$top/Testing/Cluster/ranks.sh" "$top/build/bin/fenestra" "$top/build/bin/fenestra-mpi" 1 2 3 7 \
    >"$logs/ranks.log" 2>&1 || status=$?
  case $status in
    0) ;;
    77) tail -n 1 "$logs/ranks.log" ;;
    *) say "ranks of mpirun do not make the picture of one process: $logs/ranks.log" ;;
  esac
}

# in_study NAME COMMAND...: a study whose end is in a log; says where it was skipped, or failed.
in_study() {
  local log=$logs/$1.log status=0
  shift
  "$@" >"$log" 2>&1 || status=$?
  case $status in
    0) ;;
    77) tail -n 1 "$log" ;;
    *) say "a study does not end whole: see $log" ;;
  esac
}

stage_study() {
  build release
  local data
  data=$(sed -n 's/^FENESTRA_DATA:PATH=//p' "$top/build/CMakeCache.txt")
  in_study twelve "$top/Testing/Batch/twelve.sh" "$top/build/bin/fenestra" "$data" "$logs/twelve"
  in_study slurm-study "$top/Testing/Cluster/batch.sh" "$top/build/bin/fenestra" "$logs/slurm-study"
  in_study slurm-shards "$top/Testing/Cluster/shards.sh" "$top/build/bin/fenestra" "$logs/slurm-shards"
  in_study slurm-mpi "$top/Testing/Cluster/mpi.sh" "$top/build/bin/fenestra" "$top/build/bin/fenestra-mpi" \
    "$logs/slurm-mpi"
}

stage_paths() {
  bash "$top/Testing/Benchmarks/instructions.sh" >"$logs/paths.log" 2>&1 ||
    say "a path takes more instructions than the record has: $logs/paths.log"
}

stage_package() {
  install_packages patchelf busybox-static jq debootstrap lintian
  build release -DFENESTRA_BUILD_TESTS=ON
  bash "$top/Testing/Package/check.sh" "$top/build" contents moved busybox debian slicer again \
    >"$logs/package.log" 2>&1 || say "the archive does not hold, or a stage was left out: $logs/package.log"
  bash "$top/Testing/Package/deb.sh" "$top/build" strictly >"$logs/deb.log" 2>&1 ||
    say "the Debian package does not hold: $logs/deb.log"
}

stage_boundary() {
  (cd "$top" && cmake --preset release >/dev/null && cmake --build build --target BoundaryCheck)
  (sed '/^## /,$d' "$record/boundary.md" && "$top/build/bin/BoundaryCheck" 256 12) \
    >"$record/boundary.md.tmp"
  mv "$record/boundary.md.tmp" "$record/boundary.md"
}

stage_fuzz() {
  FENESTRA_FUZZ_RUNS=1000000 bash "$top/Testing/Fuzz/run.sh" 3600 >"$logs/fuzz.log" 2>&1 ||
    say "fuzzing found something: $logs/fuzz.log"
  (cd "$top" && cmake --preset release >/dev/null && cmake --build build --target ApartMutations)
  (cd "$logs" && "$top/build/bin/ApartMutations" 10000 >apart.log) ||
    say "damaged files are neither read nor refused: $logs/apart.log"
}

mkdir -p "$logs"
install_packages "${build_packages[@]}" libgmock-dev libboost-dev libbenchmark-dev qtbase5-dev lld
[ $# -gt 0 ] || set -- accuracy seeds planted instructions addresses threads clang headers faults films study paths \
  package
for name in "$@"; do
  say "$name"
  "stage_$name"
done
say "The record is $record/README.md"
