#!/usr/bin/env bash
# Runs a batch of 12 cases, real data and phantoms, kills it halfway and runs it again. The second run must
# complete it and not render finished rows again.
# usage: twelve.sh FENESTRA DATA FOLDER [OPTIONS...]
# DATA: folder of the real data; exit status 77 if it does not exist. FOLDER: for table, phantoms and
# results; emptied first. OPTIONS: for all rows, instead of --size 400x400 --samples 24 --workers 2.
set -euo pipefail
fenestra=$(realpath "$1") data=$2 folder=$3
shift 3
[ $# -gt 0 ] || set -- --size 400x400 --samples 24 --workers 2
fail() {
  printf 'twelve.sh: %s\n' "$*" >&2
  exit 1
}
if [ ! -d "$data/torso_ct_ccth_a01" ]; then
  printf 'SKIPPED: needs the real data in %s\n' "$data"
  exit 77
fi
data=$(realpath "$data")
rm -rf "$folder"
mkdir -p "$folder"
cd "$folder"
for phantom in knee foot fetus; do
  "$fenestra" phantom "$phantom" --quiet
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
batch=("$fenestra" batch cases.csv --output results "$@")

# count_done_rows: prints the number of finished rows, by their manifests.
count_done_rows() { { grep -ls '"status": 0$' results/*/*.study.json || true; } | wc -l; }

"${batch[@]}" >first.log 2>&1 &
id=$!
while [ "$(count_done_rows)" -lt 6 ] && kill -0 $id 2>/dev/null; do sleep 0.1; done
kill -KILL $id || fail "the batch ended before it could be killed: $(tail -n 1 first.log)"
wait $id 2>/dev/null || true
before=$(count_done_rows)
[ ! -e results/study.csv ] || fail "the killed batch has written its summary"
grep -ls '"status": 0$' results/*/*.study.json | sed 's/study.json$/json/' | tr '\n' '\0' |
  xargs -0 sha256sum >finished.sums

"${batch[@]}" 2>&1 | tee second.log
sha256sum --quiet -c finished.sums || fail "a finished row was rendered again"
[ "$(count_done_rows)" -eq 12 ] || fail "$(count_done_rows) of 12 rows are done"
grep -q "12 of 12 rows done, $((12 - before)) rendered now" second.log ||
  fail "expected exactly the missing rows to be rendered: $(tail -n 1 second.log)"
[ "$(grep -c ',done,0,' results/study.csv)" -eq 12 ] || fail "the summary has too few finished rows"
[ "$(find results -type f | wc -l)" -eq $((2 + 12 * 3)) ] || fail "unexpected files: $(find results -type f)"
printf 'Killed after %s of 12 rows, then completed: %s\n' "$before" "$folder/results/study.png"
