#!/usr/bin/env bash
# Measures the GPU of this machine against its CPU, in less than four minutes and without network:
#   rates of S1, S2 and S2hi (1024 x 1024), million paths per second between 16 and 64 samples per pixel
#   seconds of images of the knee phantom and of the torso CT (512 x 512, 16 samples)
#   bits: GpuTests, which compare the GPU with its twin (a GPU whose division is not exact differs there)
# usage: bash Testing/Gpu/measure.sh
# FENESTRA_BUILD: an existing build [build]; FENESTRA_REFERENCE, FENESTRA_DATA: folders of scenes and volumes.
# FENESTRA_GPU=software measures Mesa's software device, with SIZE=64 to try the script.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../../Resources/setup.sh"
folder=$(realpath "${FENESTRA_BUILD:-$top/build}")
reference=${FENESTRA_REFERENCE:-$top/../shared/reference}
data=${FENESTRA_DATA:-$top/../shared/data}/abdomen_ct_totalseg
size=${SIZE:-1024}
program=$folder/bin/fenestra
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# value KEY: of the last run's statistics.
value() { grep -o "\"$1\": [0-9.e+-]*" "$work/stats.json" | head -n 1 | cut -d ' ' -f 2; }
# run DEVICE SAMPLES ARGUMENT...
run() {
  local device=$1 samples=$2
  shift 2
  "$program" "$@" --device "$device" --samples "$samples" --quiet --stats-json "$work/stats.json" 2>"$work/log" ||
    { cat "$work/log" >&2; die "fenestra failed"; }
}
# rate DEVICE SIZE ARGUMENT...: million paths per second.
rate() {
  local device=$1 pixels=$2 first
  shift 2
  run "$device" 16 "$@" --size "${pixels}x$pixels" --output "$work/image.exr" --layers color
  first=$(value transport)
  run "$device" 64 "$@" --size "${pixels}x$pixels" --output "$work/image.exr" --layers color
  awk -v a="$first" -v b="$(value transport)" -v n="$pixels" 'BEGIN { printf "%.2f", 48e-6 * n * n / (b - a) }'
}

"$program" --device list
grep -m 1 "model name" /proc/cpuinfo | sed 's/.*: //'
nproc | sed 's/$/ threads/'

printf '\n%-8s %12s %12s   million paths per second\n' scene GPU CPU
cd "$reference"
for scene in S1 S2 S2hi; do
  arguments=()
  while IFS= read -r word; do arguments+=("$word"); done <"$scene.arguments"
  for i in "${!arguments[@]}"; do
    [ "${arguments[i]:-}" != --size ] || unset "arguments[i]" "arguments[i+1]"
  done
  arguments+=(--volume-smoothing off)
  printf '%-8s %12s %12s\n' "$scene" "$(rate gpu "$size" "${arguments[@]}")" \
    "$(rate cpu $((size / 4)) "${arguments[@]}")"
done

printf '\n%-8s %-4s %10s %10s %10s %10s   seconds\n' image on transport features denoise total
"$program" phantom knee --output "$work/knee" >/dev/null 2>&1
image() {
  local name=$1 device
  shift
  for device in gpu cpu; do
    run "$device" 16 "$@" --size "$((size / 2))x$((size / 2))" --output "$work/$name-$device.png"
    printf '%-8s %-4s %10s %10s %10s %10s\n' "$name" $device "$(value transport)" "$(value features)" \
      "$(value filter)" "$(value total)"
  done
}
image knee "$work/knee/knee.mrml" --focus FemoralCartilage --clip surface --clip-boundary exact
[ ! -e "$data" ] || image torso "$data/ct.nii.gz" --segmentation "$data/seg_multiorgan.nii.gz" --focus liver

[ ! -x "$folder/bin/GpuTests" ] || { "$folder/bin/GpuTests" --gtest_brief=1 | tail -n 3; }
