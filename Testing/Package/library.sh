#!/usr/bin/env bash
# Tests the installed library: the example in Resources/embedding is built against it alone, by CMake (shared and
# static) and by pkg-config, and the programs give the same image. Exit status 77: CMake or pkg-config is missing.
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
private=$(nm -C --defined-only "${library%.so}.a" | grep ' [TDB] ' | grep -v 'fenestra::v1::' || true)
[ -z "$private" ] || die "a private name in libfenestra.a: $private"
[ -z "$foreign" ] || die "exported beside the public interface: $foreign"
grep -lE '#include [<"](Eigen|itk|tbb|nlohmann|base|scene)' -r "$work/prefix/include" && die "a public header includes a private one"

for kind in fenestra static; do
  cp -r "$example" "$work/$kind"
  sed -i -e "s/Fenestra::fenestra/Fenestra::$kind/" -e '/find_package/p' "$work/$kind/CMakeLists.txt" # found twice
  cmake -S "$work/$kind" -B "$work/$kind" -DCMAKE_PREFIX_PATH="$work/prefix" -DCMAKE_BUILD_TYPE=Release >"$work/cmake.log" ||
    die "find_package(Fenestra): $(cat "$work/cmake.log")"
  cmake --build "$work/$kind" >>"$work/cmake.log" || die "$(cat "$work/cmake.log")"
done
readelf --dynamic "$work/static/example" | grep -q 'NEEDED.*libfenestra' && die "Fenestra::static needs libfenestra.so"
export PKG_CONFIG_PATH=$(dirname "$(find "$work/prefix" -name fenestra.pc)")
# shellcheck disable=SC2046
"${CXX:-g++}" -std=c++20 "$example/example.cxx" $(pkg-config --cflags --libs fenestra) -o "$work/by-pkg-config"

cd "$work"
fenestra/example first.png
LD_LIBRARY_PATH=$(dirname "$library") ./by-pkg-config second.png
static/example third.png
cmp first.png second.png && cmp first.png third.png || die "the images differ"
[ "$(head -c 4 first.png | tail -c 3)" = PNG ] || die "first.png is no image"
say "The example runs against the installed library"
