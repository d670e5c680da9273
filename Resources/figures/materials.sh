#!/usr/bin/env bash
# Pictures of foci in the colours of what they are made of, each beside how a deuteranope sees it, from real
# volumes: Resources/figures/materials.md. What was measured stands there if LookBenchmark is built
# (Testing/Benchmarks/look.sh builds it). usage: bash Resources/figures/materials.sh
source "$(dirname "${BASH_SOURCE[0]}")/figures.sh"
page=$shown/materials.md
size=${SIZE:-1024}
samples=${SAMPLES:-32}
look=$top/build/bin/LookBenchmark
[ -e "$data" ] || die "$data is not there: FENESTRA_DATA names the folder of volumes"

abdomen="$data/abdomen_ct_totalseg/ct.nii.gz --segmentation $data/abdomen_ct_totalseg/seg_multiorgan.nii.gz"
knee="$data/spl_knee_atlas_labels/SYNTHETIC_mr_256.nii.gz --segmentation $data/spl_knee_atlas_labels/seg_256.nii.gz"
knee+=" --labels $data/spl_knee_atlas_labels/knee.ctbl"
torso="$data/torso_ct_ccth_a01/ct.nii.gz --segmentation $data/torso_ct_ccth_a01/seg_totalsegmentator_rtstruct.nii.gz"

cat >"$page" <<'END_OF_PAGE'
# Colours of what segments are made of

Made by `materials.sh` with `--materials auto`: the library's [colours](../materials/README.md), changed no more than
the focus needs to be told from what surrounds it. Right: as a deuteranope sees it (Machado, Oliveira, Fernandes 2009).
The numbers were [measured](../../Testing/Benchmarks/README.md#the-look-lookbenchmark) at 512 × 512 across the edge of
the focus, in CIELAB, for normal sight, for the red-blind, for the green-blind, and of lightness alone; wanted are 20,
12, 12 and 8.

END_OF_PAGE

# measured "ARGUMENTS": ΔE*ab, protan, deutan, ΔL* of the picture, to 0.6 (look-scenes.txt); a dash without
# LookBenchmark.
measured() {
  local cells="" table=$out/materials-scene.txt
  if [ -x "$look" ]; then
    echo "this product $1 --samples 8 --size 512x512" >"$table"
    cells=$("$look" --table "$table" | awk -F ' *[|] *' 'NR == 3 { print $5 ", " $6 ", " $7 " and " $8 }')
  fi
  echo "${cells:--}"
}

# show NAME TITLE "WHAT" "ARGUMENTS": the picture, twice, and a paragraph of the page.
show() {
  local name=materials-$1
  # shellcheck disable=SC2086
  render "$name" $4
  convert "$out/$name.png" \( +clone -colorspace RGB -color-matrix \
    '0.367322 0.860646 -0.227968 0.280085 0.672501 0.047413 -0.011820 0.042940 0.968881' -colorspace sRGB \) \
    +append -quality 84 "$shown/$name.jpg"
  {
    printf '## %s\n\n![%s](%s.jpg)\n\n%s\n\n`%s`\n\n' "$2" "$2" "$name" "$3" "${4//$data\//}"
  } >>"$page"
}

# setOff NAME TITLE "WHAT" "ARGUMENTS": show, with --materials auto and what was measured.
setOff() {
  local all="$4 --materials auto"
  show "$1" "$2" "$3 Told from what surrounds it by $(measured "$all")." "$all"
}

setOff liver "Liver" "The liver's own colour; fat around it a little lighter." "$abdomen --focus liver --view auto"
setOff kidneys "Kidneys from behind" "A little darker than the library has them, since fat around them lies in their shade." \
  "$abdomen --focus kidney_left --focus kidney_right --view posterior"
setOff aorta "Aorta with veins" "Behind it the vena cava, the portal vein, liver, gallbladder, spleen and kidney by name." \
  "$abdomen --focus aorta --view auto"
setOff cartilage "Cartilage of the knee" "What surrounds it is dimmed, since much of that is nearly as white: bone, fat, menisci." \
  "$knee --focus 83 --view auto"
setOff torso "Torso: bones, lungs and liver" "Of the lungs the transfer function shows the vessels." "$torso --focus liver --view auto"

# What the clip leaves of an opened abdomen.
opened="$abdomen --view anterior --clip plane --plane 0,135,300,0,1,0 --materials library"
for segment in aorta inferior_vena_cava portal_vein_and_splenic_vein iliac_artery_left iliac_artery_right kidney_left \
  kidney_right; do
  opened+=" --material $segment:clip=no"
done
show opened "Vessels and kidneys stand in an opened abdomen" \
  "Each of them has \`clip=no\`: the plane removes all else in front of it." "$opened"
say "Done: $page"
