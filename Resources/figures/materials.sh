#!/usr/bin/env bash
# Renders focus segments of real volumes in their library colors, each beside a simulation of deuteranopia.
# Writes section "materials" of README.md, with contrasts measured by AppearanceBenchmark, which must be built beside
# the program. usage: bash Resources/figures/materials.sh
source "$(dirname "${BASH_SOURCE[0]}")/figures.sh"
page=$out/materials.md
size=${SIZE:-1024}
samples=${SAMPLES:-32}
benchmark=$(dirname "$fenestra")/AppearanceBenchmark
[ -x "$benchmark" ] || die "$benchmark: not found; build it"
[ -e "$data" ] || die "$data: not found; set FENESTRA_DATA to the folder of volumes"

abdomen="$data/abdomen_ct_totalseg/ct.nii.gz --segmentation $data/abdomen_ct_totalseg/seg_multiorgan.nii.gz"
knee="$data/spl_knee_atlas_labels/SYNTHETIC_mr_256.nii.gz --segmentation $data/spl_knee_atlas_labels/seg_256.nii.gz"
knee+=" --labels $data/spl_knee_atlas_labels/knee.ctbl"
torso="$data/torso_ct_ccth_a01/ct.nii.gz --segmentation $data/torso_ct_ccth_a01/seg_totalsegmentator_rtstruct.nii.gz"

cat >"$page" <<'END'
## Segment colors

Written by `materials.sh` with `--materials contrast`: the library's [colors](../materials/README.md), adjusted just enough that
the focus is distinguishable from its surroundings. Right: a simulation of deuteranopia (Machado, Oliveira, Fernandes
2009). The contrasts are [measured](../../Testing/Benchmarks/README.md) in CIELAB at 512 × 512 across the edge of the focus: ΔE
for normal, protan and deutan vision, and ΔL*. The targets are 20, 12, 12 and 8.
END

# measure_contrast "ARGUMENTS": prints ΔE*ab for normal, protan and deutan vision, and ΔL* of the image, within
# 0.6 of the value with more samples.
measure_contrast() {
  # shellcheck disable=SC2086
  "$benchmark" -- $1 --samples 8 --size 512x512 2>"$out/materials.log" |
    awk -F , '$2 == "contrast" { print $4 }' | paste -sd , | sed 's/,/, /g; s/, \([^,]*\)$/ and \1/'
}

# show NAME TITLE "TEXT" "ARGUMENTS": renders an image and its simulation, and adds them to the page.
show() {
  local name=materials-$1
  # shellcheck disable=SC2086
  render "$name" $4
  convert "$out/$name.png" \( +clone -colorspace RGB -color-matrix \
    '0.367322 0.860646 -0.227968 0.280085 0.672501 0.047413 -0.011820 0.042940 0.968881' -colorspace sRGB \) \
    +append -quality 84 "$figures/$name.jpg"
  printf '\n![%s](%s.jpg)\n**%s.** %s\n`%s`\n' "$2" "$name" "$2" "$3" "${4//$data\//}" >>"$page"
}

# show_contrast NAME TITLE "TEXT" "ARGUMENTS": show with --materials contrast and the measured contrast.
show_contrast() {
  local all="$4 --materials contrast"
  show "$1" "$2" "$3 Contrast: $(measure_contrast "$all")." "$all"
}

show_contrast liver "Liver" "Its library color; the fat around it is slightly lighter." "$abdomen --focus liver --view auto"
show_contrast kidneys "Kidneys from behind" "Slightly darker than in the library, since the fat around them is in their shadow." \
  "$abdomen --focus kidney_left --focus kidney_right --view posterior"
show_contrast aorta "Aorta with veins" "Behind it, colored by name: vena cava, portal vein, liver, gallbladder, spleen, kidney." \
  "$abdomen --focus aorta --view auto"
show_contrast cartilage "Cartilage of the knee" "The surroundings are darkened, since bone, fat and menisci are nearly as white." \
  "$knee --focus 83 --view auto"
show_contrast torso "Torso: bones, lungs and liver" "The transfer function shows the vessels of the lungs." "$torso --focus liver --view auto"

# Segments that the clip does not remove.
opened="$abdomen --view anterior --clip plane --plane 0,135,300,0,1,0 --materials library"
for segment in aorta inferior_vena_cava portal_vein_and_splenic_vein iliac_artery_left iliac_artery_right kidney_left \
  kidney_right; do
  opened+=" --material $segment:clip=no"
done
show opened "Vessels and kidneys in an opened abdomen" \
  "They have \`clip=no\`; the plane removes everything else in front of them." "$opened"
write_section materials
