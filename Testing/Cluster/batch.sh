#!/usr/bin/env bash
# Runs Resources/cluster/batch.sbatch as an array job on a single-node Slurm cluster: its rows must equal those
# of a local `fenestra batch` bit for bit, and a failed row must not end the others.
# usage: batch.sh FENESTRA FOLDER; FOLDER is emptied first. Exit status 77: skipped.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
top=$(cd "$here/../.." && pwd)
source "$here/cluster.sh"
begin_test "$1" "$2"

cp "$top/Testing/Data/knee/knee.mrb" "$top/Testing/Data/foot/foot.mrb" .
{
  printf 'name,input,focus,view\n'
  for view in anterior left right superior; do
    printf 'knee %s,knee.mrb,FemoralCartilage,%s\n' "$view" "$view"
    printf 'foot %s,foot.mrb,,%s\n' "$view" "$view"
  done
  printf 'torn,nothing.nrrd,,\n'
} >cases.csv
arguments=(--size 64x64 --samples 4)

start_cluster
script=$top/Resources/cluster/batch.sbatch
options=(--parsable --cpus-per-task=1)
array=$(sbatch "${options[@]}" --array=1-4 "$script" cases.csv results "${arguments[@]}")
last=$(sbatch "${options[@]}" --output=%x-%j.log --dependency="afterany:$array" "$script" cases.csv results "${arguments[@]}")
squeue
wait_for_jobs 300
print_jobs

"$FENESTRA" batch cases.csv --output alone "${arguments[@]}" >alone.log 2>&1 && fail "the row with a missing input did not fail"
for image in alone/*/*.png; do
  cmp "$image" "results/${image#alone/}" || fail "a row of the array job differs: $image"
done
[ "$(grep -c ',done,0,' results/study.csv)" -eq 8 ] || fail "the summary has too few finished rows"
grep -q '^torn,failed,3,' results/study.csv || fail "the summary does not list the failed row"
[ -s results/study.png ] || fail "no contact sheet"
grep -q '8 of 9 rows done, 1 rendered now' "fenestra-batch-$last.log" || fail "the last job rendered finished rows again"
printf '\nThe 8 rows of array job %s equal those of a single run.\n' "$array"
