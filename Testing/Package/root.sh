#!/usr/bin/env bash
# Tests the installed C++ library and the Python package in a root of Debian 12 that has only the packages named in
# Resources/embedding/README.md: the example is built there, shared and static, Python renders the same image, and a
# Slicer scene.
# Exit status 77: needs root, debootstrap and a mirror of Debian.
# usage: bash Testing/Package/root.sh BUILD; the root is kept in BUILD/package
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../../Resources/setup.sh"
build=$(cd "$1" && pwd)
root=$build/package/bookworm
skip() {
  printf 'SKIPPED: %s\n' "$*" >&2
  exit 77
}
[ "$(id -u)" = 0 ] && command -v debootstrap >/dev/null || skip "needs root and debootstrap"
packages=$(sed -n 's/^apt install //p' "$top/Resources/embedding/README.md" | tr '\n' ' ')
[ -n "$packages" ] || die "Resources/embedding/README.md names no packages"
if [ "$(cat "$root/made" 2>/dev/null)" != "$packages" ]; then
  rm -rf "$root"
  mkdir -p "$root"
  # debootstrap resolves no alternatives, so apt installs the packages.
  { debootstrap --variant=minbase bookworm "$root" && chroot "$root" apt-get install -y --no-install-recommends $packages &&
    chroot "$root" apt-get clean; } >"$build/package/bookworm.log" 2>&1 || skip "no Debian 12 ($build/package/bookworm.log)"
  printf '%s' "$packages" >"$root/made"
fi

work=$root/work
rm -rf "$work" "$root/opt/fenestra"
mkdir -p "$work"
cmake --install "$build" --component library --prefix "$root/opt/fenestra" >"$work/install.log"
cmake --install "$build" --component python --prefix "$work/site/fenestra" >>"$work/install.log"
cp "$top"/Renderer/python/fenestra/* "$work/site/fenestra"
cp -r "$top/Resources/embedding" "$top/Testing/Data/cube" "$work"
cat >"$work/ball.py" <<'END'
import fenestra, numpy
i, j, k = numpy.indices((64, 64, 64)) - 31.5
distance = numpy.sqrt(i * i + j * j + k * k)
affine = [[2, 0, 0, -64], [0, 2, 0, -64], [0, 0, 2, -64], [0, 0, 0, 1]]
voxels = (40 + 260 * numpy.clip(15.5 - distance, 0, 1)).astype(numpy.int16)
scene = fenestra.Scene(voxels, affine=affine, segmentation=(distance < 15).astype(numpy.uint8), labels={1: "ball"},
                       modality="ct", focus="ball", view="anterior")
scene.render((256, 256), samples=32).save("python.png")
fenestra.Scene("cube/cube.mrb").render((64, 64), samples=4).save("cube.png")
END
mount --bind /proc "$root/proc"
trap 'umount "$root/proc"' EXIT
env -i PATH=/bin:/usr/bin:/usr/sbin chroot "$root" /bin/sh -ec '
  cd /work
  cmake -S embedding -B example -DCMAKE_PREFIX_PATH=/opt/fenestra -DCMAKE_BUILD_TYPE=Release >cmake.log
  cmake --build example >>cmake.log
  example/example example.png 2>progress.log
  sed -i s/Fenestra::fenestra/Fenestra::static/ embedding/CMakeLists.txt
  cmake -S embedding -B static -DCMAKE_PREFIX_PATH=/opt/fenestra -DCMAKE_BUILD_TYPE=Release >>cmake.log
  cmake --build static >>cmake.log
  static/example static.png 2>progress.log
  PYTHONPATH=site python3 ball.py' || die "the commands above failed in $root"
cmp "$work/example.png" "$work/static.png" || die "the images of the shared and the static library differ"
cmp "$work/example.png" "$work/python.png" || die "the images of C++ and Python differ"
[ "$(head -c 4 "$work/cube.png" | tail -c 3)" = PNG ] || die "cube.png is no image"
say "Library and Python package run in Debian 12 with the named packages alone"
