#!/usr/bin/env bash
# Images by several MPI ranks must equal those of one process byte for byte, with --samples and with --noise, raw and
# denoised, also if another number of processes began them.
# If a rank is killed, the job must end and name the rank, and a single process must resume from the checkpoint.
# --seconds, a signal to one rank, different instruction sets and a usage error must end all ranks.
# usage: ranks.sh FENESTRA FENESTRA_MPI RANKS...; exit status 77: skipped.
set -euo pipefail
export LC_ALL=C
skip() {
  printf 'SKIPPED: %s\n' "$*"
  exit 77
}
[ -x "$2" ] || skip "$2 is not built"
command -v mpirun >/dev/null || skip "mpirun is not installed"
program=$(realpath "$1") program_mpi=$(realpath "$2")
shift 2
work=$(mktemp -d "${TMPDIR:-/tmp}/ranks-XXXXXX")
trap 'rm -rf "$work"' EXIT
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
errors=0
fail() {
  printf 'ranks.sh: %s\n' "$*"
  errors=$((errors + 1))
}

# run_ranks RANKS COMMAND...: runs a command by mpirun.
run_ranks() {
  local ranks=$1
  shift
  timeout 600 mpirun --oversubscribe --bind-to none -n "$ranks" "$@"
}

# enter_folder NAME: enters a new folder with a volume of 4^3 voxels.
enter_folder() {
  mkdir -p "$work/$1"
  cd "$work/$1"
  {
    printf 'NRRD0004\ntype: uint8\ndimension: 3\nspace: left-posterior-superior\nsizes: 4 4 4\n'
    printf 'space directions: (1,0,0) (0,1,0) (0,0,1)\nspace origin: (0,0,0)\nencoding: raw\n\n'
    printf '0123456789abcdefghijklmnopqrstuvwxyz@ABCDEFGHIJKLMNOPQRSTUVWXYZ$%%'
  } >volume.nrrd
}

# find_rank RANK: prints the process id of that rank of the job in the current folder.
find_rank() {
  local id
  for id in $(pgrep -f "^$program_mpi " || true); do
    if tr '\0' '\n' <"/proc/$id/environ" 2>/dev/null | grep -qx "OMPI_COMM_WORLD_RANK=$1" &&
      [ "$(readlink "/proc/$id/cwd")" = "$PWD" ]; then
      printf '%s' "$id"
      return
    fi
  done
}

# start_ranks COMMAND...: starts two ranks, and waits until their checkpoint exists.
start_ranks() {
  run_ranks 2 "$program_mpi" "$@" >out 2>&1 &
  run=$!
  until [ -e v.film ]; do
    kill -0 "$run" 2>/dev/null || { fail "no checkpoint: $(cat out)"; return; }
    sleep 0.05
  done
}

# wait_for_run: waits for the job of start_ranks; sets status.
wait_for_run() {
  status=0
  wait "$run" || status=$?
  times >"$work/times"
}

# count_cpu_seconds: prints the user time of all jobs waited for.
count_cpu_seconds() {
  awk 'NR == 2 { split($1, time, "[ms]"); print int(60 * time[1] + time[2]) }' "$work/times"
}

samples=(volume.nrrd --size 72x64 --samples 20 --threads 1 --progress none --output v.exr --output v.png)
noise=(volume.nrrd --size 72x64 --noise 0.15 --threads 1 --progress none --output v.exr)
denoised=(volume.nrrd --size 72x64 --noise 0.08 --threads 1 --progress none --output v.png)
for kind in samples noise denoised; do
  declare -n arguments=$kind
  enter_folder "$kind-alone"
  "$program" "${arguments[@]}" >out 2>&1 || fail "$(cat out)"
  for ranks in "$@"; do
    enter_folder "$kind-$ranks"
    run_ranks "$ranks" "$program_mpi" "${arguments[@]}" >out 2>&1 || fail "$kind with $ranks ranks: $(cat out)"
    for file in ../"$kind"-alone/v.*; do
      cmp "$file" "$(basename "$file")" || fail "$kind: $ranks ranks differ from one process"
    done
  done
done

# Only rank 0 reads files, so the other rank can run in a folder without them.
enter_folder elsewhere
timeout 600 mpirun --oversubscribe --bind-to none -n 1 "$program_mpi" "${samples[@]}" : \
  -n 1 --wdir / "$program_mpi" "${samples[@]}" >out 2>&1 || fail "files of rank 0: $(cat out)"
cmp ../samples-alone/v.exr v.exr || fail 'files of rank 0: the image differs'

enter_folder seconds
run_ranks 2 "$program_mpi" volume.nrrd --size 64x64 --samples 100000000 --seconds 1 --threads 1 --progress none \
  --output v.exr >out 2>&1 || fail "--seconds: $(cat out)" # the samples alone would take days

long=(volume.nrrd --size 64x64 --samples 250 --threads 1 --progress none --checkpoint v.film --output v.exr)
enter_folder long-alone
"$program" "${long[@]}" >out 2>&1 || fail "$(cat out)"
enter_folder dead
start_ranks "${long[@]}"
kill -9 "$(find_rank 1)" || fail 'no rank 1'
wait_for_run
[ "$status" -ne 0 ] || fail 'the job succeeds although rank 1 was killed'
grep -q 'rank 1 ' out || fail "the output does not name the killed rank: $(cat out)"
rm -f v.exr
"$program" "${long[@]}" >out 2>&1 || fail "cannot resume from the checkpoint of the killed job: $(cat out)"
cmp ../long-alone/v.exr v.exr || fail 'the resumed image differs'

enter_folder stopped
start_ranks "${long[@]}"
kill -TERM "$(find_rank 0)" || fail 'no rank 0'
wait_for_run
[ "$status" -eq 5 ] || fail "SIGTERM ends with status $status: $(cat out)"
[ -e v.exr ] || fail 'no image after SIGTERM'
run_ranks 3 "$program_mpi" "${long[@]}" >out 2>&1 || fail "other ranks cannot resume: $(cat out)"
cmp ../long-alone/v.exr v.exr || fail 'the image that other ranks resumed differs'

# The first pass takes about 60 CPU seconds per rank. A stop of one rank must end it on both.
enter_folder stopped-pass
times >"$work/times"
before=$(count_cpu_seconds)
start_ranks volume.nrrd --size 1000x1000 --density-scale 100 --bounces 1000 --threads 1 --progress none \
  --checkpoint v.film --output v.exr
kill -TERM "$(find_rank 1)" || fail 'no rank 1'
wait_for_run
[ "$status" -eq 5 ] || fail "SIGTERM to rank 1 ends with status $status: $(cat out)"
spent=$(($(count_cpu_seconds) - before))
[ "$spent" -lt 30 ] || fail "ranks work for $spent CPU seconds although one was stopped"

# One process begins, with a higher noise; ranks continue its sample plan.
plan=(volume.nrrd --size 72x64 --threads 1 --progress none --checkpoint v.film --output v.exr --noise)
enter_folder plan-alone
"$program" "${plan[@]}" 0.15 >out 2>&1 || fail "$(cat out)"
enter_folder plan
"$program" "${plan[@]}" 0.2 >out 2>&1 || fail "$(cat out)"
run_ranks 2 "$program_mpi" "${plan[@]}" 0.15 >out 2>&1 || fail "ranks cannot resume: $(cat out)"
cmp ../plan-alone/v.exr v.exr || fail 'the image that ranks resumed from one process differs'

enter_folder refused
status=0
timeout 600 mpirun --oversubscribe --bind-to none -n 1 -x FENESTRA_INSTRUCTIONS=SSE4 "$program_mpi" "${samples[@]}" : \
  -n 1 -x FENESTRA_INSTRUCTIONS=SCALAR "$program_mpi" "${samples[@]}" >out 2>&1 || status=$?
{ [ "$status" -eq 2 ] && grep -q 'rank 1 is .*, rank 0 is ' out; } ||
  fail "different instruction sets end with status $status: $(cat out)"
status=0
run_ranks 2 "$program_mpi" volume.nrrd --samples none >out 2>&1 || status=$?
{ [ "$status" -eq 2 ] && [ "$(grep -c '^fenestra: error: ' out)" -eq 1 ]; } ||
  fail "a usage error ends with status $status: $(cat out)"

echo "$errors errors"
[ "$errors" -eq 0 ]
