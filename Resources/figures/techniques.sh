#!/usr/bin/env bash
# Compares plane, hole, cutaway, ghost and clipping surface (spline and exact) in images and numbers, for knee,
# liver, aorta and cube. Writes section "techniques" of README.md. usage: bash Resources/figures/techniques.sh
source "$(dirname "${BASH_SOURCE[0]}")/figures.sh"

names=(plane hole cutaway ghost spline exact)
options=("--clip plane" "--clip hole" "--clip cutaway" "--clip ghost --clip-boundary spline --ghost 0.004"
  "--clip-boundary spline" "--clip-boundary exact")
titles=("Cut plane (placed by the focus)" "Virtual hole" "Cut-away" "Ghost, 0.004"
  "Clipping surface, spline" "Clipping surface, exact")
page=$out/techniques.md

# compare_techniques NAME TITLE arguments...: renders each technique and adds the images and the table of metrics.
compare_techniques() {
  local name=$1 title=$2 images=()
  shift 2
  {
    printf '\n**%s**\n![%s, six ways](techniques-%s.jpg)\n\n' "$title" "$title" "$name"
    echo "| technique | gap mm: mean | p95 | max | slope jump | focus kept | focus shown | light on the focus | context removed |"
    echo "|---|---|---|---|---|---|---|---|---|"
  } >>"$page"
  for i in "${!names[@]}"; do
    local image=$name-${names[i]}
    # shellcheck disable=SC2086
    render "$image" "$@" ${options[i]}
    images+=("$image" "${titles[i]}")
    echo "| ${titles[i]} | $(get "$image" .boundaryGapMm.mean) | $(get "$image" .boundaryGapMm.p95)" \
      "| $(get "$image" .boundaryGapMm.max) | $(get "$image" .boundarySlopeJump.mean)" \
      "| $(get "$image" .focusKept %.3f) | $(get "$image" .focusCoverage %.3f)" \
      "| $(get "$image" .focusLight %.2f) | $(get "$image" .contextRemoved %.2f) |" >>"$page"
  done
  printf '\nWithout a clip, %s of the focus is shown. Its own depth jumps along %s of its outline.\n' \
    "$(get "$image" .focusCoverageUnclipped %.3f)" "$(get "$image" .boundaryDepthJumps %.2f)" >>"$page"
  join_images "techniques-$name.jpg" "${images[@]}"
}

cat >"$page" <<'END'
## Techniques compared

Written by `techniques.sh`: the same view, lights and samples for every technique, and the defaults; the cube with `--paper`.
END

make_phantom knee
compare_techniques knee "Knee: femoral cartilage (synthetic MR)" "$out/knee/knee.nrrd" \
  --segmentation "$out/knee/knee.seg.nrrd" --focus "Femoral cartilage" --transfer mr-knee --position=-15,200,-90
if [ -d "$aorta" ]; then
  compare_techniques aorta "Dissected aorta (CT of TotalSegmentator, Apache 2.0)" "$aorta/ct_cropped.nii.gz" \
    --segmentation "$aorta/labels.nii.gz" --labels "$aorta/labels.ctbl" --focus aorta_true_lumen,aorta_false_lumen \
    "${aorta_view[@]}"
else
  printf '\n**Aorta**: SKIPPED: FENESTRA_DATA has no aorta_dissection_totalseg.\n' >>"$page"
fi
if [ -d "$torso" ]; then
  compare_techniques liver "Liver (CT of the collection CC-Tumor-Heterogeneity, TCIA, CC BY 4.0)" "$torso/ct.nii.gz" \
    --segmentation "$torso/seg_totalsegmentator_rtstruct.nii.gz" --labels "$torso/seg_labels.json" --focus liver --view anterior
else
  printf '\n**Liver**: SKIPPED: FENESTRA_DATA has no torso_ct_ccth_a01.\n' >>"$page"
fi
make_phantom cube cube256 --size 256 --edge 512
compare_techniques cube "Cube of 512 mm (the paper's model)" "$out/cube256/cube.mrml" --focus Focus --paper --background dark
write_section techniques
