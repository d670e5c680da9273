#!/usr/bin/env bash
# Builds DIR/fenestra-VERSION-linux-MACHINE.tar.gz: the program with its libraries and loader, for any Linux on this
# kind of machine, with licenses and a bill of materials (SPDX 2.3). The same commit and Debian packages give the same
# bytes in any folder. release.md describes the contents.
# usage: bash Resources/release.sh [--stale-evidence] DIR [BUILD]
#   BUILD             folder of a Release build that provides the program; without it, build/release is built
#   --stale-evidence  for tests of the archive: also if sources are newer than the measurements that the pages cite
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
umask 022
export LC_ALL=C # for the order of names
parts=$top/Resources/release
if [ "${1:-}" = --stale-evidence ]; then
  shift
else
  bash "$top/Testing/evidence.sh" check ||
    die "sources are newer than the measurements that the pages cite: run bash Testing/long.sh record"
fi
[ $# -ge 1 ] || die "usage: release.sh [--stale-evidence] DIR [BUILD]"
out=$(mkdir -p "$1" && cd "$1" && pwd) || die "cannot make folder $1"
epoch=${SOURCE_DATE_EPOCH:-$(git -C "$top" log -1 --format=%ct 2>/dev/null)} ||
  die "SOURCE_DATE_EPOCH: is not set; outside a git checkout it gives the date of the archive"

if [ $# -ge 2 ]; then
  build=$(cd "$2" && pwd) || die "$2: no such build folder"
else
  build=$top/build/release
  install_packages "${build_packages[@]}" patchelf
  say "Building (takes some minutes the first time)"
  # Independent of the folder and of lld, which may be missing.
  cmake -S "$top" --preset release -B "$build" -DFENESTRA_BUILD_TESTS=OFF -DFENESTRA_DEVELOPER=OFF \
    -DFENESTRA_HAS_LLD=OFF -DCMAKE_CXX_FLAGS="-ffile-prefix-map=$top/=" >/dev/null || die "cmake: cannot configure (see above)"
  cmake --build "$build" --target fenestra || die "the build failed (see above)"
fi
command -v patchelf >/dev/null || die "patchelf: not found; install the Debian package patchelf"
version=$(sed -n 's/^CMAKE_PROJECT_VERSION:STATIC=//p' "$build/CMakeCache.txt")
name=fenestra-$version-linux-$(uname -m)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
root=$work/$name
mkdir -p "$root"/{lib,libexec,licenses/common}

# build_stub LIBRARY MACRO [SYMBOL VERSION]: replaces a library by a stub, so that its dependencies are not needed.
build_stub() {
  local options=()
  if [ $# -eq 3 ]; then
    printf '%s { *; };\n' "$3" >"$work/versions"
    options=("-Wl,--version-script=$work/versions")
  fi
  cc -shared -fPIC -O2 -Wl,--build-id=none "-D$2" "-Wl,-soname,$1" "${options[@]}" "$parts/stubs.c" \
    -o "$root/lib/$1"
}
build_stub libcurl.so.4 STUB_CURL CURL_OPENSSL_4
build_stub libjbig.so.0 STUB_JBIG
stubs=" libcurl.so.4 libjbig.so.0 "

# The program and its libraries.
cmake --install "$build" --prefix "$root" --component program --strip >/dev/null
mv "$root/bin/fenestra" "$root/libexec/fenestra"
install -m 755 "$parts/launcher.sh" "$root/bin/fenestra"
found=$(LD_LIBRARY_PATH=$root/lib ldd "$build/bin/fenestra")
! grep 'not found' <<<"$found" || die "libraries of the program are missing (see above)"
loader=$(patchelf --print-interpreter "$build/bin/fenestra")
declare -A origin=([ld.so]=$loader) # file of each library
while read -r library file; do
  [[ $stubs == *" $library "* ]] || origin[$library]=$file
done < <(awk '/=> \//{ print $1, $3 }' <<<"$found")
tbb=$(dirname "${origin[libtbb.so.12]}")
origin[libtbbmalloc.so.2]=$tbb/libtbbmalloc.so.2 # loaded by oneTBB at run time
for library in "${!origin[@]}"; do
  cp -L "${origin[$library]}" "$root/lib/$library"
done
# DT_RPATH also applies to indirect dependencies (unless a library has its own path) and precedes LD_LIBRARY_PATH.
# System folders are not searched: oneTBB would load optional libraries from there that were built for another libc.
patchelf --force-rpath --set-rpath '$ORIGIN/../lib' "$root/libexec/fenestra"
for library in "${!origin[@]}"; do
  [ -z "$(patchelf --print-rpath "$root/lib/$library")" ] || patchelf --remove-rpath "$root/lib/$library"
done
patchelf --no-default-lib "$root/libexec/fenestra"
patchelf --no-default-lib "$root/lib/libtbb.so.12"

source "$parts/notices.sh"
find_packages
write_notices
write_bill >"$root/fenestra.spdx.json"

archive=$out/$name.tar.gz
tar --sort=name --format=gnu --mtime="@$epoch" --owner=0 --group=0 --numeric-owner --mode=u=rwX,go=rX \
  -C "$work" -cf - "$name" | gzip -n >"$archive.tmp"
mv "$archive.tmp" "$archive"
say "$archive"
(cd "$out" && sha256sum "$name.tar.gz")
