#!/usr/bin/env bash
# A picture of each organ preset that there is something to see on, for the README: phantoms, and real
# volumes where they are present; and from these the small pictures in Slicer's list of anatomies.
# usage: bash Resources/figures/presets.sh
source "$(dirname "${BASH_SOURCE[0]}")/figures.sh"
shown=$top/Resources/pictures

# show PRESET arguments...
show() {
  local name=preset-$1
  render "$name" "${@:2}" --preset "$1"
  convert "$out/$name.png" -quality 88 "$shown/$name.jpg"
}

# real PRESET VOLUME SEGMENTS LABELS: of FENESTRA_DATA.
real() {
  if [ -s "$data/$2" ]; then
    show "$1" "$data/$2" --segmentation "$data/$3" --focus "$4"
  else
    say "SKIPPED: $1, for there is no $2 in FENESTRA_DATA"
  fi
}

# labels FILE PATTERN: the values of the segments whose names it matches.
labels() { [ ! -s "$data/$1" ] || jq -r --arg name "$2" '[.[] | select(.name | test($name)).label] | join(",")' "$data/$1"; }

phantom knee
show knee-cartilage "$out/knee/knee.nrrd" --segmentation "$out/knee/knee.seg.nrrd"
phantom foot
show foot-bones "$out/foot/foot.nrrd" --segmentation "$out/foot/foot.seg.nrrd"
phantom fetus
show fetal-face "$out/fetus/fetus.nrrd" --segmentation "$out/fetus/fetus.seg.nrrd"
torso=torso_ct_ccth_a01
real liver $torso/ct.nii.gz $torso/seg_totalsegmentator_rtstruct.nii.gz "$(labels $torso/seg_labels.json liver)"
real lungs $torso/ct.nii.gz $torso/seg_totalsegmentator_rtstruct.nii.gz "$(labels $torso/seg_labels.json lung)"
abdomen=abdomen_ct_totalseg
real spine $abdomen/ct.nii.gz $abdomen/seg_multiorgan.nii.gz "$(labels $abdomen/seg_labels.json 'vertebra|sacrum')"
real brain-surface head_mr_seg3d/t1.nii.gz head_mr_seg3d/seg_brain_skull.nii.gz 1

# Few colours keep each below 8 kB. A new one is named in the module's .qrc.
for picture in "$shown"/preset-*.jpg; do
  convert "$picture" -resize 96x96 -strip -colors 64 \
    "PNG8:$top/SlicerModule/Resources/Icons/$(basename "$picture" .jpg).png"
done
say "Done: $shown"
