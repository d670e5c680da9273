#!/usr/bin/env bash
# Shows figure 1 of the paper with the defaults, on a fresh Debian 12: installs packages, builds, writes a synthetic knee,
# renders it with four clip modes and puts the images side by side. Later runs reuse build and knee.
# usage: bash Resources/demo.sh [FOLDER]
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
out=$(mkdir -p "${1:-$top/demo}" && cd "${1:-$top/demo}" && pwd) || die "cannot make folder ${1:-$top/demo}"

install_packages "${build_packages[@]}" imagemagick
say "Building (takes some minutes the first time)"
build release -DFENESTRA_BUILD_TESTS=OFF
fenestra=$top/build/bin/fenestra

if [ ! -s "$out/knee/knee.nrrd" ] || [ "$fenestra" -nt "$out/knee/knee.nrrd" ]; then
  say "Writing the synthetic knee"
  "$fenestra" phantom knee --output "$out/knee"
fi

# View from the front and slightly below, onto both lesions of the femoral cartilage.
scene=(--transfer "$out/knee/knee.vp.json" --segmentation "$out/knee/knee.seg.nrrd"
  --focus "Femoral cartilage" --position=-15,200,-90 --size 384x384 --samples 16)

render() { # MODE [options]
  local mode=$1
  shift
  say "Rendering: $mode"
  "$fenestra" "$out/knee/knee.nrrd" "${scene[@]}" --clip "$mode" "$@" \
    --output "$out/$mode.exr" --output "$out/$mode.png" --stats-json "$out/$mode.json"
}
start=$SECONDS
render surface
say "First image: $out/surface.png"
render none
render plane --plane=0,10,-5,0,0.91,-0.41
render cutaway
say "Rendering took $((SECONDS - start)) s"

montage -font DejaVu-Sans -pointsize 18 -geometry +6+6 -background '#181818' -fill white \
  -label 'a  Whole volume: the cartilage is hidden' "$out/none.png" \
  -label 'b  Clip plane: poor coverage' "$out/plane.png" \
  -label 'c  Cut-away: cliffs, dark focus' "$out/cutaway.png" \
  -label 'd  Clipping surface' "$out/surface.png" \
  -tile 4x1 "$out/figure1.png" || die "montage failed (see above)"

say "Done. Results:"
echo "$out/figure1.png"
ls "$out"/*.exr
