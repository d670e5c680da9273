#!/usr/bin/env bash
# Holds every tracked text file against spelling.txt. usage: bash Testing/spelling.sh
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
skip=(CHANGELOG.md LICENSE Testing/spelling.txt 'Testing/Data/*' 'Testing/Fuzz/Corpus/*' 'Testing/Fuzz/Sandbox/*' '*.svg')
found=0
while IFS=$'\t' read -r pattern instead files; do
  [[ $pattern && $pattern != \#* ]] || continue
  read -ra allowed <<<"$files"
  exclude=("${skip[@]/#/:(exclude)}" "${allowed[@]/#/:(exclude)}")
  case=(-i)
  [[ $pattern != *[A-Z]* ]] || case=()
  if git grep -nIwE "${case[@]}" -e "$pattern" -- . "${exclude[@]}" |
    grep -vE "${case[@]}" "[\"\`]($pattern)[\"\`]"; then
    printf '   ^ write: %s\n' "$instead"
    found=1
  fi
done <Testing/spelling.txt
exit "$found"
