#!/usr/bin/env bash
# Tests the archive that Resources/release.sh makes from a build, in environments without that build. Its results must
# equal those of the build's own program, byte for byte. Exit status 77: a stage was skipped; its message says why.
# usage: bash Testing/Package/check.sh BUILD STAGE...
#   contents  every library has a notice and an acceptable license
#   moved     a path with a space and an umlaut, a symbolic link to it, preloaded libraries: no system library is loaded
#   busybox   a root that contains only Busybox
#   debian    a root with Debian 11 (glibc 2.31), kept in BUILD/package
#   slicer    the extension's package, made by a stand-in for Slicer
#   again     reproducible build: two copies of the sources give the same bytes (many minutes)
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
source "$here/../../Resources/setup.sh"
[ $# -ge 2 ] || die "usage: check.sh BUILD STAGE..."
build=$(cd "$1" && pwd)
shift
missing=
# skip WHY: skips the current stage.
skip() {
  printf 'SKIPPED: %s: %s\n' "$name" "$*" >&2
  missing=77
}
[ -x /bin/busybox ] && ! ldd /bin/busybox >/dev/null 2>&1 && command -v patchelf >/dev/null ||
  { name=archive; skip "needs patchelf and busybox-static"; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# copy_inputs FOLDER: copies inputs for requests.sh.
copy_inputs() {
  local data=$1/data sandbox=$here/../Fuzz/Sandbox
  mkdir -p "$data"/{native,jpeg2000}
  cp "$here"/../Data/traps/{plain.nrrd,layers.seg.nrrd,property.vp,roi.mrk.json} "$here/../Data/cube/cube.mrb" "$data"
  cp "$sandbox/Dicom/native.dcm" "$data/native"
  cp "$sandbox/Dicom/jpeg2000.dcm" "$data/jpeg2000"
  cp "$sandbox/Transform/affine.h5" "$data"
  sed -e 's#\(name="Inner" references="\)\([^"]*\)" matrix[^>]*>#\1storage:ts;\2">#' \
    -e 's#</MRML>#<TransformStorage id="ts" fileName="affine.h5"/></MRML>#' \
    "$here/../Data/traps/scene.mrml" >"$data/transformed.mrml"
}

# compare_results FOLDER: checks that the results in it equal the build's.
compare_results() {
  local file count=0
  while read -r file; do
    cmp "$work/build/out/$file" "$1/out/$file" || die "$name: $file differs from the build's"
    count=$((count + 1))
  done < <(cd "$work/build/out" && find . -type f \
    '(' -name '*.png' -o -name '*.exr' -o -name '*.tif' -o -name '*.nrrd' -o -name 'version.txt' ')' ! -name 'stopped.*')
  [ "$count" -ge 12 ] || die "$name: only $count results, expected at least 12"
  say "$name: $count results equal the build's, byte for byte"
}

# Command for a private mount namespace, in which ROOT gets /proc and /dev/null; the mounts end with it.
if unshare --mount true 2>/dev/null; then
  space=(unshare --mount)
elif unshare --map-root-user --mount true 2>/dev/null; then
  space=(unshare --map-root-user --mount)
else
  space=()
fi
# run_in_root ROOT: runs requests.sh with the archive in that root.
run_in_root() {
  local root=$1
  mkdir -p "$root"/{proc,dev,tmp,opt,work}
  rm -rf "$root"/{opt,work}/*
  touch "$root/dev/null"
  cp -r "$archive" "$root/opt/fenestra"
  copy_inputs "$root/work"
  cp "$here/requests.sh" "$root/work"
  "${space[@]}" bash -c 'mount --rbind /proc "$1/proc" && mount --bind /dev/null "$1/dev/null" &&
    exec env -i PATH=/bin:/usr/bin:/usr/sbin chroot "$1" /bin/sh /work/requests.sh /opt/fenestra/bin/fenestra /work' \
    within "$root" || die "$name: the requests above failed"
  compare_results "$root/work"
}

stage_contents() {
  local bill=$archive/fenestra.spdx.json library license line
  while read -r library; do
    line=$(grep -F "\"fileName\":\"./$library\"" "$bill") || die "$library is not in the bill of materials"
    grep -q "$(sha256sum <"$archive/$library" | cut -c1-64)" <<<"$line" || die "$library: wrong checksum in the bill of materials"
  done < <(cd "$archive" && find lib libexec -type f)
  while read -r library; do
    [ -s "$archive/licenses/$library.txt" ] || die "$library has no notice"
  done < <(sed -n 's/.*"SPDXID":"SPDXRef-[^"]*","name":"\([^"]*\)","versionInfo".*/\1/p' "$bill" | grep -vx fenestra)
  while read -r license; do
    [[ ! ${license//GPL-3.0-or-later WITH GCC-exception-3.1/} =~ [^L]GPL ]] || die "license not allowed: $license"
  done < <(grep -o '"licenseConcluded":"[^"]*"' "$bill" | sort -u)
  [ ! -e "$archive/lib/libITKFFT-5.2.so.1" ] || die "libITKFFT links FFTW, which is under the GPL"
  if command -v jq >/dev/null; then # ids are unique, and every relationship joins two existing items
    jq -e '([.packages[], .files[]] | map(.SPDXID)) as $all | ($all | length == (unique | length)) and
      ([.relationships[] | .relatedSpdxElement] - $all == []) and ([.files[] | .SPDXID] -
      [.relationships[] | .spdxElementId] == [])' "$bill" >/dev/null || die "the bill of materials is inconsistent"
  fi
  say "contents: $(find "$archive/lib" -type f | wc -l) libraries"
}

stage_moved() {
  local folder="$work/zum Üben/a b" trace=$work/trace outside
  mkdir -p "$folder" "$trace" "$work/link ü"
  cp -r "$archive" "$folder/fenestra"
  ln -s "$folder/fenestra/bin/fenestra" "$work/link ü/fenestra"
  copy_inputs "$work/moved"
  # Busybox's shell is static, so it leaves no traces of libraries.
  printf '#!/bin/busybox sh\nexec /bin/busybox sh "%s" "$@"\n' "$work/link ü/fenestra" >"$work/traced"
  chmod +x "$work/traced"
  LD_DEBUG=libs LD_DEBUG_OUTPUT=$trace/of LD_LIBRARY_PATH=/usr/lib/x86_64-linux-gnu \
    LD_PRELOAD=$(ldconfig -p | sed -n 's/.*libz.so.1 .*x86-64.* => //p' | head -n 1) \
    /bin/busybox sh "$here/requests.sh" "$work/traced" "$work/moved" || die "moved: the requests above failed"
  compare_results "$work/moved"
  grep -qF "calling init: $folder/fenestra/libexec/../lib/libopenjp2.so.7" "$trace"/* || die "moved: no trace of libraries"
  outside=$(grep -lE 'init(ialize program)?: .*(libexec/fenestra|fenestra)$' "$trace"/* |
    xargs -d '\n' grep -hE 'search cache=|trying file=|calling init:' |
    grep -vF "$folder/fenestra/" | grep -v 'calling init: fenestra$' || true)
  [ -z "$outside" ] || die "moved: libraries loaded from outside the archive: $outside"
}

stage_busybox() {
  [ ${#space[@]} -gt 0 ] || { skip "no permission to mount"; return; }
  local root=$work/busybox program
  mkdir -p "$root/bin"
  cp /bin/busybox "$root/bin"
  for program in sh readlink mkdir cat grep sleep touch; do
    ln -s busybox "$root/bin/$program"
  done
  run_in_root "$root"
}

stage_debian() {
  local root=$build/package/bullseye
  [ "$(id -u)" = 0 ] && command -v debootstrap >/dev/null || { skip "needs root and debootstrap"; return; }
  if [ ! -e "$root/made" ]; then
    mkdir -p "$root"
    debootstrap --variant=minbase bullseye "$root" >"$build/package/debootstrap.log" 2>&1 ||
      { skip "Debian 11 cannot be downloaded ($build/package/debootstrap.log)"; return; }
    touch "$root/made"
  fi
  chroot "$root" ldd --version | sed -n 1p
  run_in_root "$root"
}

stage_slicer() {
  local folder="$work/Slicer ü" commands
  cmake -S "$here/Slicer" -B "$work/extension" -DPROGRAM="$build/bin/fenestra" >"$work/slicer.log" 2>&1 &&
    (cd "$work/extension" && cpack) >>"$work/slicer.log" 2>&1 ||
    { tail "$work/slicer.log"; die "slicer: packaging failed"; }
  mkdir "$folder"
  tar -C "$folder" -xzf "$work/extension/extension.tar.gz" --strip-components=1
  commands=$folder/lib/Slicer-5.13/cli-modules
  # Slicer takes every executable without a dot in its name for a module, and reads NAME.xml instead of running it.
  [ "$(cd "$commands" && echo *)" = "FenestraCommand FenestraCommand.xml" ] || die "slicer: unexpected files: $(ls "$commands")"
  cmp "$build/bin/fenestra.xml" "$commands/FenestraCommand.xml" || die "slicer: the XML differs from the build's"
  diff -r "$archive" "$folder/lib/Slicer-5.13/fenestra" || die "slicer: the package's archive differs from release.sh's"
  copy_inputs "$work/slicer"
  LD_LIBRARY_PATH=$folder/lib/Slicer-5.13 /bin/busybox sh "$here/requests.sh" "$commands/FenestraCommand" "$work/slicer" ||
    die "slicer: the requests above failed"
  compare_results "$work/slicer"
}

stage_again() {
  local copy commit sums=()
  commit=$(git -C "$top" rev-parse HEAD)
  for copy in one another/place; do
    mkdir -p "$work/$copy"
    git clone -q "$top" "$work/$copy/fenestra"
    git -C "$work/$copy/fenestra" checkout -q "$commit"
    CCACHE_DISABLE=1 bash "$work/$copy/fenestra/Resources/release.sh" --stale-evidence "$work/$copy" \
      >"$work/again.log" 2>&1 ||
      { tail "$work/again.log"; die "again: release.sh failed"; }
    sums+=("$(sha256sum <"$(echo "$work/$copy"/*.tar.gz)")")
  done
  [ "${sums[0]}" = "${sums[1]}" ] || die "two builds differ: ${sums[*]}"
  say "again: both builds are ${sums[0]}"
}

bash "$top/Resources/release.sh" --stale-evidence "$work" "$build" || die "release.sh failed"
tar -C "$work" -xzf "$work"/fenestra-*.tar.gz
archive=$(echo "$work"/fenestra-*/)
archive=${archive%/}
copy_inputs "$work/build"
/bin/busybox sh "$here/requests.sh" "$build/bin/fenestra" "$work/build" || die "build: the requests above failed"
for name in "$@"; do
  "stage_$name"
done
exit ${missing:-0}
