#!/usr/bin/env bash
# Renders the organ presets for the main README, from phantoms and from real volumes if present, and makes the
# icons of Slicer's anatomy list from the images. usage: bash Resources/figures/presets.sh
source "$(dirname "${BASH_SOURCE[0]}")/figures.sh"
pictures=$top/Resources/pictures

# show PRESET arguments...: renders an image.
show() {
  local name=preset-$1
  render "$name" "${@:2}" --preset "$1"
  convert "$out/$name.png" -quality 88 "$pictures/$name.jpg"
}

# show_real PRESET VOLUME SEGMENTS LABELS: renders an image of a volume in FENESTRA_DATA.
show_real() {
  if [ -s "$data/$2" ]; then
    show "$1" "$data/$2" --segmentation "$data/$3" --focus "$4"
  else
    say "SKIPPED: $1: FENESTRA_DATA has no $2"
  fi
}

# find_labels FILE PATTERN: prints the label values of the segments with matching names.
find_labels() { [ ! -s "$data/$1" ] || jq -r --arg name "$2" '[.[] | select(.name | test($name)).label] | join(",")' "$data/$1"; }

make_phantom knee
show knee-cartilage "$out/knee/knee.nrrd" --segmentation "$out/knee/knee.seg.nrrd"
make_phantom foot
show foot-bones "$out/foot/foot.nrrd" --segmentation "$out/foot/foot.seg.nrrd"
make_phantom fetus
show fetal-face "$out/fetus/fetus.nrrd" --segmentation "$out/fetus/fetus.seg.nrrd"
torso=torso_ct_ccth_a01
show_real liver $torso/ct.nii.gz $torso/seg_totalsegmentator_rtstruct.nii.gz "$(find_labels $torso/seg_labels.json liver)"
show_real lungs $torso/ct.nii.gz $torso/seg_totalsegmentator_rtstruct.nii.gz "$(find_labels $torso/seg_labels.json lung)"
abdomen=abdomen_ct_totalseg
show_real spine $abdomen/ct.nii.gz $abdomen/seg_multiorgan.nii.gz "$(find_labels $abdomen/seg_labels.json 'vertebra|sacrum')"
show_real brain-surface head_mr_seg3d/t1.nii.gz head_mr_seg3d/seg_brain_skull.nii.gz 1

for image in "$pictures"/preset-*.jpg; do
  write_icon "$image" "$(basename "$image" .jpg)"
done
say "Done: $pictures"
