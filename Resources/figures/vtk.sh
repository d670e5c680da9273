#!/usr/bin/env bash
# Renders real volumes by VTK's GPU ray casting with presets of 3D Slicer, and by Fenestra with its defaults, with equal
# cameras, side by side: comparison-vtk.jpg of the main README. Skipped without VTK for Python (Debian: python3-vtk9) and
# the volumes and Slicer's presets.xml in FENESTRA_DATA. usage: bash Resources/figures/vtk.sh
source "$(dirname "${BASH_SOURCE[0]}")/figures.sh"
python=${PYTHON:-/usr/bin/python3}
presets=$data/slicer_scenes/slicer_core/presets.xml
"$python" -c 'import vtk' 2>/dev/null || { say "SKIPPED: $python has no VTK"; exit; }
[ -s "$presets" ] || { say "SKIPPED: FENESTRA_DATA has no presets.xml of Slicer"; exit; }
screen=()
[ -n "${DISPLAY:-}" ] || screen=(xvfb-run -a)

above=() below=()
# compare_with_vtk NAME PRESET TITLE CUT VOLUME [options]: renders a volume by both; CUT: "cut", which removes what is in
# front of the center of the focus from VTK's image, or "".
compare_with_vtk() {
  local name=$1 preset=$2 title=$3 cut=$4 volume=$5
  [ -s "$volume" ] || { say "SKIPPED: $name: no $volume"; return; }
  render "vtk-$name" "$volume" "${@:6}" --output "$out/vtk-$name.exr"
  local camera
  camera=$(grep -a -o -m1 -e '--projection orthographic[-+ =,.a-z0-9]*' "$out/vtk-$name.exr" | head -n 1)
  say "Rendering by VTK: $name"
  # shellcheck disable=SC2086
  "${screen[@]}" "$python" "$figures/render_vtk.py" "$volume" "$presets" "$preset" "$out/vtk-$name-slicer.png" "$size" \
    "$camera" $cut
  above+=(-label "$title: VTK, $preset${cut:+, cut by a plane}" "$out/vtk-$name-slicer.png")
  below+=(-label "$title: Fenestra" "$out/vtk-$name.png")
}

head=$data/head_mr_seg3d
compare_with_vtk liver CT-Cardiac3 Liver cut "$torso/ct.nii.gz" --labels "$torso/seg_labels.json" \
  --segmentation "$torso/seg_totalsegmentator_rtstruct.nii.gz" --focus liver --view anterior
compare_with_vtk aorta CT-AAA "Dissected aorta" cut "$aorta/ct_cropped.nii.gz" --segmentation "$aorta/labels.nii.gz" \
  --labels "$aorta/labels.ctbl" --focus aorta_true_lumen,aorta_false_lumen "${aorta_view[@]}"
compare_with_vtk brain MR-Default Brain cut "$head/t1.nii.gz" --segmentation "$head/seg_brain_skull.nii.gz" --focus 1 \
  --transfer mr-anatomy --view left
compare_with_vtk skeleton CT-Bones Skeleton "" "$torso/ct.nii.gz" --transfer ct-bone --view anterior
[ ${#below[@]} -gt 0 ] || exit 0
montage -font DejaVu-Sans -pointsize 15 -background '#181818' -fill white -tile "$((${#below[@]} / 3))x2" -geometry +5+5 \
  "${above[@]}" "${below[@]}" -quality 85 "$top/Resources/pictures/comparison-vtk.jpg"
say "Done: $top/Resources/pictures/comparison-vtk.jpg"
