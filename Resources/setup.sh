# Sourced by demo.sh and the scripts in Testing. Functions that install the required Debian packages and build.
# Sets `top`, the project's folder. Functions print the reason and exit if something is missing.

top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

say() { printf '\n== %s\n' "$*"; }
die() {
  printf 'fenestra: %s\n' "$*" >&2
  exit 1
}

stages=()
# stage NAME BUDGET COMMAND...: runs a command and records its time and budget, seconds on two idle cores.
stage() {
  local name=$1 budget=$2 start=$SECONDS took late=
  shift 2
  say "$name"
  "$@" || die "$name failed"
  took=$((SECONDS - start))
  [ $((2 * took)) -le $((3 * budget)) ] || late="  <== TOO LONG: over 1.5 times its budget"
  stages+=("$(printf '%5d s of %4d s  %s%s' "$took" "$budget" "$name" "$late")")
}
print_stages() {
  say "Time by stage"
  printf '%s\n' "${stages[@]}"
}

# install_packages PACKAGE...: installs the missing ones, as root or with sudo.
install_packages() {
  command -v dpkg-query >/dev/null || die "dpkg: not found; this script needs Debian or a derivative"
  local package missing=()
  for package in "$@"; do
    [ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null)" = installed ] ||
      missing+=("$package")
  done
  [ ${#missing[@]} -eq 0 ] && return
  say "Installing ${missing[*]}"
  local root=()
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || die "sudo: not found; install as root: ${missing[*]}"
    root=(sudo)
  fi
  local log
  log=$(mktemp)
  { "${root[@]}" apt-get update &&
    "${root[@]}" env DEBIAN_FRONTEND=noninteractive \
      apt-get install -y --no-install-recommends "${missing[@]}"; } >"$log" 2>&1 ||
    { tail -n 15 "$log" >&2; die "apt-get: cannot install ${missing[*]} (log: $log)"; }
  rm -f "$log"
}

build_packages=(
  g++ cmake ninja-build pkg-config
  libinsighttoolkit5-dev libeigen3-dev libhwy-dev libopenexr-dev libopencolorio-dev libtbb-dev
  nlohmann-json3-dev libpugixml-dev libzip-dev libgtest-dev libpng-dev libtiff-dev
  libfreetype-dev fonts-dejavu-core zlib1g-dev glslc spirv-tools libvulkan-dev libvulkan-volk-dev)

# build PRESET [cmake arguments]: configures and builds in the preset's folder.
build() {
  local preset=$1
  shift
  (cd "$top" && cmake --preset "$preset" "$@" >/dev/null && cmake --build --preset "$preset") ||
    die "the $preset build failed (see above)"
}
