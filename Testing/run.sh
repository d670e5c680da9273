#!/usr/bin/env bash
# Installs what Fenestra and its tests need, builds, and passes the tests: all of them in Release,
# the unit tests again under AddressSanitizer and UndefinedBehaviorSanitizer, those of readers there alone.
# Says where the time went. Where the environment's Slicer_DIR names a build of 3D Slicer, the extension is built and
# tested in it. usage: bash Testing/run.sh
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
  say "SKIPPED: the tests inside 3D Slicer, for Slicer_DIR names no build of it"
