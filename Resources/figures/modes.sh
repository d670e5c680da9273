#!/usr/bin/env bash
# Renders every clip mode and clip option on the synthetic knee. Writes section "modes" of README.md.
# usage: bash Resources/figures/modes.sh
source "$(dirname "${BASH_SOURCE[0]}")/figures.sh"
page=$out/modes.md
size=${SIZE:-320}

make_phantom knee
knee=("$out/knee/knee.nrrd" --materials none --segmentation "$out/knee/knee.seg.nrrd" --transfer mr-knee --position=-15,200,-90)
cartilage=(--focus "Femoral cartilage" --label-smoothing 0.6)

cat >"$page" <<'END'
## Clip modes and options

Written by `modes.sh`: the synthetic knee (`fenestra phantom knee`) with the femoral cartilage as the focus.

Voxels at the border of the cartilage also contain the fluid beside it. A surface exactly on that border shows this mixture.
Where it is steep, the 1 mm slices of the scan appear as stripes, however smooth the labels are. `--clip-softness 2`, which fades
the volume in over 2 mm behind the surface, almost hides them. The images use it and `--label-smoothing 0.6` unless their
options say otherwise.

| | options | effect |
|---|---|---|
END

# show NAME OPTIONS EFFECT: renders an image and adds its row; OPTIONS as a user writes them.
show() {
  local name=mode-$1 options=$2 effect=$3
  # shellcheck disable=SC2086
  render "$name" "${knee[@]}" "${cartilage[@]}" $options
  convert "$out/$name.png" -quality 86 "$figures/$name.jpg"
  echo "| ![$1]($name.jpg) | \`$options\` | $effect |" >>"$page"
}

show none "--clip none" "The complete volume."
cartilage+=(--clip-softness 2)
show plane "--clip plane" "A plane: the one closest to the visible focus, or \`--plane OX,OY,OZ,NX,NY,NZ\`."
show box "--clip hole --hole box" "A box-shaped hole with its floor at the farthest visible point of the focus, \`--hole-margin\` mm wider than the focus."
show cylinder "--clip hole" "A cylindrical hole."
show sphere "--clip hole --hole sphere" "A hole with a spherical floor around the visible focus."
show cutaway "--clip cutaway" "Removes only what is in front of the focus."
show ghost "--clip ghost --ghost 0.004" "Keeps a fraction of the extinction of what the surface would remove (default 0.1; use less for dense volumes)."
show surface "--clip-boundary spline" "The paper's surface: a thin plate spline through \`--control-points\` points of the focus outline, smoothed by \`--spline-smoothing\`."
show exact "--clip-boundary exact" "A surface that continues the depth and slope of the focus."
show perspective "--clip-boundary exact --projection perspective" "All modes also work in perspective."
show nearer "--clip-boundary exact --clip-offset=-2" "The surface moved 2 mm toward the camera: a layer stays on the focus. Positive values move it into the focus."
show margin "--clip-boundary exact --margin 3" "The focus enlarged by 3 mm; negative values shrink it; with several segments, one margin per segment."
show pale "--clip-boundary exact --context-saturation 0.15" "The context with less color saturation."
cartilage=(--focus "Femoral cartilage" --label-smoothing 0.6)
show soft "--clip-boundary exact --clip-softness 4" "The volume fades in over 4 mm behind the surface."
show thin "--clip none --context-density 0.004 --context-saturation 0.3" "Classic focus and context: no clip, but the extinction outside the focus is reduced to 0.4 %."
cartilage=(--focus "Femoral cartilage")
show labels "--label-smoothing 0 --clip-softness 0 --clip-boundary exact" "Without smoothing, and exactly on the border: the 1 mm slices of label map and scan appear as steps."
write_section modes
