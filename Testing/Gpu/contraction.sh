#!/usr/bin/env bash
# Checks that the GPU's shader allows no contraction: each operation on floats has the decoration NoContraction.
# usage: contraction.sh SHADER.inc, the list of words that compile.sh makes
set -euo pipefail
spirv=$(mktemp)
trap 'rm -f "$spirv"' EXIT
perl -0777 -ne 'print pack "V*", /\d+/g' "$1" >"$spirv"
spirv-dis --raw-id --no-header "$spirv" | awk '
  $1 == "OpDecorate" && $3 == "NoContraction" { isExact[$2] = 1 }
  $2 == "=" && $3 ~ /^Op(F(Negate|Add|Sub|Mul|Div|Rem|Mod)|(Vector|Matrix)Times[A-Za-z]+|OuterProduct|Dot)$/ {
    ++count
    if (!isExact[$1]) { ++failed; print "may be contracted: " $0 }
  }
  $2 == "=" && $3 == "OpExtInst" && $6 == "Fma" { ++failed; print "contracted: " $0 }
  END { print count " operations on floats"; exit failed || count < 100 }'
