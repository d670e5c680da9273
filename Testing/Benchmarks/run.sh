#!/usr/bin/env bash
# Builds Release, measures error against time over scenes and modes, and the parts one by one, and
# writes Testing/Benchmarks/Report. Nothing else should run on the machine.
# usage: bash Testing/Benchmarks/run.sh [--scenes A,B] [--modes A,B] [--budget CPU-SECONDS] [...]
# All arguments are EfficiencyBenchmark's own, which --help lists; what the report holds of other
# scenes and modes stays. FENESTRA_BUILD names another build folder.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../../Resources/setup.sh"
folder=${FENESTRA_BUILD:-$top/build}
report=$top/Testing/Benchmarks/Report

install_packages "${build_packages[@]}" libbenchmark-dev
(cd "$top" && cmake --preset release -B "$folder" -DFENESTRA_BUILD_TESTS=ON >/dev/null &&
  cmake --build "$folder" --target fenestra EfficiencyBenchmark MicroBenchmarks \
    ChangeBenchmark) ||
  die "the build failed (see above)"
mkdir -p "$folder/benchmarks"
for phantom in knee foot; do
  [ -e "$folder/benchmarks/$phantom/$phantom.mrb" ] ||
    "$folder/bin/fenestra" phantom "$phantom" --output "$folder/benchmarks/$phantom"
done

say "Error against time"
"$folder/bin/EfficiencyBenchmark" --output "$report" "$@"
# The README quotes medians over all scenes.
# median_ratio COLUMN: of the product's efficiency and that of the mode in the column.
median_ratio() {
  sed -n '/^## Efficiency/,/^## Other/p' "$report/README.md" |
    awk -F '|' -v column="$1" '$4 + 0 > 0 { print $4 / $column }' | sort -g |
    awk '{ ratios[NR] = $1 } END { printf "%.2g", (ratios[int((NR + 1) / 2)] + ratios[int(NR / 2) + 1]) / 2 }'
}
sed -i "/^<!-- speed: /,/^<!-- end of speed/s|^[^<].*|In the median of the benchmark's scenes it has \
$(median_ratio 7) times the efficiency, 1 / (relMSE × CPU seconds), of delta tracking with one majorant, and \
$(median_ratio 8) times that of ray marching, which is biased.|" "$top/README.md"
say "The parts, on one thread"
"$folder/bin/MicroBenchmarks" --benchmark_format=console | tee "$folder/benchmarks/parts.txt"
{
  printf '# The parts, on one thread\n\nMade by `bash Testing/Benchmarks/run.sh`.\n\n```\n'
  cat "$folder/benchmarks/parts.txt"
  printf '```\n'
} >"$report/parts.md"
say "From a change to the first new sample"
{
  printf '# From a change to the first new sample, by the clock\n\n'
  printf 'The knee at 256 × 256. Made by `bash Testing/Benchmarks/run.sh`.\n\n'
  "$folder/bin/ChangeBenchmark" TibialCartilage "$folder/benchmarks/knee/knee.mrml" \
    --focus FemoralCartilage --size 256x256
} >"$report/changes.md"
say "The report is $report/README.md"
