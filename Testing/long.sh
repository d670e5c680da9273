#!/usr/bin/env bash
# Runs the long version of all checks. Takes several hours.
# usage: bash Testing/long.sh [STAGE...] | record [PART...]
# Stages; without arguments, all of the first group run in this order:
#   accuracy      statistical, stress and regression tests with large sample counts, in Release
#   seeds         the short matrix with twenty seed bases, on every instruction set
#   instructions  statistical tests and mutation testing on every instruction set
#   asan          all tests under AddressSanitizer and UndefinedBehaviorSanitizer, every access checked
#   tsan          all tests under ThreadSanitizer, with an instrumented oneTBB
#   clang         all tests built with clang; also builds the benchmarks
#   headers       compiles each header of the renderer alone
#   faults        every fault of Testing/FaultInjection, and 20,000 corrupted files
#   checkpoints   200 kills of a render with a checkpoint file, an image merged from 16 shards, and images
#                 by up to 7 ranks of mpirun
#   batch         a batch of 12 cases, killed halfway and resumed; jobs on a single-node Slurm cluster
#   paths         CPU instructions per path, compared with Testing/Benchmarks/instructions.csv
#   package       the archive in a root with only Busybox, in Debian 11, in the extension's package; a
#                 reproducible build; the Debian package in lintian; library and Python package in Debian 12
# Only if named as an argument:
#   fuzz          10^6 executions of every fuzz target, at most an hour each, and 10^4 corrupted files
#                 through the sandboxed reader of DICOM and transform files
#   boundary      the boundary of the clipping surface on subpixel rays
# record measures what README and pages cite, in about an hour on two idle cores, or parts of it (matrix, mutations,
# denoiser, efficiency; figures only if named), and writes Testing/Report and the generated parts of the pages. Commit
# sources before. FENESTRA_BUILD selects a configured build, in which the programs are built.
# Logs and tables are in build/report.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../Resources/setup.sh"
logs=$top/build/report
labels=(unit statistical stress regression cli slicer)
sets=(AVX3 AVX2 SSE4 SCALAR) # instruction sets, as named by Highway

# print_table NAME COMMAND...: prints a table and keeps it as NAME.csv.
print_table() {
  "${@:2}" | tee "$logs/$1.csv"
}

# print_counts LOG START: prints CSV cells: tests passed, skipped, failed, and seconds since START.
print_counts() {
  printf '%s,%s,%s,%s' "$(grep -c '   Passed ' "$1")" "$(grep -c '\*\*\*Skipped' "$1")" \
    "$(grep -cE '\*\*\*(Failed|Timeout|Exception)' "$1")" $((SECONDS - $2))
}

all_tests=(-DFENESTRA_BUILD_TESTS=ON -DFENESTRA_TEST_READERS=ON -DFENESTRA_LONG_TESTS=ON)

# run_labels FOLDER LABEL...: runs the tests with these labels and prints a table of the results.
run_labels() {
  local folder=$1
  shift
  printf 'tests,passed,skipped,failed,seconds\n'
  local label start log
  for label in "$@"; do
    log=$logs/$(basename "$folder")-$label.log
    start=$SECONDS
    ctest --test-dir "$folder" -L "^$label\$" -j"$(nproc)" \
      --output-on-failure >"$log" 2>&1 || say "some $label tests failed: see $log" >&2
    printf '%s,%s\n' "$label" "$(print_counts "$log" "$start")"
  done
}

stage_accuracy() {
  build release "${all_tests[@]}"
  FENESTRA_LONG=1 print_table accuracy run_labels "$top/build" statistical stress regression
}

# has_instructions SET: true if programs can be pinned to an instruction set on this machine.
has_instructions() {
  FENESTRA_INSTRUCTIONS=$1 "$top/build/bin/MatrixTests" --gtest_list_tests >/dev/null 2>&1
}

# write_seed_row SET SEED: writes a row of the table to $rows/SET-SEED.
write_seed_row() {
  local passed=yes out
  out=$(FENESTRA_INSTRUCTIONS=$1 FENESTRA_SEED=$2 "$top/build/bin/MatrixTests" --gtest_filter='*simd') || passed=no
  printf '%s,%s,%s%s\n' "$1" "$2" \
    "$(sed -n 's/.*: probability \([^ ]*\) .*/\1,/p' <<<"$out" | tr -d '\n')" "$passed" >"$rows/$1-$2"
}

# print_seeds FOLDER: prints the table of the rows in a folder.
print_seeds() {
  printf 'instruction set,seed base,pixel,tile,image,tiles uniform,images uniform,mean is 0,all pass\n'
  local name seed
  for name in "${sets[@]}"; do
    for seed in $(seq 20); do
      [ ! -e "$1/$name-$seed" ] || cat "$1/$name-$seed"
    done
  done
}

stage_seeds() {
  build release "${all_tests[@]}"
  local rows name
  rows=$(mktemp -d)
  export -f write_seed_row
  for name in "${sets[@]}"; do
    has_instructions "$name" || continue
    seq 20 | top=$top rows=$rows xargs -P "$(nproc)" -I{} bash -c "write_seed_row $name {}"
  done
  print_table seeds print_seeds "$rows"
  rm -r "$rows"
}

# run_instructions: prints a table of the statistical tests and mutations on each instruction set.
run_instructions() {
  printf 'instruction set,passed,skipped,failed,seconds,mutations found\n'
  local name start log row
  for name in "${sets[@]}"; do
    has_instructions "$name" || continue
    log=$logs/instructions-$name.log
    start=$SECONDS
    FENESTRA_INSTRUCTIONS=$name ctest --test-dir "$top/build" -L '^statistical$' -j"$(nproc)" \
      --output-on-failure >"$log" 2>&1 || say "some tests failed on $name: see $log" >&2
    row=$(print_counts "$log" "$start")
    log=$logs/mutations-$name.log
    FENESTRA_INSTRUCTIONS=$name "$top/build/bin/MutationTests" >"$log" 2>&1 ||
      say "some mutations were not found on $name: see $log" >&2
    printf '%s,%s,%s\n' "$name" "$row" "$(sed -n 's/^mutations found: //p' "$log")"
  done
}

stage_instructions() {
  build release "${all_tests[@]}"
  cmake --build "$top/build" --target MutationTests
  print_table instruction-sets run_instructions
}

# Sanitizers check memory accesses and threads, not errors of the result, so fewer samples suffice:
# FENESTRA_BRIEF=4 divides the sample counts by 4, and the matrix has 24 combinations.

stage_asan() {
  install_packages clang libclang-rt-14-dev
  (cd "$top" && cmake --preset asan-ubsan -DFENESTRA_CHECK_ACCESSES=ON >/dev/null &&
    cmake --build build-asan-ubsan)
  LSAN_OPTIONS="suppressions=$top/Testing/lsan.supp" FENESTRA_BRIEF=4 FENESTRA_COMBINATIONS=24 \
    print_table address-sanitizer run_labels "$top/build-asan-ubsan" "${labels[@]}"
}

# build_tbb: builds oneTBB with ThreadSanitizer, which cannot see the synchronization of Debian's library. Prints its
# folder.
build_tbb() {
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

stage_tsan() {
  (cd "$top" && cmake --preset tsan >/dev/null && cmake --build build-tsan)
  local tbb
  tbb=$(build_tbb)
  LD_LIBRARY_PATH=$tbb TSAN_OPTIONS=halt_on_error=1 FENESTRA_BRIEF=4 FENESTRA_COMBINATIONS=24 \
    print_table thread-sanitizer run_labels "$top/build-tsan" "${labels[@]}"
}

stage_clang() {
  install_packages clang
  (cd "$top" && cmake --preset dev -B build-clang -DCMAKE_CXX_COMPILER=clang++ >/dev/null &&
    cmake --build build-clang --target all MicroBenchmarks ChangeBenchmark ShardBenchmark LoadingBenchmark \
      CorruptedFiles MakeSamples MakeBaselines)
  print_table clang run_labels "$top/build-clang" "${labels[@]}" benchmark
}

stage_headers() {
  (cd "$top" && cmake --preset dev -B build-headers -DCMAKE_VERIFY_INTERFACE_HEADER_SETS=ON \
    -DFENESTRA_BUILD_TESTS=OFF -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON >/dev/null &&
    cmake --build build-headers --target all_verify_interface_header_sets) >"$logs/headers.log" ||
    say "a header does not compile alone: $logs/headers.log"
}

stage_faults() {
  build release "${all_tests[@]}"
  cmake --build "$top/build" --target CorruptedFiles
  local program=$top/build/bin/fenestra log
  log=$logs/fault-injection.log
  print_table fault-injection "$top/build/bin/FaultInjection" "$program" 2> >(tee "$log" >&2) ||
    say "faults violate an invariant: see $log"
  log=$logs/corrupted-files.log
  print_table corrupted-files "$top/build/bin/CorruptedFiles" "$program" 1 20000 2> >(tee "$log" >&2) ||
    say "corrupted files violate an invariant: see $log"
}

stage_checkpoints() {
  build release "${all_tests[@]}"
  "$top/Testing/Cli/kills.sh" "$top/build/bin/fenestra" 200 150 >"$logs/checkpoints.log" 2>&1 ||
    say "a killed render resumes incorrectly: $logs/checkpoints.log"
  FENESTRA_LONG=1 "$top/build/bin/CommandTests" --gtest_filter='MergeCommand.*' >>"$logs/checkpoints.log" 2>&1 ||
    say "merged shards differ from the image: $logs/checkpoints.log"
  local status=0
  "$top/Testing/Cluster/ranks.sh" "$top/build/bin/fenestra" "$top/build/bin/fenestra-mpi" 1 2 3 7 \
    >"$logs/ranks.log" 2>&1 || status=$?
  case $status in
    0) ;;
    77) tail -n 1 "$logs/ranks.log" ;;
    *) say "images by several ranks differ from that of one process: $logs/ranks.log" ;;
  esac
}

# run_logged NAME COMMAND...: runs a script with its output in a log, and reports a failure or a skip.
run_logged() {
  local log=$logs/$1.log status=0
  shift
  "$@" >"$log" 2>&1 || status=$?
  case $status in
    0) ;;
    77) tail -n 1 "$log" ;;
    *) say "a batch or a job failed: see $log" ;;
  esac
}

stage_batch() {
  build release
  local data
  data=$(sed -n 's/^FENESTRA_DATA:PATH=//p' "$top/build/CMakeCache.txt")
  run_logged twelve "$top/Testing/Batch/twelve.sh" "$top/build/bin/fenestra" "$data" "$logs/twelve"
  run_logged slurm-batch "$top/Testing/Cluster/batch.sh" "$top/build/bin/fenestra" "$logs/slurm-batch"
  run_logged slurm-shards "$top/Testing/Cluster/shards.sh" "$top/build/bin/fenestra" "$logs/slurm-shards"
  run_logged slurm-mpi "$top/Testing/Cluster/mpi.sh" "$top/build/bin/fenestra" "$top/build/bin/fenestra-mpi" \
    "$logs/slurm-mpi"
}

stage_paths() {
  bash "$top/Testing/Benchmarks/instructions.sh" >"$logs/paths.log" 2>&1 ||
    say "a path takes more instructions than recorded: $logs/paths.log"
}

stage_package() {
  install_packages patchelf busybox-static jq debootstrap lintian
  build release -DFENESTRA_BUILD_TESTS=ON -DFENESTRA_LONG_TESTS=ON
  bash "$top/Testing/Package/check.sh" "$top/build" contents moved busybox debian slicer again \
    >"$logs/package.log" 2>&1 || say "the archive has errors, or a stage was skipped: $logs/package.log"
  bash "$top/Testing/Package/deb.sh" "$top/build" strictly >"$logs/deb.log" 2>&1 ||
    say "the Debian package has errors: $logs/deb.log"
  bash "$top/Testing/Package/root.sh" "$top/build" >"$logs/root.log" 2>&1 ||
    say "the library does not run in Debian 12, or the stage was skipped: $logs/root.log"
}

stage_boundary() {
  (cd "$top" && cmake --preset release -DFENESTRA_LONG_TESTS=ON >/dev/null && cmake --build build --target BoundaryCheck)
  print_table boundary-views "$top/build/bin/BoundaryCheck" 256 12
}

stage_fuzz() {
  FENESTRA_FUZZ_RUNS=1000000 bash "$top/Testing/Fuzz/run.sh" 3600 >"$logs/fuzz.log" 2>&1 ||
    say "fuzzing found an error: $logs/fuzz.log"
  (cd "$top" && cmake --preset release -DFENESTRA_LONG_TESTS=ON >/dev/null && cmake --build build --target CorruptedSandboxFiles)
  (cd "$logs" && "$top/build/bin/CorruptedSandboxFiles" 10000 >sandbox.log) ||
    say "corrupted files are neither read nor rejected: $logs/sandbox.log"
}

# measure_record [PART...]: measures with one build and stores the results.
measure_record() {
  local folder=${FENESTRA_BUILD:-$top/build}
  [ -n "${FENESTRA_BUILD:-}" ] || build release "${all_tests[@]}"
  cmake --build "$folder" --target fenestra MatrixTests MutationTests DenoiserBenchmark EfficiencyBenchmark
  rm -rf "$logs/record"
  bash "$top/Testing/Report/measure.sh" "$folder" "$logs/record" "$@" || say "not everything was measured (see above)"
  bash "$top/Testing/evidence.sh" store "$logs/record"
}

mkdir -p "$logs"
[ -n "${FENESTRA_BUILD:-}" ] ||
  install_packages "${build_packages[@]}" libgmock-dev libboost-dev libbenchmark-dev qtbase5-dev lld
if [ "${1:-}" = record ]; then
  measure_record "${@:2}"
  exit
fi
[ $# -gt 0 ] || set -- accuracy seeds instructions asan tsan clang headers faults checkpoints batch paths package
for name in "$@"; do
  say "$name"
  "stage_$name"
done
