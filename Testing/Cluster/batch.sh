#!/usr/bin/env bash
# Resources/cluster/study.sbatch as a real array job of a Slurm of one machine: its rows equal those of
# `fenestra study` on this machine, bit for bit, and a row that fails ends no other.
# usage: study.sh FENESTRA FOLDER; FOLDER is emptied first. Exit status 77: skipped.
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
flags=(--size 64x64 --samples 4)

start_cluster
script=$top/Resources/cluster/study.sbatch
options=(--parsable --cpus-per-task=1)
array=$(sbatch "${options[@]}" --array=1-4 "$script" cases.csv results "${flags[@]}")
last=$(sbatch "${options[@]}" --output=%x-%j.log --dependency="afterany:$array" "$script" cases.csv results "${flags[@]}")
squeue
wait_for_jobs 300
print_jobs

"$FENESTRA" study cases.csv --output alone "${flags[@]}" >alone.log 2>&1 && fail "the torn row did not fail"
for picture in alone/*/*.png; do
  cmp "$picture" "results/${picture#alone/}" || fail "a row of the array job differs: $picture"
done
[ "$(grep -c ',done,0,' results/study.csv)" -eq 8 ] || fail "the summary lacks rows"
grep -q '^torn,failed,3,' results/study.csv || fail "the torn row is not told"
[ -s results/study.png ] || fail "there is no contact sheet"
grep -q '8 of 9 rows done, 1 rendered now' "fenestra-study-$last.log" || fail "the last job made rows again"
printf '\nThe array job %s made 8 rows as one machine makes them.\n' "$array"
