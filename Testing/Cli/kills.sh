#!/usr/bin/env bash
# Kills a render with a film (--checkpoint) by SIGKILL at random moments, runs it again, and so on; each
# picture that it ends with must equal, byte for byte, that of a run that nothing interrupted, and beside
# picture and film nothing may be left. Prints counts; exits 1 where a picture or a file is wrong.
# usage: kills.sh FENESTRA KILLS [LEAST [SAMPLES [THREADS]]]
#   LEAST    kills after a film was written, at least; there may be more kills until then [0]
#   SAMPLES  a pixel; so many that the render takes a few seconds [400]
set -uo pipefail
export LC_ALL=C
program=$(realpath "$1")
kills=$2 least=${3:-0} samples=${4:-400} threads=${5:-1}
work=$(mktemp -d "${TMPDIR:-/tmp}/kills-XXXXXX")
trap 'rm -rf "$work"' EXIT
RANDOM=1
mkdir "$work/once" "$work/again"

# A volume of 4^3 voxels, and the same command in both folders.
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

# Time until the first film is there, ms; kills come in the half of that time more.
begin=$(date +%s%N)
"${command[@]}" >out 2>&1 &
run=$!
while [ ! -e v.film ] && kill -0 "$run" 2>/dev/null; do
  sleep 0.02
done
first=$((($(date +%s%N) - begin) / 1000000))
kill -9 "$run" 2>/dev/null
wait "$run" 2>/dev/null
rm -f out v.*

killed=0 after=0 pictures=0 wrong=0
# check: the picture of a whole run, and what is left beside it; then begins anew.
check() {
  pictures=$((pictures + 1))
  cmp ../once/v.exr v.exr || wrong=$((wrong + 1))
  if [ "$(ls -A | tr '\n' ' ')" != "v.exr v.film volume.nrrd " ]; then
    echo "left over: $(ls -A | tr '\n' ' ')"
    wrong=$((wrong + 1))
  fi
  rm -f v.exr v.film
}
# A busy machine may write no film for long: up to ten times as many kills then.
while [ "$killed" -lt "$kills" ] || { [ "$after" -lt "$least" ] && [ "$killed" -lt $((10 * kills)) ]; }; do
  "${command[@]}" >out 2>&1 &
  run=$!
  sleep "$(awk -v r="$RANDOM" -v first="$first" 'BEGIN { print 0.1 + 1.5 * r / 32768 * first / 1000 }')"
  if kill -9 "$run" 2>/dev/null; then
    [ -e v.film ] && after=$((after + 1))
    killed=$((killed + 1))
  fi
  wait "$run" 2>/dev/null
  status=$?
  rm -f out
  if [ "$status" -eq 0 ]; then
    check
  elif [ "$status" -ne 137 ]; then
    echo "ended with status $status"
    wrong=$((wrong + 1))
  fi
done
"${command[@]}" || wrong=$((wrong + 1))
check
echo "$killed kills, $after of them after a film was written; $pictures pictures, $wrong wrong"
[ "$wrong" -eq 0 ] && [ "$after" -ge "$least" ]
