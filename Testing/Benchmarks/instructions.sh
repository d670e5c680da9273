#!/usr/bin/env bash
# Builds Release, counts instructions per path (callgrind, AVX2, one thread), and compares the counts with
# Testing/Benchmarks/instructions.csv. Exits with status 1 and names each scene that needs over 3 %
# more. Takes about three minutes; also on a busy machine.
# usage: bash Testing/Benchmarks/instructions.sh [--record | --program FILE]
#   --record        stores the counts as the new record, even if they are worse
#   --program FILE  counts in another fenestra executable (such as another commit's) and builds nothing
# FENESTRA_BUILD selects another build folder, FENESTRA_REFERENCE that of S1, S2 and S2hi
# (../shared/reference next to the project); missing scenes are skipped.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../../Resources/setup.sh"
folder=${FENESTRA_BUILD:-$top/build}
reference=${FENESTRA_REFERENCE:-$top/../shared/reference}
work=$folder/benchmarks/instructions
record=$top/Testing/Benchmarks/instructions.csv
program=
mode=${1:-compare}
case $mode in
--help) exec sed -n '2,/^set/s/^# \?//p' "$0" ;;
--program) program=$(realpath -e "${2:-}") || die "--program: expected a file" ;;
--record | compare) ;;
*) die "$mode: unknown option; see --help" ;;
esac

size=128x128
counts=(1 17) # samples per pixel; the difference is one block of stratified samples (base/Sampler.h)
tolerance=3   # percent

# count_instructions SAMPLES ARGUMENT...: prints the instructions and the paths of a render.
count_instructions() {
  FENESTRA_INSTRUCTIONS=AVX2 LD_PRELOAD=$work/timer.so valgrind --tool=callgrind --callgrind-out-file=/dev/null \
    "$program" "${@:2}" --samples "$1" --seed 1 --threads 1 --progress none \
    --output "$work/image.exr" --stats-json "$work/stats.json" >"$work/log.txt" 2>&1 ||
    { tail -n 15 "$work/log.txt" >&2; die "callgrind failed (log: $work/log.txt)"; }
  sed -n 's/.*Collected : //p' "$work/log.txt"
  sed -n 's/.*"paths": \([0-9]*\),/\1/p' "$work/stats.json"
}

# count_per_path ARGUMENT...: prints the instructions per path, without the constant part of a render.
count_per_path() {
  local few many
  few=$(count_instructions "${counts[0]}" "$@") || exit
  many=$(count_instructions "${counts[1]}" "$@") || exit
  awk -v few="$few" -v many="$many" \
    'BEGIN { split(few, f, "\n"); split(many, m, "\n"); printf "%.0f", (m[1] - f[1]) / (m[2] - f[2]) }'
}

# get_recorded SCENE: prints the recorded instructions per path, or nothing if they are missing.
get_recorded() {
  [ ! -e "$record" ] || awk -F , -v scene="$1" '$1 == scene { print $2 }' "$record"
}

install_packages "${build_packages[@]}" valgrind
mkdir -p "$work" && work=$(realpath "$work")
if [ -z "$program" ]; then
  (cd "$top" && cmake --preset release -B "$folder" >/dev/null && cmake --build "$folder" --target fenestra) ||
    die "the build failed (see above)"
  program=$(realpath "$folder/bin/fenestra")
fi
knee=$(realpath "$folder")/benchmarks/knee
[ -e "$knee/knee.mrb" ] || "$program" phantom knee --output "$knee"
# Replaces Highway's timer, which fenestra links but never calls: valgrind lacks its instructions on some CPUs.
c++ -shared -fPIC -x c++ -o "$work/timer.so" - <<'CODE'
#include <cstdint>
namespace hwy::platform { std::uint64_t TimerResolution() { return 100; } double Now() { return 0; } }
CODE

compiler=$(sed -n 's/^CMAKE_CXX_COMPILER:[A-Z]*=//p' "$folder/CMakeCache.txt" 2>/dev/null || true)
compiler=$("${compiler:-c++}" --version | head -n 1 | tr , ' ')
say "Instructions per path"
rows=() slower=()
for scene in S1 S2 S2hi knee; do
  before=$(get_recorded $scene)
  arguments=("$knee/knee.mrml" --focus FemoralCartilage --clip surface --clip-boundary exact --materials none --size $size)
  if [ $scene != knee ]; then
    if [ ! -e "$reference/$scene.arguments" ]; then
      echo "$scene: SKIPPED, not found in $reference"
      rows+=("$(grep "^$scene," "$record" 2>/dev/null || echo "$scene,,,,")")
      continue
    fi
    mapfile -t arguments < <(sed "/^--size\$/{n;s/.*/$size/}" "$reference/$scene.arguments")
  fi
  now=$(cd "$reference" 2>/dev/null || true; count_per_path "${arguments[@]}")
  echo "$scene: $now (record: ${before:-none})"
  awk -v now="$now" -v before="${before:-0}" "BEGIN { exit !(now > before * (1 + $tolerance / 100)) }" &&
    slower+=("$scene")
  rows+=("$scene,$now,$(date +%F),$compiler,$(valgrind --version)")
done
if [ "$mode" = --record ]; then
  header=scene,instructions,date,compiler,valgrind
  printf '%s\n' "$header" "${rows[@]}" >"$record.tmp"
  mv "$record.tmp" "$record"
  say "Wrote $record"
elif [ ${#slower[@]} -gt 0 ]; then
  die "over $tolerance % more instructions per path than recorded, or no record: ${slower[*]}"
fi
