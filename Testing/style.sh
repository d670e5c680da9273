#!/usr/bin/env bash
# clang-format over all sources, the spelling list, clang-tidy over the library. usage: bash Testing/style.sh
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../Resources/setup.sh"
install_packages clang-format clang-tidy
cd "$top"
say "clang-format"
git ls-files '*.h' '*.cxx' '*.inl' | xargs clang-format --dry-run --Werror || die "run clang-format -i on the files above"
twice=$(git ls-files 'Renderer/*.h' ':!Renderer/include' ':!Renderer/library' | xargs grep -hoE '^(struct|class) \w+( final)?( :| \{)' | awk '{ print $2 }' |
  sort | uniq -d)
[ -z "$twice" ] || die "two types have the same name, which the linker would merge: $twice"
# Names reserved for the compiler, except those that it or the C library defines and fish's helper functions.
reserved=$(git grep -noE '\b(_[A-Z]|\w*__)\w*' -- 'Renderer/*.h' 'Renderer/*.cxx' |
  grep -vE ':(__(repr__|restrict|has_feature|attribute__|builtin_\w+|SANITIZE_\w+|rlimit_resource|fenestra_is)|_SC_\w+|_Exit|_+)$' ||
  true)
[ -z "$reserved" ] || die "names reserved for the compiler: $reserved"
say "spelling"
bash Testing/spelling.sh || die "the words above have another form here: see Testing/spelling.txt"
say "clang-tidy"
# Sources of a folder are checked together, which parses shared headers once. SIMD sources are the same for all
# instruction sets, so one set is enough.
cmake --preset release -B build/style -DFENESTRA_BUILD_TESTS=OFF -DCMAKE_UNITY_BUILD=ON \
  -DCMAKE_UNITY_BUILD_BATCH_SIZE=0 -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON -DCMAKE_EXPORT_COMPILE_COMMANDS=ON >/dev/null
cmake --build build/style --target fenestra_shader >/dev/null
sed -n 's/^ *"file": "\(.*Renderer.*\)",*$/\1/p' build/style/compile_commands.json | grep -vE '/(Commit|ReaderBuild).cxx' |
  xargs -P "$(nproc)" -n 1 clang-tidy -p build/style --quiet \
    --extra-arg=-DHWY_COMPILE_ONLY_STATIC 2>/dev/null ||
  die "clang-tidy found the above"
say "style is fine"
