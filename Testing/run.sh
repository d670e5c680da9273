#!/usr/bin/env bash
# Installs the required packages, builds, and runs the tests: in Release all except the unit tests of file
# readers, under AddressSanitizer and UndefinedBehaviorSanitizer all unit tests. Prints the time of each
# stage. If the environment variable Slicer_DIR names a build of 3D Slicer, the extension is built and tested
# in it. usage: bash Testing/run.sh
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../Resources/setup.sh"

run_tests() { (cd "$top" && ctest --preset "$1" -j"$(nproc)"); }

stage "install packages" 60 install_packages "${build_packages[@]}" libgmock-dev libboost-dev \
  qtbase5-dev clang libclang-rt-14-dev lld patchelf busybox-static jq mandoc zsh fish
stage "build (release)" 260 build release -DFENESTRA_BUILD_TESTS=ON -DFENESTRA_TEST_READERS=OFF \
  ${Slicer_DIR:+"-DSlicer_DIR=$Slicer_DIR"}
stage "tests (release)" 240 run_tests release
stage "build (ASan, UBSan)" 240 build asan-ubsan
stage "unit tests (ASan, UBSan)" 80 run_tests asan-ubsan

print_stages
[ -n "${Slicer_DIR:-}" ] ||
  say "SKIPPED: the tests inside 3D Slicer, because Slicer_DIR is not set"
