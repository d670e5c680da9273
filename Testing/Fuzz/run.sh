#!/usr/bin/env bash
# Builds the fuzz targets with clang and runs them, two at a time (each may use 2 GB). Each runs for SECONDS [5] or
# FENESTRA_FUZZ_RUNS executions, from the seeds in Corpus/ and inputs found by earlier runs (in FENESTRA_FUZZ_DIR
# [build-asan-ubsan/fuzz]), and prints its statistics. Inputs that fail are saved in FENESTRA_FUZZ_DIR/findings, and
# the exit status is 1. usage: run.sh [SECONDS] [TARGET...]
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../../Resources/setup.sh"
seconds=${1:-5}
shift $(($# > 0 ? 1 : 0))
here=$top/Testing/Fuzz
build_folder=${FENESTRA_FUZZ_BUILD:-$top/build-asan-ubsan}
work=${FENESTRA_FUZZ_DIR:-$build_folder/fuzz}

# print_dictionary TARGET: prints the libFuzzer option for its dictionary, if it has one.
print_dictionary() {
  case $1 in
    Checkpoint | Transfer | PropertyJson | Lights | Materials | Preset | Serve) echo "-dict=$here/Dictionaries/Json.dict" ;;
    *) [ ! -f "$here/Dictionaries/$1.dict" ] || echo "-dict=$here/Dictionaries/$1.dict" ;;
  esac
}

# print_summary LOG: prints the statistics of libFuzzer.
print_summary() {
  awk -F': +' '
    /^stat::number_of_executed_units/ { runs = $2 }
    /^stat::average_exec_per_sec/ { rate = $2 }
    /^stat::peak_rss_mb/ { rss = $2 }
    / cov: / { split($0, cov, /cov: /); split(cov[2], edges, " ") }
    END { printf "%10d runs %7d /s  %6d edges  %5d MB", runs, rate, edges[1], rss }' "$1"
}

# fuzz TARGET: runs it; status 1 if an input fails.
fuzz() {
  local target=$1 log=$work/$1.log status=0
  mkdir -p "$work/corpus/$target" "$work/findings"
  # Every exception clears 1 MB of stack shadow memory, which is faster with memset than with mmap.
  local options=detect_leaks=0:allocator_may_return_null=0:clear_shadow_mmap_threshold=4000000
  TMPDIR=$memory ASAN_OPTIONS=$options:quarantine_size_mb=32 FENESTRA_FUZZ_TARGET=$target \
    "$build_folder/bin/Fuzzers" "$work/corpus/$target" "$here/Corpus/$target" \
    -max_total_time="$seconds" -runs="${FENESTRA_FUZZ_RUNS:--1}" -max_len=16384 -timeout=10 \
    -rss_limit_mb=2048 -close_fd_mask=1 -print_final_stats=1 -reload=0 \
    -artifact_prefix="$work/findings/$target-" $(print_dictionary "$target") >"$log" 2>&1 || status=$?
  printf '%-15s %s  %s\n' "$target" "$(print_summary "$log")" \
    "$([ $status -eq 0 ] && echo ok || echo "FINDING, see $log")"
  return $((status != 0))
}

install_packages "${build_packages[@]}" clang libclang-rt-14-dev lld
(cd "$top" && cmake --preset asan-ubsan -B "$build_folder" >/dev/null &&
  cmake --build "$build_folder" --target Fuzzers) || die "the fuzz targets do not build (see above)"

targets=("$@")
[ ${#targets[@]} -gt 0 ] || mapfile -t targets < <(ls "$here/Corpus")
memory=$(mktemp -d -p "$([ -w /dev/shm ] && echo /dev/shm || echo "${TMPDIR:-/tmp}")" fenestra-fuzz-XXXXXX)
trap 'rm -rf "$memory"' EXIT
say "Fuzzing, $seconds s per target"
export -f print_dictionary print_summary fuzz
export here seconds build_folder work memory
printf '%s\n' "${targets[@]}" | xargs -P 2 -I{} bash -c 'fuzz {}' || exit 1
