#!/usr/bin/env bash
# Builds Release, measures what the filter gains and costs and whether its told error is true, and
# writes Testing/Benchmarks/Report/filter.md. About 40 minutes of two cores, half of them for references,
# which are kept. usage: bash Testing/Benchmarks/filter.sh [--scenes A,B] [--counts 4,16] [--seeds 1] [...]
# All arguments are FilterBenchmark's own, which --help lists. FENESTRA_BUILD names another build folder.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../../Resources/setup.sh"
folder=${FENESTRA_BUILD:-$top/build}
page=$top/Testing/Benchmarks/Report/filter.md

install_packages "${build_packages[@]}"
(cd "$top" && cmake --preset release -B "$folder" -DFENESTRA_BUILD_TESTS=ON >/dev/null &&
  cmake --build "$folder" --target fenestra FilterBenchmark) || die "the build failed (see above)"
knee=$folder/benchmarks/knee
[ -e "$knee/knee.mrb" ] || "$folder/bin/fenestra" phantom knee --output "$knee"
say "The filter, scene by scene"
"$folder/bin/FilterBenchmark" "$@" | tee "$folder/benchmarks/filter.txt"
{
  cat <<'END'
# What the filter gains

Made by `bash Testing/Benchmarks/filter.sh`; the columns are explained [there](../README.md#the-filter-filterbenchmark).

END
  cat "$folder/benchmarks/filter.txt"
} >"$page"
say "The page is $page"
