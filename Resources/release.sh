#!/usr/bin/env bash
# Makes DIR/fenestra-VERSION-linux-MACHINE.tar.gz: the program with every library and the loader that it needs, for
# any Linux of the machine's kind; with licences and a bill of materials (SPDX 2.3). The same commit and the same
# packages of Debian make the same bytes, in any folder. release.md tells what is in it.
# usage: bash Resources/release.sh DIR [BUILD]
#   BUILD  folder of a Release build whose program is taken; without it, build/release is built
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
umask 022
export LC_ALL=C # the order of names
parts=$top/Resources/release
[ $# -ge 1 ] || die "usage: release.sh DIR [BUILD]"
out=$(mkdir -p "$1" && cd "$1" && pwd) || die "cannot make folder $1"
epoch=${SOURCE_DATE_EPOCH:-$(git -C "$top" log -1 --format=%ct 2>/dev/null)} ||
  die "set SOURCE_DATE_EPOCH, the archive's date: this is no checkout of git"

if [ $# -ge 2 ]; then
  build=$(cd "$2" && pwd) || die "no such build: $2"
else
  build=$top/build/release
  install_packages "${build_packages[@]}" patchelf
  say "Building (some minutes the first time)"
  # Neither the folder nor a linker that not everybody has may change the program.
  cmake -S "$top" --preset release -B "$build" -DFENESTRA_BUILD_TESTS=OFF -DFENESTRA_DEVELOPER=OFF \
    -DFENESTRA_HAS_LLD=OFF -DCMAKE_CXX_FLAGS="-ffile-prefix-map=$top/=" >/dev/null || die "cannot configure (see above)"
  cmake --build "$build" --target fenestra || die "the build failed (see above)"
fi
command -v patchelf >/dev/null || die "needs patchelf (Debian: patchelf)"
version=$(sed -n 's/^CMAKE_PROJECT_VERSION:STATIC=//p' "$build/CMakeCache.txt")
name=fenestra-$version-linux-$(uname -m)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
root=$work/$name
mkdir -p "$root"/{lib,libexec,licenses/common}

# leave_out LIBRARY MACRO [SYMBOLS' VERSION]: an empty library of that name, so that nothing below it is needed.
leave_out() {
  local options=()
  if [ $# -eq 3 ]; then
    printf '%s { *; };\n' "$3" >"$work/versions"
    options=("-Wl,--version-script=$work/versions")
  fi
  cc -shared -fPIC -O2 -Wl,--build-id=none "-D$2" "-Wl,-soname,$1" "${options[@]}" "$parts/absent.c" \
    -o "$root/lib/$1"
}
leave_out libcurl.so.4 ABSENT_CURL CURL_OPENSSL_4
leave_out libjbig.so.0 ABSENT_JBIG
own=" libcurl.so.4 libjbig.so.0 "

# The program, and what the loader finds for it.
cmake --install "$build" --prefix "$root" --component program --strip >/dev/null
mv "$root/bin/fenestra" "$root/libexec/fenestra"
install -m 755 "$parts/launcher.sh" "$root/bin/fenestra"
found=$(LD_LIBRARY_PATH=$root/lib ldd "$build/bin/fenestra")
! grep 'not found' <<<"$found" || die "the program needs libraries that are not here (see above)"
loader=$(patchelf --print-interpreter "$build/bin/fenestra")
declare -A origin=([ld.so]=$loader) # file of each library
while read -r library file; do
  [[ $own == *" $library "* ]] || origin[$library]=$file
done < <(awk '/=> \//{ print $1, $3 }' <<<"$found")
tbb=$(dirname "${origin[libtbb.so.12]}")
origin[libtbbmalloc.so.2]=$tbb/libtbbmalloc.so.2 # asked for by oneTBB, as soon as it works
for library in "${!origin[@]}"; do
  cp -L "${origin[$library]}" "$root/lib/$library"
done
# DT_RPATH: it holds for the libraries of libraries, unless one has a path of its own, and comes before the user's
# LD_LIBRARY_PATH. No folder of the system is searched: oneTBB looks for libraries that it can do without, and would
# load one that is made for another libc.
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
