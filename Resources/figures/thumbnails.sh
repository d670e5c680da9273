#!/usr/bin/env bash
# Makes the icons of tissue colors and light rigs in Slicer's panel: a diagram of each transfer function, and the face
# of the fetus phantom in the light of each rig. usage: bash Resources/figures/thumbnails.sh
source "$(dirname "${BASH_SOURCE[0]}")/figures.sh"
install_packages python3
size=192
samples=64

for function in "$top"/Resources/transfer/*.json; do
  name=transfer-$(basename "$function" .json)
  python3 "$figures/transfer_icon.py" "$function" 96 >"$out/$name.ppm"
  write_icon "$out/$name.ppm" "$name"
done
make_phantom fetus
for rig in "$top"/Resources/lights/*.json; do
  name=lights-$(basename "$rig" .json)
  render "$name" "$out/fetus/fetus.nrrd" --segmentation "$out/fetus/fetus.seg.nrrd" --preset fetal-face \
    --lights "$(basename "$rig" .json)"
  write_icon "$out/$name.png" "$name"
done
say "Done: $top/SlicerModule/Resources/Icons"
