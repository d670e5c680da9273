#!/usr/bin/env bash
# Builds Release, counts the instructions that a path takes (callgrind, AVX2, one thread), and compares them
# with the record, Testing/Benchmarks/Report/instructions.md: status 1, naming the scene, where one takes
# over 3 % more. About three minutes; what else runs on the machine does not matter.
# usage: bash Testing/Benchmarks/instructions.sh [--record | --program FILE]
#   --record        what is counted becomes the record, whatever it is
#   --program FILE  counts in another fenestra, of another commit perhaps, and builds nothing
# FENESTRA_BUILD names another build folder, FENESTRA_REFERENCE that of S1, S2 and S2hi
# (../shared/reference beside the project); scenes that are not there are skipped.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../../Resources/setup.sh"
folder=${FENESTRA_BUILD:-$top/build}
reference=${FENESTRA_REFERENCE:-$top/../shared/reference}
work=$folder/benchmarks/instructions
record=$top/Testing/Benchmarks/Report/instructions.md
program=
mode=${1:-compare}
case $mode in
--help) exec sed -n '2,/^set/s/^# \?//p' "$0" ;;
--program) program=$(realpath -e "${2:-}") || die "--program: needs a file" ;;
--record | compare) ;;
*) die "$mode: no such flag (--help lists them)" ;;
esac

size=128x128
counts=(1 17) # samples a pixel: between them as many as a block of strata has (base/Sampler.h)
share=3       # percent

# count SAMPLES ARGUMENT...: instructions and paths of a picture.
count() {
  FENESTRA_INSTRUCTIONS=AVX2 LD_PRELOAD=$work/timer.so valgrind --tool=callgrind --callgrind-out-file=/dev/null \
    "$program" "${@:2}" --samples "$1" --seed 1 --threads 1 --progress none \
    --output "$work/picture.exr" --stats "$work/stats.json" >"$work/log.txt" 2>&1 ||
    { tail -n 15 "$work/log.txt" >&2; die "callgrind failed (log: $work/log.txt)"; }
  sed -n 's/.*Collected : //p' "$work/log.txt"
  sed -n 's/.*"paths": \([0-9]*\),/\1/p' "$work/stats.json"
}

# per_path ARGUMENT...: instructions a path, what does not grow with the samples left out.
per_path() {
  local few many
  few=$(count "${counts[0]}" "$@") || exit
  many=$(count "${counts[1]}" "$@") || exit
  awk -v few="$few" -v many="$many" \
    'BEGIN { split(few, f, "\n"); split(many, m, "\n"); printf "%.0f", (m[1] - f[1]) / (m[2] - f[2]) }'
}

# recorded SCENE COLUMN: a cell of the record, nothing where it has none.
recorded() {
  [ ! -e "$record" ] || awk -F ' *[|] *' -v scene="$1" -v column="$2" '$2 == scene { print $column }' "$record"
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
# Highway's timer, which fenestra links but never reads, has instructions that valgrind lacks on some processors.
c++ -shared -fPIC -x c++ -o "$work/timer.so" - <<'CODE'
#include <cstdint>
namespace hwy::platform { std::uint64_t TimerResolution() { return 100; } double Now() { return 0; } }
CODE

say "Instructions a path"
rows=() slower=()
for scene in S1 S2 S2hi knee; do
  before=$(recorded $scene 5)
  arguments=("$knee/knee.mrml" --focus FemoralCartilage --clip surface --boundary exact --materials none --size $size)
  if [ $scene != knee ]; then
    if [ ! -e "$reference/$scene.arguments" ]; then
      echo "$scene: SKIPPED, not in $reference"
      rows+=("| $scene | $(recorded $scene 3) | $(recorded $scene 4) | $before |")
      continue
    fi
    mapfile -t arguments < <(sed "/^--size\$/{n;s/.*/$size/}" "$reference/$scene.arguments")
  fi
  now=$(cd "$reference" 2>/dev/null || true; per_path "${arguments[@]}")
  echo "$scene: $now, in the record ${before:-none}"
  awk -v now="$now" -v before="${before:-0}" "BEGIN { exit !(now > before * (1 + $share / 100)) }" &&
    slower+=("$scene")
  rows+=("| $scene | $(recorded $scene 3) | $before | $now |")
done
if [ "$mode" = --record ]; then
  compiler=$(sed -n 's/^CMAKE_CXX_COMPILER:[A-Z]*=//p' "$folder/CMakeCache.txt")
  printf '%s\n' '# Instructions a path' '' \
    "Made by \`bash Testing/Benchmarks/instructions.sh --record\` on $(date +%F): AVX2," \
    "$("$compiler" --version | head -n 1), $(valgrind --version), pictures of $size; the columns are" \
    'explained [there](../README.md#instructions-a-path).' '' \
    '| scene | at 044d203 | at the record before | now |' '|---|---|---|---|' "${rows[@]}" >"$record.tmp"
  mv "$record.tmp" "$record"
  say "The record is $record"
elif [ ${#slower[@]} -gt 0 ]; then
  die "over $share % more instructions a path than in the record, or not in it: ${slower[*]}"
fi
