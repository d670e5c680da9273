#!/usr/bin/env bash
# Prints how unequal the shards are that MPI ranks render, as CSV: the largest over the mean (ShardBenchmark). Knee and foot
# are phantoms; TORSO is a folder with a CT, ct.nii.gz, and the segments of TotalSegmentator, segments.nii.gz and
# segments.json. Takes a quarter of an hour; measure on an idle machine.
# usage: imbalance.sh FENESTRA SHARD_BENCHMARK [TORSO]
set -euo pipefail
program=$(realpath "$1") benchmark=$(realpath "$2")
work=$(mktemp -d "${TMPDIR:-/tmp}/imbalance-XXXXXX")
trap 'rm -rf "$work"' EXIT

# measure SCENE ARGUMENT...: prints the rows of a scene in two sizes, with equally many paths.
measure() {
  local case
  for case in '512x512 64' '1024x1024 16'; do
    "$benchmark" "${@:2}" --size "${case% *}" --samples "${case#* }" | sed "1d; s/^/$1,${case% *},/"
  done
}

printf 'scene,size,ranks,cpu_seconds,cpu_seconds_largest_to_mean,lookups_largest_to_mean\n'
for phantom in knee foot; do
  "$program" phantom "$phantom" --output "$work/$phantom" >/dev/null 2>&1
done
measure knee "$work/knee/knee.mrml" --focus FemoralCartilage
measure foot "$work/foot/foot.mrml" --focus Calcaneus
[ $# -lt 3 ] ||
  measure torso "$3/ct.nii.gz" --segmentation "$3/segments.nii.gz" --labels "$3/segments.json" --focus liver
