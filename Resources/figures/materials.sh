#!/usr/bin/env bash
# Renders focus segments of real volumes in their natural colors, with --materials contrast, and as that appears with
# deuteranopia. Writes section "materials" of README.md. usage: bash Resources/figures/materials.sh
source "$(dirname "${BASH_SOURCE[0]}")/figures.sh"
page=$out/materials.md
size=${SIZE:-512}
[ -e "$data" ] || die "$data: not found; set FENESTRA_DATA to the folder of volumes"

abdomen="$data/abdomen_ct_totalseg/ct.nii.gz --segmentation $data/abdomen_ct_totalseg/seg_multiorgan.nii.gz"
chest="$aorta/ct_cropped.nii.gz --segmentation $aorta/labels.nii.gz --labels $aorta/labels.ctbl"
heart=heart,aorta,aorta_true_lumen,aorta_false_lumen,pulmonary_artery,brachiocephalic_trunk
heart+=,subclavian_artery_left,common_carotid_artery_left

cat >"$page" <<'END'
## Segment colors

Written by `materials.sh`. Left: the library's natural [colors](../materials/README.md), the default in CT. Middle:
`--materials contrast`, which adjusts them just enough that the focus is distinguishable from its surroundings. Right: a
simulation of deuteranopia (Machado, Oliveira, Fernandes 2009) of the middle image. The contrasts are those that the renderer
[expects](../../Renderer/program/README.md) between the focus and the neighbor that differs least: CIELAB ΔE for normal,
protan and deutan vision, and ΔL*. The targets of `--materials contrast` are 20, 12, 12 and 8.
END

# print_contrast NAME: prints ΔE for normal, protan and deutan vision, and ΔL* of an image, as the renderer expects them.
print_contrast() {
  printf '%s, %s, %s and %s' "$(get "$1" .contrast.deltaE %.0f)" "$(get "$1" .contrast.deltaEProtan %.0f)" \
    "$(get "$1" .contrast.deltaEDeutan %.0f)" "$(get "$1" .contrast.deltaL %.0f)"
}

# add NAME TITLE "TEXT" "ARGUMENTS" IMAGE...: adds images, side by side, to the page.
add() {
  convert "${@:5}" +append -quality 85 "$figures/materials-$1.jpg"
  printf '\n![%s](materials-%s.jpg)\n**%s.** %s\n`%s`\n' "$2" "$1" "$2" "$3" "${4//$data\//}" >>"$page"
}

# show NAME TITLE "TEXT" "ARGUMENTS": renders with the library and with contrast, simulates, and adds the images.
show() {
  local name=materials-$1
  # shellcheck disable=SC2086
  render "$name" $4 --materials library
  # shellcheck disable=SC2086
  render "$name-contrast" $4 --materials contrast
  convert "$out/$name-contrast.png" -colorspace RGB -color-matrix \
    '0.367322 0.860646 -0.227968 0.280085 0.672501 0.047413 -0.011820 0.042940 0.968881' -colorspace sRGB \
    "$out/$name-deutan.png"
  add "$1" "$2" "$3 Contrast: $(print_contrast "$name"); adjusted: $(print_contrast "$name-contrast")." "$4" \
    "$out/$name.png" "$out/$name-contrast.png" "$out/$name-deutan.png"
}

show heart "Heart, aorta and pulmonary artery" "A CT with contrast agent of a dissected aorta." "$chest --focus $heart --view left"
show kidneys "Kidneys from behind" "A CT of 3 mm." "$abdomen --focus kidney_left,kidney_right --view posterior"
show liver "Liver" "The same CT." "$abdomen --focus liver --view auto"

# Segments that the clip does not remove.
opened="$abdomen --view anterior --clip plane --plane 0,135,300,0,1,0 --materials library"
for segment in aorta inferior_vena_cava portal_vein_and_splenic_vein iliac_artery_left iliac_artery_right kidney_left \
  kidney_right; do
  opened+=" --material $segment:clip=no"
done
# shellcheck disable=SC2086
render materials-opened $opened
add opened "Vessels and kidneys in an opened abdomen" \
  "They have \`clip=no\`; the plane removes everything else in front of them." "$opened" "$out/materials-opened.png"
cat >>"$page" <<'END'

Chest and abdomen: [TotalSegmentator](https://github.com/wasserth/TotalSegmentator), Apache 2.0.
END
write_section materials
