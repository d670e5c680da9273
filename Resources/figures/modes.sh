#!/usr/bin/env bash
# A picture of every clip mode and every option of clipping, on the synthetic knee:
# Resources/figures/modes.md. usage: bash Resources/figures/modes.sh
source "$(dirname "${BASH_SOURCE[0]}")/figures.sh"
page=$shown/modes.md
size=${SIZE:-320}

phantom knee
knee=("$out/knee/knee.nrrd" --materials none --segmentation "$out/knee/knee.seg.nrrd" --transfer mr-knee --position=-15,200,-90)
cartilage=(--focus "Femoral cartilage" --labelsmoothing 0.6)

cat >"$page" <<'END'
# Clip modes and options

Made by `modes.sh`, all of one knee (`fenestra phantom knee`), with the femoral cartilage as the focus. What the
modes are worth, in numbers: [techniques](techniques.md).

The voxels on the border of the cartilage hold some of the fluid beside it. A surface exactly on that border shows
the mixture, and the 1 mm slices of the scan in it as stripes where it is steep, however smooth the labels are:
with `--soft 2` matter comes back over two millimetres behind it, and they hardly show. All pictures have it and
`--labelsmoothing 0.6`, unless their flags say otherwise.

| | flags | what it does |
|---|---|---|
END

# show NAME FLAGS WHAT: a line of the page with its picture, FLAGS as a user writes them.
show() {
  local name=mode-$1 flags=$2 what=$3
  # shellcheck disable=SC2086
  render "$name" "${knee[@]}" "${cartilage[@]}" $flags
  convert "$out/$name.png" -quality 86 "$shown/$name.jpg"
  echo "| ![$1]($name.jpg) | \`$flags\` | $what |" >>"$page"
}

show none "--clip none" "The whole volume."
cartilage+=(--soft 2)
show plane "--clip plane" "Cut by a plane: the one nearest to the focus as it is seen, or \`--plane OX,OY,OZ,NX,NY,NZ\`."
show box "--clip hole --hole box" "A box-shaped hole, flat at the focus's farthest visible point, \`--holemargin\` mm wider than the focus."
show cylinder "--clip hole" "A round hole."
show sphere "--clip hole --hole sphere" "As if a ball around the visible focus were pushed in."
show cutaway "--clip cutaway" "Only what is in front of the focus is removed."
show ghost "--clip ghost --ghost 0.004" "What the surface would remove keeps a share of its extinction (0.1 unless told; dense looks want less)."
show surface "--clip surface" "The paper's surface: a thin plate spline through \`--controlpoints\` points of the focus's outline, smoothed by \`--smoothing\`."
show exact "--boundary exact" "The surface that leaves the focus with its own depth and slope."
show perspective "--boundary exact --projection perspective" "Every mode works in perspective, too."
show nearer "--boundary exact --offset=-2" "The surface 2 mm nearer to the eye: the focus stays under a layer. Positive goes into the focus."
show margin "--boundary exact --margin 3" "The focus grown by 3 mm; negative shrinks it; with several segments one margin each."
show pale "--boundary exact --contextsaturation 0.15" "The context without its colours."
cartilage=(--focus "Femoral cartilage" --labelsmoothing 0.6)
show soft "--boundary exact --soft 4" "Matter comes back gradually over 4 mm behind the surface."
show thin "--clip none --contextdensity 0.004 --contextsaturation 0.3" "The classic focus and context: no clip, but all that is not focus thinned to 0.4 %."
cartilage=(--focus "Femoral cartilage")
show labels "--labelsmoothing 0 --soft 0 --boundary exact" "Without \`--labelsmoothing\`, and exactly on the border: the steps of the labelmap's 1 mm slices, and the scan's own."
say "Done: $page"
