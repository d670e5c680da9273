#!/usr/bin/env bash
# Compiles a shader to a list of SPIR-V words. No operation on floats is contracted or reordered: each gets the
# decoration NoContraction before the optimizer runs.
# usage: compile.sh SHADER INCLUDE_FOLDER OUT
set -euo pipefail
shader=$1 include=$2 out=$3
ulimit -v 3000000 # KiB; shader compilers can exhaust the memory
glslc --target-env=vulkan1.1 -O0 -Werror -I "$include" "$shader" -o "$out.spv"
spirv-dis --raw-id --no-header "$out.spv" | awk '
  $2 == "=" && $3 ~ /^Op(F(Negate|Add|Sub|Mul|Div)|VectorTimesScalar|Dot)$/ { floats[++count] = $1 }
  { lines[NR] = $0; if (!types && $3 ~ /^OpType/) types = NR }
  END {
    for (i = 1; i <= NR; ++i) {
      if (i == types)
        for (j = 1; j <= count; ++j)
          print "OpDecorate " floats[j] " NoContraction"
      print lines[i]
    }
  }' >"$out.txt"
spirv-as --target-env vulkan1.1 --preserve-numeric-ids "$out.txt" -o "$out.spv"
spirv-opt --target-env=vulkan1.1 --strip-debug -O "$out.spv" -o "$out.spv"
spirv-val --target-env vulkan1.1 "$out.spv"
od -An -v -t u4 "$out.spv" | sed 's/\([0-9]\)\( \|$\)/\1,\2/g' >"$out"
rm "$out.spv" "$out.txt"
