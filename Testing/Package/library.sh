#!/usr/bin/env bash
# Tests the installed library: the example in Resources/embedding is built against it alone, by CMake and by
# pkg-config, and both programs give the same image. Exit status 77: CMake or pkg-config is missing.
# usage: bash Testing/Package/library.sh BUILD
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../../Resources/setup.sh"
build=$(cd "$1" && pwd)
example=$top/Resources/embedding
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
command -v pkg-config >/dev/null || { printf 'SKIPPED: needs pkg-config\n' >&2; exit 77; }

cmake --install "$build" --component library --prefix "$work/prefix" >"$work/install.log"
library=$(find "$work/prefix" -name 'libfenestra.so')
[ -n "$library" ] || die "libfenestra.so was not installed"
foreign=$(nm -DC --defined-only "$library" | grep -v -e 'fenestra::v1::' -e ' A FENESTRA_' || true)
[ -z "$foreign" ] || die "exported beside the public interface: $foreign"
grep -lE '#include [<"](Eigen|itk|tbb|nlohmann|base|scene)' -r "$work/prefix/include" && die "a public header includes a private one"

cmake -S "$example" -B "$work/cmake" -DCMAKE_PREFIX_PATH="$work/prefix" -DCMAKE_BUILD_TYPE=Release >"$work/cmake.log" ||
  die "find_package(Fenestra): $(cat "$work/cmake.log")"
cmake --build "$work/cmake" >>"$work/cmake.log" || die "$(cat "$work/cmake.log")"
export PKG_CONFIG_PATH=$(dirname "$(find "$work/prefix" -name fenestra.pc)")
# shellcheck disable=SC2046
"${CXX:-g++}" -std=c++20 "$example/example.cxx" $(pkg-config --cflags --libs fenestra) -o "$work/by-pkg-config"

cd "$work"
cmake/example first.png
LD_LIBRARY_PATH=$(dirname "$library") ./by-pkg-config second.png
cmp first.png second.png || die "the images differ"
[ "$(head -c 4 first.png | tail -c 3)" = PNG ] || die "first.png is no image"
say "The example runs against the installed library"
