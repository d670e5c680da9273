#!/usr/bin/env bash
# Measures what the pages cite of this project, with the programs of a finished build. Needs nothing else but bash,
# coreutils, findutils, grep, sed and awk, so it also runs on a machine without compilers.
# usage: bash Testing/Report/measure.sh BUILD OUT [PART...]
#   matrix      Fenestra against the oracle, 240 combinations (MatrixTests)
#   mutations   mutation testing (MutationTests)
#   denoiser    error estimates of the denoiser (DenoiserBenchmark)
#   efficiency  error against CPU time (EfficiencyBenchmark); nothing else should run on the machine
# Only if named, since they need more: figures, the images and numbers of Resources/figures.
# Writes OUT/PART.entry and OUT/PART.csv; `bash Testing/evidence.sh store OUT` puts them into the record.
# Environment: FENESTRA_INSTRUCTIONS [AVX2]; FENESTRA_REFERENCE and FENESTRA_DATA, folders of the scenes [those of the build]; FENESTRA_TRIAL=1 runs
# a small piece of each part, which cannot be stored.
set -euo pipefail
testing=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
die() {
  printf 'measure.sh: %s\n' "$*" >&2
  exit 1
}
[ $# -ge 2 ] || die "usage: measure.sh BUILD OUT [PART...]"
bin=$(cd "$1/bin" && pwd) || die "$1: not a build folder"
out=$(mkdir -p "$2" && cd "$2" && pwd)
shift 2
[ $# -gt 0 ] || set -- matrix mutations denoiser efficiency
export FENESTRA_INSTRUCTIONS=${FENESTRA_INSTRUCTIONS:-AVX2} # what most users have
export FENESTRA_MUTATION_LIST=$testing/Statistical/Mutations/mutations.json
cores=$(nproc)
trial=${FENESTRA_TRIAL:+trial-}
counts=2,4,8,16,64
denoised=(S1 S2 S2hi knee brain spine) # of denoiser-scenes.txt
scenes=(S1 S2)                        # of scenes.txt
modes=(product scalar global marching)
budget=60
if [ -n "$trial" ]; then
  export FENESTRA_COMBINATIONS=8 FENESTRA_MUTATIONS=MajorantFromMaxScalar
  counts=4 denoised=(S1 S2) scenes=(S1 S2) modes=(product scalar global) budget=1
fi

# write_entry PART RESULT: writes PART,date,CPU,cores,commit,"result".
write_entry() {
  local cpu commit
  cpu=$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1 | tr , ' ')
  commit=$("$bin/fenestra" --version | sed -n 's/^commit: \([^,]*\).*/\1/p')
  printf '%s,%s,%s,%s,%s,"%s"\n' "$1" "$(date +%F)" "${cpu:-unknown CPU} ($FENESTRA_INSTRUCTIONS)" "$cores" "$trial$commit" "$2" |
    tee "$out/$1.entry"
}

# run_jobs PART PARALLEL: runs the command in each line of standard input, `NAME COMMAND...` with quoted words, and joins
# the CSV tables that they print, in the order of the names, as OUT/PART.csv. A table without rows is an error: the data
# of the scene are missing.
run_jobs() {
  local folder=$out/$1
  mkdir -p "$folder/jobs"
  xargs -P "$2" -L 1 bash -c 'job=$0/$1; shift
    "$@" >"$job.csv" 2>"$job.log" && [ "$(wc -l <"$job.csv")" -gt 1 ] || { tail -n 3 "$job.log" >&2; exit 1; }' \
    "$folder/jobs" || die "$1: a program failed (logs: $folder/jobs)"
  awk 'NR == 1 || FNR > 1' "$folder"/jobs/*.csv >"$out/$1.csv"
}
# quote WORD...: prints a line for run_jobs; xargs would join a line that ends with a blank with the next one.
quote() {
  local line
  line=$(printf ' %q' "$@")
  echo "${line# }"
}

make_phantoms() {
  local kind
  for kind in knee foot; do
    [ -e "$out/phantoms/$kind/$kind.mrb" ] || "$bin/fenestra" phantom "$kind" --output "$out/phantoms/$kind" >/dev/null
  done
}

measure_matrix() {
  local log=$out/matrix.log
  "$bin/MatrixTests" --gtest_filter=-GpuMatrix.* >"$log" 2>&1 || die "images differ from the oracle's: see $log"
  write_entry matrix "$(awk '
    match($0, /: probability [^ ]*/) {
      p = substr($0, RSTART + 14, RLENGTH - 14) + 0
      if (!tests++ || p < least) least = p
    }
    /^combinations: / { split($0, part, /[:,] */) }
    END { printf "%d combinations, %d samples per pixel, both integrators: the smallest of %d probabilities is %.2g, the bound %.2g", part[2], part[4], tests, least, part[6] }' "$log")"
}

measure_mutations() {
  local log=$out/mutations.log
  "$bin/MutationTests" >"$log" 2>&1 || die "some errors were not found: see $log"
  write_entry mutations "$(grep -c '"name":' "$FENESTRA_MUTATION_LIST") errors, some of them in both integrators: \
$(sed -n 's/^mutations found: //p' "$log") found"
}

measure_denoiser() {
  make_phantoms
  rm -rf "$out/denoiser"
  local scene
  for scene in "${denoised[@]}"; do
    quote "$scene" "$bin/DenoiserBenchmark" --table "$testing/Benchmarks/denoiser-scenes.txt" --scenes "$scene" \
      --counts "$counts" --referencesamples 512 --references "$out/denoiser/references" --phantoms "$out/phantoms"
  done | run_jobs denoiser $((cores < 8 ? 1 : 3))
  # Without CPU seconds: the jobs share the cores.
  cut -d, -f1-6 "$out/denoiser.csv" >"$out/denoiser/columns.csv"
  mv "$out/denoiser/columns.csv" "$out/denoiser.csv"
  write_entry denoiser "$(awk -F, '
    NR > 1 && $6 != "" {
      scenes += $1 != last; last = $1
      if (!cases++ || $6 < least) least = $6
      if ($6 > most) most = $6
      good += $6 >= 0.75 && $6 <= 1.33
    }
    END { printf "the estimate was 0.75 to 1.33 times the true error in %d of %d cases (%d scenes), %.2f to %.2f in all", good, cases, scenes, least, most }' "$out/denoiser.csv")"
}

measure_efficiency() {
  rm -rf "$out/efficiency"
  local group i mode
  for group in "${modes[0]}" "${modes[*]:1}"; do # the first mode makes the reference
    for i in "${!scenes[@]}"; do
      for mode in $group; do
        quote "$i-$mode" "$bin/EfficiencyBenchmark" --table "$testing/Benchmarks/scenes.txt" --scenes "${scenes[i]}" \
          --modes "$mode" --budget $budget --seeds 2 --threads 2 --references "$out/efficiency/references" \
          --phantoms "$out/phantoms"
      done
    done | run_jobs efficiency $((cores < 8 ? 1 : cores / 4))
  done
  write_entry efficiency "$(awk -F, '
    { of[$1, $2] = $5 }
    function cite(scene) {
      return sprintf("%s: %.3g, %.2g times that of scalar and %.2g times that of global", scene, of[scene, "product"],
        of[scene, "product"] / of[scene, "scalar"], of[scene, "product"] / of[scene, "global"])
    }
    END { print cite("S1") "; " cite("S2") }' "$out/efficiency.csv")"
}

measure_figures() {
  local name
  for name in modes techniques figure1 figure3 materials; do
    FENESTRA=$bin/fenestra bash "$testing/../Resources/figures/$name.sh"
  done
  write_entry figures "clip modes, techniques, figures 1 and 3, segment colors"
}

for part in "$@"; do
  "measure_$part"
done
