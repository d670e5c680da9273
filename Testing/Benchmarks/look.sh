#!/usr/bin/env bash
# Builds Release, measures how pictures look with all defaults (spread of lightness over skin, colour
# difference across a focus's edge), and writes Testing/Benchmarks/Report/look.md. About 10 minutes of two
# cores. usage: bash Testing/Benchmarks/look.sh [--scenes A,B] [...]
# All arguments are LookBenchmark's own, which --help lists. FENESTRA_BUILD names another build folder.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../../Resources/setup.sh"
folder=${FENESTRA_BUILD:-$top/build}
page=$top/Testing/Benchmarks/Report/look.md

install_packages "${build_packages[@]}"
(cd "$top" && cmake --preset release -B "$folder" -DFENESTRA_BUILD_TESTS=ON >/dev/null &&
  cmake --build "$folder" --target fenestra LookBenchmark) || die "the build failed (see above)"
knee=$folder/benchmarks/knee
[ -e "$knee/knee.mrb" ] || "$folder/bin/fenestra" phantom knee --output "$knee"
say "The look, scene by scene"
"$folder/bin/LookBenchmark" "$@" | tee "$folder/benchmarks/look.txt"
{
  cat <<'END'
# How pictures look, in numbers

Made by `bash Testing/Benchmarks/look.sh`; the columns are explained [there](../README.md#the-look-lookbenchmark).

END
  cat "$folder/benchmarks/look.txt"
} >"$page"
say "The page is $page"
