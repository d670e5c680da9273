#!/usr/bin/env bash
# Measures the appearance of images of real data against bounds (README.md, Appearance). Each image has the program's
# defaults but for data, focus, view and size.
# usage: bash Testing/Benchmarks/appearance.sh [NAME...] [-- ARGUMENT...]
#        bash Testing/Benchmarks/appearance.sh --case VOLUME SEGMENTATION FOCUS [-- ARGUMENT...]
#   NAME: scenes to measure [all]; FOCUS: names or label values, separated by commas
#   ARGUMENT: arguments of fenestra for every image, such as --transfer ct-soft
# OUT: folder of the images and appearance.csv [appearance of the build]; FENESTRA_DATA: folder of the volumes;
# FENESTRA_BUILD: an existing build to use. Fails if a value is out of its bounds.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../../Resources/setup.sh"
folder=${FENESTRA_BUILD:-$top/build}
out=${OUT:-$folder/appearance}
data=${FENESTRA_DATA:-$top/../shared/data}
csv=$out/appearance.csv

names=() given=() case=()
while [ $# -gt 0 ] && [ "$1" != -- ]; do
  if [ "$1" = --case ]; then
    [ $# -ge 4 ] || die "usage: appearance.sh --case VOLUME SEGMENTATION FOCUS [-- ARGUMENT...]"
    case=("${@:2:3}")
    shift 4
  else
    names+=("$1")
    shift
  fi
done
[ $# -eq 0 ] || given=("${@:2}")

if [ -z "${FENESTRA_BUILD:-}" ]; then
  install_packages "${build_packages[@]}"
  (cd "$top" && cmake --preset release -DFENESTRA_BUILD_TESTS=ON >/dev/null &&
    cmake --build "$folder" --target AppearanceBenchmark) >&2 || die "the build failed (see above)"
fi
found=
mkdir -p "$out"
echo scene,measure,part,value,least,greatest,result >"$csv"

# measure NAME BOUNDS VOLUME [OPTION VALUE]...: measures an image. BOUNDS: groups of measures that must pass; "": all but
# contrast. Options among the ARGUMENTs replace those of the scene.
measure() {
  local name=$1 bounds=$2 arguments=("$3")
  [ ${#names[@]} -eq 0 ] || [[ " ${names[*]} " == *" $name "* ]] || return 0
  found=yes
  if [ ${#case[@]} -eq 0 ] && [ ! -e "$3" ]; then
    echo "$name: SKIPPED, not found: $3" >&2
    return 0
  fi
  set -- "${@:4}" --size 640x640
  while [ $# -gt 0 ]; do
    [[ " ${given[*]} " == *" $1"[\ =]* ]] || arguments+=("$1" "$2")
    shift 2
  done
  echo "$name" >&2
  "$folder/bin/AppearanceBenchmark" --name "$name" ${bounds:+--bounds "$bounds"} --image "$out/$name.png" -- \
    "${arguments[@]}" "${given[@]}" >>"$csv" 2>"$out/$name.log" || { cat "$out/$name.log" >&2; die "$name failed"; }
}

abdomen=("$data/abdomen_ct_totalseg/ct.nii.gz" --segmentation "$data/abdomen_ct_totalseg/seg_multiorgan.nii.gz")
dissection=("$data/aorta_dissection_totalseg/ct_cropped.nii.gz"
  --segmentation "$data/aorta_dissection_totalseg/labels.nii.gz" --labels "$data/aorta_dissection_totalseg/labels.ctbl")
knee=("$data/spl_knee_atlas_labels/SYNTHETIC_mr_256.nii.gz" --segmentation "$data/spl_knee_atlas_labels/seg_256.nii.gz"
  --labels "$data/spl_knee_atlas_labels/knee.ctbl")
torso=("$data/torso_ct_ccth_a01/ct.nii.gz")
organs=("${torso[@]}" --segmentation "$data/torso_ct_ccth_a01/seg_totalsegmentator_rtstruct.nii.gz")
head=("$data/head_mr_seg3d/t1.nii.gz" --segmentation "$data/head_mr_seg3d/seg_brain_skull.nii.gz")
kidneys=(--position 0,930,345 --target 0,130,345 --scale 95)
lungs=lung_upper_lobe_left,lung_lower_lobe_left,lung_upper_lobe_right,lung_middle_lobe_right,lung_lower_lobe_right

if [ ${#case[@]} -gt 0 ]; then
  measure case "" "${case[0]}" --segmentation "${case[1]}" --focus "${case[2]}" --view auto
else
  measure liver A1,A2,A5,A6,A7,A8 "${organs[@]}" --focus liver --position 465,765,523 --target 59.8,-10,414.7 --scale 150
  measure kidneys A1,A5,A6,A7,A8 "${abdomen[@]}" --focus kidney_left,kidney_right "${kidneys[@]}"
  measure aorta A1,A5,A6,A7 "${dissection[@]}" --focus aorta_true_lumen,aorta_false_lumen,aorta --view auto
  measure vessels A5 "${abdomen[@]}" --focus kidney_left,kidney_right,aorta,inferior_vena_cava "${kidneys[@]}"
  measure lungs A5 "${organs[@]}" --focus "$lungs" --view anterior
  measure skeleton A5 "${torso[@]}" --transfer ct-bone --view anterior
  measure skin A5 "${torso[@]}" --view anterior
  measure brain A5 "${head[@]}" --focus 1 --view left
  measure stroke A5 "$data/head_stroke/stroke_T1.nii.gz" --view left
  measure knee A5 "${knee[@]}" --focus 83 --view auto
  for focus in spleen liver aorta pancreas stomach gallbladder duodenum; do
    measure "contrast-$focus" contrast "${abdomen[@]}" --focus "$focus" --view auto --materials contrast
  done
  measure contrast-kidneys contrast "${abdomen[@]}" --focus kidney_left,kidney_right --view auto --materials contrast
  measure contrast-small_bowel contrast "${organs[@]}" --focus small_bowel --view auto --materials contrast
  measure contrast-torso-liver contrast "${organs[@]}" --focus liver --view auto --materials contrast
  measure contrast-knee contrast "${knee[@]}" --focus 83 --view auto --materials contrast
fi
[ -n "$found" ] || die "${names[*]}: no such scene"

awk -F , '
  NR > 1 {
    bound = $5 == "" ? ($6 == "" ? "" : "<= " $6) : ($6 == "" ? ">= " $5 : $5 " to " $6)
    printf "%-22s %-9s %-18s %8s  %-9s %s\n", $1, $2, $3, $4 == "" ? "-" : $4, bound, $7
    if ($7 == "pass") ++passed
    else if ($7 != "") ++failed
  }
  END {
    printf "\n%d within their bounds, %d not\n", passed, failed
    exit failed > 0
  }' "$csv"
