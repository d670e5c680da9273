# Sourced by filter.sh and look.sh: builds Release with a benchmark program, runs it, and keeps what it
# prints as a page of Report, unless flags ask for a part of it.

set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../../Resources/setup.sh"
folder=${FENESTRA_BUILD:-$top/build}

# page NAME PROGRAM SAYING TITLE ANCHOR flags...: Report/NAME.md of PROGRAM's table.
page() {
  local name=$1 program=$2 saying=$3 title=$4 anchor=$5 knee=$folder/benchmarks/knee
  local file=$top/Testing/Benchmarks/Report/$name.md
  shift 5
  install_packages "${build_packages[@]}"
  (cd "$top" && cmake --preset release -B "$folder" -DFENESTRA_BUILD_TESTS=ON >/dev/null &&
    cmake --build "$folder" --target fenestra "$program") || die "the build failed (see above)"
  [ -e "$knee/knee.mrb" ] || "$folder/bin/fenestra" phantom knee --output "$knee"
  say "$saying"
  "$folder/bin/$program" "$@" | tee "$folder/benchmarks/$name.txt"
  if [ $# -gt 0 ]; then
    say "A part of it: $file stays as it is"
    return
  fi
  {
    printf '# %s\n\nMade by `bash Testing/Benchmarks/%s.sh`; the columns are explained [there](../README.md#%s).\n\n' \
      "$title" "$name" "$anchor"
    cat "$folder/benchmarks/$name.txt"
  } >"$file"
  say "The page is $file"
}
