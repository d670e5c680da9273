#!/usr/bin/env bash
# Kills a render with --checkpoint by SIGKILL at random times and starts it again, repeatedly. Each completed
# image must equal that of an uninterrupted run byte for byte, and only the image and its checkpoint may
# remain. Prints counts; exit status 1 if an image differs or other files remain.
# usage: kills.sh FENESTRA KILLS [MINIMUM [SAMPLES [THREADS]]]
#   MINIMUM  minimum number of kills after a checkpoint was written; further kills wait for one [0]
#   SAMPLES  per pixel; enough for a render of a few seconds [400]
set -uo pipefail
export LC_ALL=C
program=$(realpath "$1")
kills=$2 minimum=${3:-0} samples=${4:-400} threads=${5:-1}
work=$(mktemp -d "${TMPDIR:-/tmp}/kills-XXXXXX")
trap 'rm -rf "$work"' EXIT
RANDOM=1
mkdir "$work/once" "$work/again"

# Both folders get the same volume of 4^3 voxels and the same command.
for folder in once again; do
  {
    printf 'NRRD0004\ntype: uint8\ndimension: 3\nspace: left-posterior-superior\nsizes: 4 4 4\n'
    printf 'space directions: (1,0,0) (0,1,0) (0,0,1)\nspace origin: (0,0,0)\nencoding: raw\n\n'
    printf '0123456789abcdefghijklmnopqrstuvwxyz@ABCDEFGHIJKLMNOPQRSTUVWXYZ$%%'
  } >"$work/$folder/volume.nrrd"
done
command=("$program" volume.nrrd --size 64x64 --samples "$samples" --threads "$threads"
  --checkpoint v.film --output v.exr --progress none)
(cd "$work/once" && "${command[@]}") || exit 1
cd "$work/again" || exit 1

# Milliseconds until the first checkpoint exists; kills come before 1.5 times that, plus 0.1 s.
begin=$(date +%s%N)
"${command[@]}" >out 2>&1 &
run=$!
# wait_for_checkpoint: waits until the render has written a checkpoint or ended.
wait_for_checkpoint() {
  while [ ! -e v.film ] && kill -0 "$run" 2>/dev/null; do
    sleep 0.02
  done
}
wait_for_checkpoint
first=$((($(date +%s%N) - begin) / 1000000))
kill -9 "$run" 2>/dev/null
wait "$run" 2>/dev/null
rm -f out v.*

killed=0 after=0 images=0 errors=0
# check_results: compares the image of a completed run, checks the remaining files, and removes both results.
check_results() {
  images=$((images + 1))
  cmp ../once/v.exr v.exr || errors=$((errors + 1))
  if [ "$(ls -A | tr '\n' ' ')" != "v.exr v.film volume.nrrd " ]; then
    echo "unexpected files: $(ls -A | tr '\n' ' ')"
    errors=$((errors + 1))
  fi
  rm -f v.exr v.film
}
while [ "$killed" -lt "$kills" ] || [ "$after" -lt "$minimum" ]; do
  "${command[@]}" >out 2>&1 &
  run=$!
  if [ "$killed" -lt "$kills" ]; then
    sleep "$(awk -v r="$RANDOM" -v first="$first" 'BEGIN { print 0.1 + 1.5 * r / 32768 * first / 1000 }')"
  else # on a busy machine, all random times may have been too early
    wait_for_checkpoint
  fi
  if kill -9 "$run" 2>/dev/null; then
    [ -e v.film ] && after=$((after + 1))
    killed=$((killed + 1))
  fi
  wait "$run" 2>/dev/null
  status=$?
  rm -f out
  if [ "$status" -eq 0 ]; then
    check_results
  elif [ "$status" -ne 137 ]; then
    echo "ended with status $status"
    errors=$((errors + 1))
  fi
done
"${command[@]}" || errors=$((errors + 1))
check_results
echo "$killed kills, $after of them after a checkpoint was written; $images images, $errors errors"
[ "$errors" -eq 0 ] && [ "$after" -ge "$minimum" ]
