#!/usr/bin/env bash
# Compiles all files of Renderer/formulas as GLSL, in less than 3 GB. usage: bash Testing/Formulas/compile.sh
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
renderer=$here/../../Renderer
for file in "$renderer"/formulas/*.inl; do
  grep -q "\"formulas/${file##*/}\"" "$here/Formulas.comp" || { echo "Formulas.comp does not include ${file##*/}"; exit 1; }
done
command -v glslc >/dev/null || { echo "SKIPPED: no glslc"; exit 77; }
ulimit -v 3000000
glslc --target-env=vulkan1.1 -O0 -Werror -I "$renderer" "$here/Formulas.comp" -o /dev/null
