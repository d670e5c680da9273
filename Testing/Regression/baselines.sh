#!/usr/bin/env bash
# Regenerates the samples of Testing/Data and all baselines, or only the baselines of these cases. Review the
# changes before you commit them. usage: bash Testing/Regression/baselines.sh [CASE...]
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../../Resources/setup.sh"
binaries=${FENESTRA_BUILD:-$top/build}/bin
data=$top/Testing/Data

install_packages "${build_packages[@]}"
[ -n "${FENESTRA_BUILD:-}" ] || (cd "$top" && cmake --preset release >/dev/null)
cmake --build "$(dirname "$binaries")" --target fenestra MakeSamples MakeBaselines ||
  die "the build failed (see above)"
if [ $# -eq 0 ]; then
  say "Samples"
  mkdir -p "$data/traps"
  "$binaries/MakeSamples" "$data/traps"
  "$binaries/fenestra" phantom knee --size 32x36x16 --output "$data/knee"
  "$binaries/fenestra" phantom cube --size 24 --output "$data/cube"
  "$binaries/fenestra" phantom foot --size 48x24x28 --output "$data/foot"
fi
say "Baselines"
"$binaries/MakeBaselines" "$@"
