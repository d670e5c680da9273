#!/usr/bin/env bash
# Plane, hole, cutaway, ghost and clipping surface (spline and exact) side by side, with numbers, for
# knee, foot, liver and cube: Resources/figures/techniques.md. usage: bash Resources/figures/techniques.sh
source "$(dirname "${BASH_SOURCE[0]}")/figures.sh"

names=(plane hole cutaway ghost spline exact)
flags=("--clip plane" "--clip hole" "--clip cutaway" "--clip ghost --ghost 0.004" "--clip surface" "--boundary exact")
titles=("Cut plane (placed by the focus)" "Virtual hole" "Cut-away" "Ghost, 0.004"
  "Clipping surface, spline" "Clipping surface, exact")
page=$shown/techniques.md

# subject NAME TITLE arguments...: a picture of each technique and the table of their measures.
subject() {
  local name=$1 title=$2 pictures=()
  shift 2
  {
    printf '\n## %s\n\n![%s, six ways](techniques-%s.jpg)\n\n' "$title" "$title" "$name"
    echo "| technique | gap mm: mean | p95 | max | slope jump | focus kept | focus shown | light on the focus | context removed |"
    echo "|---|---|---|---|---|---|---|---|---|"
  } >>"$page"
  for i in "${!names[@]}"; do
    local picture=$name-${names[i]}
    # shellcheck disable=SC2086
    render "$picture" "$@" ${flags[i]}
    pictures+=("$picture" "${titles[i]}")
    echo "| ${titles[i]} | $(number "$picture" .boundaryGapMm.mean) | $(number "$picture" .boundaryGapMm.p95)" \
      "| $(number "$picture" .boundaryGapMm.max) | $(number "$picture" .boundarySlopeJump.mean)" \
      "| $(number "$picture" .focusKept %.3f) | $(number "$picture" .focusCoverage %.3f)" \
      "| $(number "$picture" .focusLight %.2f) | $(number "$picture" .contextRemoved %.2f) |" >>"$page"
  done
  {
    printf '\nShown without any clip: %s of the focus. Its own depth jumps by more than 2 mm along %s of its\n' \
      "$(number "$picture" .focusCoverageUnclipped %.3f)" "$(number "$picture" .boundaryDepthJumps %.2f)"
    printf 'outline; gap and slope are of the rest.\n'
  } >>"$page"
  row "techniques-$name.jpg" "${pictures[@]}"
}

cat >"$page" <<'END'
# Techniques compared

Made by `techniques.sh`: the same view, light and samples for every technique. The numbers are of the
stats file (`--stats`):

- **gap**: how far the depth at which the context begins misses the focus's depth at its outline;
- **slope jump**: how much the two slopes differ there (mm of depth a mm);
- **focus kept**: share of the focus's pixels whose focus point is not cut away; **focus shown**: share
  that nothing hides;
- **light on the focus**: what comes straight from the lights, relative to the focus alone;
- **context removed**: share of all other matter.
END

phantom knee
subject knee "Knee: femoral cartilage (synthetic MR)" "$out/knee/knee.nrrd" \
  --segmentation "$out/knee/knee.seg.nrrd" --materials none --focus "Femoral cartilage" --labelsmoothing 0.6 --soft 2 \
  --transfer mr-knee --position=-15,200,-90
phantom foot
subject foot "Foot: its bones (synthetic CT)" "$out/foot/foot.mrml" --materials none --focus bones --labelsmoothing 0.6 \
  --transfer ct-skeleton --view superior
liver=$data/torso_ct_ccth_a01
if [ -d "$liver" ]; then
  subject liver "Liver (CT of the collection CC-Tumor-Heterogeneity, TCIA, CC BY 4.0)" "$liver/ct.nii.gz" \
    --segmentation "$liver/seg_totalsegmentator_rtstruct.nii.gz" --materials none --focus 1 --labelsmoothing 2 \
    --transfer ct-liver --view anterior
else
  printf '\n## Liver\n\nSKIPPED: there is no %s.\n' "torso_ct_ccth_a01 in FENESTRA_DATA" >>"$page"
fi
phantom cube cube256 --size 256 --edge 512
subject cube "Cube of 512 mm (the paper's model)" "$out/cube256/cube.mrml" --focus Focus --contextsaturation 1
say "Done: $page"
