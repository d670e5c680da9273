#!/usr/bin/env bash
# clang-format over every source file, clang-tidy over the library's. usage: bash Testing/style.sh
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../Resources/setup.sh"
install_packages clang-format clang-tidy
cd "$top"
say "clang-format"
git ls-files '*.h' '*.cxx' | xargs clang-format --dry-run --Werror || die "run clang-format -i on the files above"
say "clang-tidy"
[ -f build/compile_commands.json ] || die "build first: bash Testing/run.sh"
# One instruction set is enough: the lanes' sources are the same for all.
git ls-files 'Renderer/*.cxx' | xargs -P "$(nproc)" -n 4 clang-tidy -p build --quiet \
  --extra-arg=-DHWY_COMPILE_ONLY_STATIC 2>/dev/null ||
  die "clang-tidy found the above"
say "style is fine"
