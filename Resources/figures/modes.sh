#!/usr/bin/env bash
# Renders every clip mode and clip option on a CT of a dissected aorta in FENESTRA_DATA. Writes section "modes" of
# README.md. usage: bash Resources/figures/modes.sh
source "$(dirname "${BASH_SOURCE[0]}")/figures.sh"
page=$out/modes.md
size=${SIZE:-320}

[ -s "$aorta/ct_cropped.nii.gz" ] || die "FENESTRA_DATA has no aorta_dissection_totalseg"
base=("$aorta/ct_cropped.nii.gz" --segmentation "$aorta/labels.nii.gz" --labels "$aorta/labels.ctbl"
  --focus aorta_true_lumen,aorta_false_lumen "${aorta_view[@]}")

cat >"$page" <<'END'
## Clip modes and options

Written by `modes.sh`: a CT with contrast agent, 1.5 mm voxels, of a dissected aorta ([TotalSegmentator](https://github.com/wasserth/TotalSegmentator),
Apache 2.0), seen from the back and right. The focus is its true and its false lumen. All else has its default value.

| | options | effect |
|---|---|---|
END

# show NAME OPTIONS EFFECT: renders an image and adds its row; OPTIONS as a user writes them.
show() {
  local name=mode-$1 options=$2 effect=$3
  # shellcheck disable=SC2086
  render "$name" "${base[@]}" $options
  convert "$out/$name.png" -quality 86 "$figures/$name.jpg"
  echo "| ![$1]($name.jpg) | \`$options\` | $effect |" >>"$page"
}

show none "--clip none" "The complete volume."
show plane "--clip plane" "A plane: the one closest to the visible focus, or \`--plane OX,OY,OZ,NX,NY,NZ\`."
show box "--clip hole --hole box" "A box-shaped hole with its floor at the farthest visible point of the focus, \`--hole-margin\` mm wider than the focus."
show cylinder "--clip hole" "A cylindrical hole."
show sphere "--clip hole --hole sphere" "A hole with a spherical floor around the visible focus."
show cutaway "--clip cutaway" "Removes only what is in front of the focus."
show ghost "--clip ghost --ghost 0.004" "Keeps a fraction of the extinction of what the surface would remove (default 0.1; use less for dense volumes)."
show surface "--clip-boundary spline" "The paper's surface: a thin plate spline through \`--control-points\` points of the focus outline, smoothed by \`--spline-smoothing\`."
show exact "--clip-boundary exact" "The default: a surface that continues the depth and slope of the focus."
show perspective "--projection perspective" "All modes also work in perspective."
show nearer "--clip-offset=-4" "The surface moved 4 mm toward the camera: a layer stays on the focus. Positive values move it into the focus."
show margin "--margin 4" "The focus enlarged by 4 mm; negative values shrink it; with several segments, one margin per segment."
show pale "--context-saturation 0.15" "The context with less color saturation (default 0.75)."
show soft "--clip-softness 6" "The volume fades in over 6 mm behind the surface (default 0.6)."
show thin "--clip none --context-density 0.004 --context-saturation 0.3" "Classic focus and context: no clip, but the extinction outside the focus is reduced to 0.4 %."
show labels "--label-smoothing 0 --clip-softness 0 --volume-smoothing off" "Without smoothing, and exactly on the border: voxels of label map and scan appear as steps, and noise as grain."
write_section modes
