#!/usr/bin/env bash
# Runs Resources/cluster/shards.sbatch as an array job on a single-node Slurm cluster: the merged shards must
# equal the image of `fenestra render` bit for bit.
# usage: shards.sh FENESTRA FOLDER; FOLDER is emptied first. Exit status 77: skipped.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
top=$(cd "$here/../.." && pwd)
source "$here/cluster.sh"
begin_test "$1" "$2"

cp "$top/Testing/Data/knee/knee.mrb" .
arguments=(knee.mrb --focus FemoralCartilage --size 96x96 --samples 16)
start_cluster
array=$(sbatch --parsable --cpus-per-task=1 --array=1-5 "$top/Resources/cluster/shards.sbatch" shards "${arguments[@]}")
last=$(sbatch --parsable --dependency="afterok:$array" --output=fenestra-merge-%j.log \
  --wrap="\"$FENESTRA\" merge shards/*.film --output merged.exr --output merged.png")
squeue
wait_for_jobs 300
print_jobs

"$FENESTRA" "${arguments[@]}" --output alone.exr --output alone.png >alone.log 2>&1
cmp alone.png merged.png || fail "the merged image differs (job $last)"
"$FENESTRA" compare merged.exr alone.exr | grep -q '^largest  *0$' || fail "the merged channels differ (job $last)"
printf '\nThe 5 shards of array job %s were merged to the image of a single run.\n' "$array"
