#!/usr/bin/env bash
# Runs Resources/cluster/mpi.sbatch on a single-node Slurm cluster: the image of two MPI ranks must equal that of
# `fenestra render` bit for bit, with --samples and with --noise.
# usage: mpi.sh FENESTRA FENESTRA_MPI FOLDER; FOLDER is emptied first. Exit status 77: skipped.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
top=$(cd "$here/../.." && pwd)
source "$here/cluster.sh"
[ -x "$2" ] || skip "$2 is not built"
FENESTRA_MPI=$(realpath "$2")
export FENESTRA_MPI OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
begin_test "$1" "$3"

cp "$top/Testing/Data/knee/knee.mrb" .
arguments=(knee.mrb --focus FemoralCartilage --size 96x96)
start_cluster
options=(--parsable --ntasks=2 --ntasks-per-node=2 --cpus-per-task=1)
script=$top/Resources/cluster/mpi.sbatch
samples=$(sbatch "${options[@]}" "$script" "${arguments[@]}" --samples 16 --output samples.exr --output samples.png)
noise=$(sbatch "${options[@]}" "$script" "${arguments[@]}" --noise 0.1 --output noise.exr --output noise.png)
squeue
wait_for_jobs 300
print_jobs

"$FENESTRA" "${arguments[@]}" --samples 16 --output alone-samples.exr --output alone-samples.png >alone.log 2>&1
"$FENESTRA" "${arguments[@]}" --noise 0.1 --output alone-noise.exr --output alone-noise.png >>alone.log 2>&1
for kind in samples noise; do
  cmp "alone-$kind.png" "$kind.png" || fail "the image of job ${!kind} differs"
  "$FENESTRA" compare "$kind.exr" "alone-$kind.exr" | grep -q '^largest  *0$' ||
    fail "the channels of job ${!kind} differ"
done
printf '\nThe jobs %s and %s, with two ranks each, rendered the images of a single process.\n' "$samples" "$noise"
