#!/usr/bin/env bash
# A study of 12 cases, real data and phantoms: killed half way and run again, it has to end whole, with
# no row made twice.
# usage: twelve.sh FENESTRA DATA FOLDER [FLAGS...]
# DATA: folder of the real data; without it the study is skipped, visibly. FOLDER: for table, phantoms
# and results, emptied first. FLAGS: for all rows, in place of --size 400x400 --samples 24 --workers 2.
set -euo pipefail
fenestra=$(realpath "$1") data=$2 folder=$3
shift 3
[ $# -gt 0 ] || set -- --size 400x400 --samples 24 --workers 2
fail() {
  printf 'twelve.sh: %s\n' "$*" >&2
  exit 1
}
if [ ! -d "$data/torso_ct_ccth_a01" ]; then
  printf 'SKIPPED: the study of 12 cases, for there is no real data at %s\n' "$data"
  exit 77
fi
data=$(realpath "$data")
rm -rf "$folder"
mkdir -p "$folder"
cd "$folder"
for phantom in knee foot fetus; do
  "$fenestra" phantom "$phantom" >/dev/null
done
cat >cases.csv <<TABLE
name,input,segmentation,labels,focus,preset,view
knee phantom,knee/knee.mrml,,,,knee-cartilage,
foot phantom,foot/foot.mrml,,,,foot-bones,
fetus phantom,fetus/fetus.mrml,,,,fetal-face,
abdomen liver,$data/abdomen_ct_totalseg/ct.nii.gz,$data/abdomen_ct_totalseg/seg_multiorgan.nii.gz,,,liver,
abdomen spine,$data/abdomen_ct_totalseg/ct.nii.gz,$data/abdomen_ct_totalseg/seg_multiorgan.nii.gz,,,spine,
abdomen kidneys,$data/abdomen_ct_totalseg/ct.nii.gz,$data/abdomen_ct_totalseg/seg_multiorgan.nii.gz,,"kidney_left,kidney_right",,auto
torso liver,$data/torso_ct_ccth_a01/ct.nii.gz,$data/torso_ct_ccth_a01/seg_totalsegmentator_rtstruct.nii.gz,,,liver,
torso lungs,$data/torso_ct_ccth_a01/ct.nii.gz,$data/torso_ct_ccth_a01/seg_totalsegmentator_rtstruct.nii.gz,,,lungs,
chest scene,$data/slicer_scenes/slicer_5_2_written/chest.mrb,,,,lungs,
head MR,$data/head_mr_seg3d/t1.nii.gz,$data/head_mr_seg3d/seg_brain_skull.nii.gz,,1,,left
head CT DICOM,$data/head_ct_slicer_dicom/dicom,,,,,anterior
knee atlas,$data/spl_knee_atlas_labels/SYNTHETIC_mr_256.nii.gz,$data/spl_knee_atlas_labels/seg_256.nii.gz,$data/spl_knee_atlas_labels/knee.ctbl,,knee-cartilage,
TABLE
study=("$fenestra" study cases.csv --output results "$@")

# done_rows: how many rows their records tell to be done.
done_rows() { { grep -ls '"status": 0$' results/*/*.study.json || true; } | wc -l; }

"${study[@]}" >first.log 2>&1 &
id=$!
while [ "$(done_rows)" -lt 6 ] && kill -0 $id 2>/dev/null; do sleep 0.1; done
kill -KILL $id || fail "the study ended before it could be killed: $(tail -n 1 first.log)"
wait $id 2>/dev/null || true
before=$(done_rows)
[ ! -e results/study.csv ] || fail "a study that was killed has written its summary"
grep -ls '"status": 0$' results/*/*.study.json | sed 's/study.json$/json/' | tr '\n' '\0' |
  xargs -0 sha256sum >kept.sums

"${study[@]}" | tee second.log
sha256sum --quiet -c kept.sums || fail "a row that was done was made again"
[ "$(done_rows)" -eq 12 ] || fail "$(done_rows) of 12 rows are done"
grep -q "12 of 12 rows done, $((12 - before)) rendered now" second.log ||
  fail "not exactly the missing rows were made: $(tail -n 1 second.log)"
[ "$(grep -c ',done,0,' results/study.csv)" -eq 12 ] || fail "the summary lacks rows"
[ "$(find results -type f | wc -l)" -eq $((2 + 12 * 3)) ] || fail "files are left: $(find results -type f)"
printf 'Killed with %s of 12 rows done, and ended whole: %s\n' "$before" "$folder/results/study.png"
