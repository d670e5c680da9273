#!/usr/bin/env bash
# Renders the first image of the main README, with defaults: the liver in a CT of FENESTRA_DATA. A later call with more
# SAMPLES resumes from its samples. usage: bash Resources/figures/hero.sh
source "$(dirname "${BASH_SOURCE[0]}")/figures.sh"
[ -s "$torso/ct.nii.gz" ] || die "FENESTRA_DATA has no torso_ct_ccth_a01"
say "Rendering: hero"
"$fenestra" "$torso/ct.nii.gz" --segmentation "$torso/seg_totalsegmentator_rtstruct.nii.gz" \
  --labels "$torso/seg_labels.json" --focus liver --view anterior --target=10,-24,470 --scale 170 \
  --size 1600x1100 --samples "${SAMPLES:-32}" --quiet --checkpoint "$out/hero.film" --output "$out/hero.png" \
  --stats-json "$out/hero.json"
convert "$out/hero.png" -quality 85 "$top/Resources/pictures/hero.jpg"
say "Done: $top/Resources/pictures/hero.jpg"
