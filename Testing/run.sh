#!/usr/bin/env bash
# Installs the required packages, builds in Release, and runs the tests with a quarter of the matrix, without the unit
# tests of file readers and the long tests (faults, packages, MPI, boundaries), which --sanitizers adds. Prints the
# time of each stage and the slowest tests.
# If the environment variable Slicer_DIR names a build of 3D Slicer, the extension is built and tested in it.
# usage: bash Testing/run.sh [--sanitizers]
#   --sanitizers  also the long tests, and all unit tests under AddressSanitizer and UndefinedBehaviorSanitizer
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../Resources/setup.sh"
sanitizers=
case "$*" in
  '') ;;
  --sanitizers) sanitizers=ON ;;
  *) die "usage: bash Testing/run.sh [--sanitizers]" ;;
esac

# run_tests PRESET: runs the tests, and prints the slowest ones.
run_tests() {
  local results status=0
  results=$(mktemp)
  (cd "$top" && FENESTRA_COMBINATIONS=${FENESTRA_COMBINATIONS:-60} \
    ctest --preset "$1" -j"$(nproc)" --output-junit "$results") || status=$?
  say "Slowest tests, in seconds"
  sed -nE 's/.*<testcase name="([^"]*)".* time="([0-9.]+)".*/\2 \1/p' "$results" | sort -rn |
    awk 'NR <= 10 { printf "%7.1f  %s\n", $1, $2 }'
  rm -f "$results"
  return $status
}

stage "install packages" 60 install_packages "${build_packages[@]}" libgmock-dev libboost-dev \
  qtbase5-dev pybind11-dev python3-dev python3-pytest python3-nibabel python3-pip python3-wheel jupyter-nbconvert \
  python3-ipykernel ${sanitizers:+clang libclang-rt-14-dev} lld patchelf busybox-static jq mandoc zsh fish \
  mesa-vulkan-drivers vulkan-validationlayers
stage "build (release)" 230 build release -DFENESTRA_BUILD_TESTS=ON -DFENESTRA_TEST_READERS=OFF \
  -DFENESTRA_LONG_TESTS="${sanitizers:-OFF}" \
  ${Slicer_DIR:+"-DSlicer_DIR=$Slicer_DIR"}
stage "tests (release)" 190 run_tests release
if [ "$sanitizers" ]; then
  stage "build (ASan, UBSan)" 220 build asan-ubsan
  stage "unit tests (ASan, UBSan)" 70 run_tests asan-ubsan
fi

print_stages
[ -n "${Slicer_DIR:-}" ] ||
  say "SKIPPED: the tests inside 3D Slicer, because Slicer_DIR is not set"
