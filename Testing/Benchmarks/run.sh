#!/usr/bin/env bash
# Builds Release, measures error against time over scenes and modes, then single components and the time from
# a change to the first new sample, and writes Testing/Benchmarks/Report. Run it on an idle machine.
# usage: bash Testing/Benchmarks/run.sh [--scenes A,B] [--modes A,B] [--budget CPU-SECONDS] [...]
# All arguments are passed to EfficiencyBenchmark (see its --help). Results of other scenes and modes in
# the report are kept. FENESTRA_BUILD selects another build folder.
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
# get_median_ratio COLUMN: prints the ratio of the product's efficiency to that of the mode in the column.
get_median_ratio() {
  sed -n '/^## Efficiency/,/^## Other/p' "$report/README.md" |
    awk -F '|' -v column="$1" '$4 + 0 > 0 { print $4 / $column }' | sort -g |
    awk '{ ratios[NR] = $1 } END { printf "%.2g", (ratios[int((NR + 1) / 2)] + ratios[int(NR / 2) + 1]) / 2 }'
}
sed -i "/^<!-- speed: /,/^<!-- end of speed/s|^[^<].*|In the median over the benchmark's scenes, Fenestra's \
efficiency, 1 / (relMSE × CPU seconds), is $(get_median_ratio 7) times that of delta tracking with one majorant, and \
$(get_median_ratio 8) times that of ray marching, which is biased.|" "$top/README.md"
# store NAME COMMAND...: prints the output of a command, and stores it as the record NAME if it succeeds.
store() {
  local output=$folder/benchmarks/$1.csv
  "${@:2}" | tee "$output"
  cp "$output" "$report/$1.csv"
}

say "Single components, on one thread"
store components "$folder/bin/MicroBenchmarks" --benchmark_format=csv
say "Time from a change to the first new sample"
store changes "$folder/bin/ChangeBenchmark" TibialCartilage "$folder/benchmarks/knee/knee.mrml" \
  --focus FemoralCartilage --size 256x256
say "Wrote $report/README.md"
