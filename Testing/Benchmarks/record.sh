# Sourced by denoiser.sh and appearance.sh: builds Release with a benchmark program, runs it, and stores its
# CSV output in Report, unless options select a part of the scenes.

set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../../Resources/setup.sh"
folder=${FENESTRA_BUILD:-$top/build}

# record NAME PROGRAM MESSAGE option...: writes the output of PROGRAM to Report/NAME.csv.
record() {
  local name=$1 program=$2 message=$3 knee=$folder/benchmarks/knee
  local file=$top/Testing/Benchmarks/Report/$name.csv
  shift 3
  install_packages "${build_packages[@]}"
  (cd "$top" && cmake --preset release -B "$folder" -DFENESTRA_BUILD_TESTS=ON >/dev/null &&
    cmake --build "$folder" --target fenestra "$program") || die "the build failed (see above)"
  [ -e "$knee/knee.mrb" ] || "$folder/bin/fenestra" phantom knee --output "$knee"
  say "$message"
  "$folder/bin/$program" "$@" | tee "$folder/benchmarks/$name.csv"
  if [ $# -gt 0 ]; then
    say "Partial run: $file is unchanged"
    return
  fi
  cp "$folder/benchmarks/$name.csv" "$file"
  say "Wrote $file"
}
