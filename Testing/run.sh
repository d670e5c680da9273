#!/usr/bin/env bash
# Installs what Fenestra and its tests need, builds, and passes the tests: all of them in Release,
# the unit tests again under AddressSanitizer and UndefinedBehaviorSanitizer. Says where the time
# went. Where the environment's Slicer_DIR names a build of 3D Slicer, the extension is built and
# tested in it. usage: bash Testing/run.sh
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../Resources/setup.sh"

stages=()
# stage NAME COMMAND...: runs it and remembers its seconds.
stage() {
  local name=$1 start=$SECONDS
  shift
  say "$name"
  "$@" || die "$name failed"
  stages+=("$(printf '%5d s  %s' $((SECONDS - start)) "$name")")
}
run_tests() { (cd "$top" && ctest --preset "$1" -j"$(nproc)"); }

stage "install packages" install_packages "${build_packages[@]}" libgmock-dev libboost-dev \
  qtbase5-dev clang libclang-rt-14-dev lld
stage "build (release)" build release -DFENESTRA_BUILD_TESTS=ON ${Slicer_DIR:+"-DSlicer_DIR=$Slicer_DIR"}
stage "tests (release)" run_tests release
stage "build (ASan, UBSan)" build asan-ubsan
stage "unit tests (ASan, UBSan)" run_tests asan-ubsan

say "Where the time went"
printf '%s\n' "${stages[@]}"
[ -n "${Slicer_DIR:-}" ] ||
  say "SKIPPED: the tests inside 3D Slicer, for Slicer_DIR names no build of it"
