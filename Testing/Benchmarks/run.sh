#!/usr/bin/env bash
# Builds Release with a benchmark program and the phantoms that it renders, and runs it.
# usage: bash Testing/Benchmarks/run.sh PROGRAM [OPTION...]
#   EfficiencyBenchmark, DenoiserBenchmark, AppearanceBenchmark: print CSV (see their --help)
#   MicroBenchmarks, ChangeBenchmark, ShardBenchmark, LoadingBenchmark, SeriesBenchmark, SmoothingBenchmark: see
#   README.md
# FENESTRA_BUILD selects another build folder.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../../Resources/setup.sh"
[ $# -ge 1 ] || die "usage: run.sh PROGRAM [OPTION...]"
folder=${FENESTRA_BUILD:-$top/build}
install_packages "${build_packages[@]}" libbenchmark-dev
{ (cd "$top" && cmake --preset release -B "$folder" -DFENESTRA_BUILD_TESTS=ON >/dev/null &&
  cmake --build "$folder" --target fenestra "$1") || die "the build failed (see above)"
  for phantom in knee foot; do
    [ -e "$folder/benchmarks/$phantom/$phantom.mrb" ] ||
      "$folder/bin/fenestra" phantom "$phantom" --output "$folder/benchmarks/$phantom"
  done
} >&2
"$folder/bin/$1" "${@:2}"
