#!/usr/bin/env bash
# Renders a scene on the GPU under Vulkan's validation layer, with its checks of synchronization. Fails if the layer
# prints a message. Skips (exit 77) without the layer. usage: validate.sh GPU_TESTS FILTER
set -euo pipefail
tests=$1 filter=$2
layer=VK_LAYER_KHRONOS_validation
between=VALIDATION_CHECK_ENABLE_SYNCHRONIZATION_VALIDATION_QUEUE_SUBMIT # also between submissions
log=$(mktemp)
trap 'rm -f "$log"' EXIT
status=0
# The layer keeps memory of its own. GpuTests looks for leaks of the same renders, without the layer.
export ASAN_OPTIONS=${ASAN_OPTIONS:+$ASAN_OPTIONS:}detect_leaks=0
VK_LOADER_DEBUG=layer VK_INSTANCE_LAYERS=$layer \
  VK_LAYER_ENABLES="VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT:$between" \
  "$tests" "--gtest_filter=$filter" >"$log" 2>&1 || status=$?
if ! grep -qi "insert instance layer.*$layer" "$log"; then
  echo "SKIPPED: no $layer; install vulkan-validationlayers"
  exit 77
fi
[ "$status" -eq 0 ] || { cat "$log"; exit "$status"; }
if grep -iE -A3 'validation (error|warning|performance)|SYNC-HAZARD|VUID-|UNASSIGNED-' "$log"; then
  exit 1
fi
