# Sourced by the scripts in this folder: paths, and functions that render images and write README.md.
# Renders and stats go to build/figures; images and numbers of the page go to Resources/figures.
# Environment: FENESTRA_DATA, a folder of real volumes (figures without their data are skipped); SIZE and
# SAMPLES of the renders; FENESTRA, another program.

set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../setup.sh"
install_packages imagemagick fonts-dejavu-core jq gnuplot-nox bc
fenestra=${FENESTRA:-$top/build/bin/fenestra}
[ -x "$fenestra" ] || die "$fenestra: not found; build it with bash Resources/demo.sh, or set FENESTRA=FILE"
figures=$top/Resources/figures
out=$top/build/figures
data=${FENESTRA_DATA:-$top/../shared/data}
size=${SIZE:-384}
samples=${SAMPLES:-32}
mkdir -p "$out"
torso=$data/torso_ct_ccth_a01
aorta=$data/aorta_dissection_totalseg
aorta_view=(--position=375,-233,742 --target=-15,147,664)

# make_phantom KIND [FOLDER [options]]: writes a phantom unless it exists.
make_phantom() {
  local kind=$1 folder=$out/${2:-$1}
  [ -s "$folder/$kind.nrrd" ] || "$fenestra" phantom "$kind" --output "$folder" --quiet "${@:3}"
}

# render NAME arguments...: writes $out/NAME.png and NAME.json unless they exist from the same arguments
# and program.
render() {
  local name=$1
  shift
  local line="$* $size $samples $(stat -c %Y "$fenestra")"
  if [ "$(cat "$out/$name.arguments" 2>/dev/null)" != "$line" ]; then
    say "Rendering: $name"
    "$fenestra" "$@" --size "${size}x$size" --samples "$samples" --quiet \
      --output "$out/$name.png" --stats-json "$out/$name.json"
    printf '%s' "$line" >"$out/$name.arguments"
  fi
}

# get NAME KEY [FORMAT]: prints a value of the stats of NAME; a dash if it is null or missing.
get() {
  local value
  value=$(jq -r "$2 // empty" "$out/$1.json")
  [ -n "$value" ] && printf "${3:-%.2f}" "$value" || printf -- '-'
}

# join_images FILE.jpg NAME CAPTION ...: puts images side by side, more than six in two rows.
join_images() {
  local file=$1 labels=() rows=$(($# > 13 ? 2 : 1))
  shift
  while [ $# -gt 0 ]; do
    labels+=(-label "$2" "$out/$1.png")
    shift 2
  done
  montage -font DejaVu-Sans -pointsize 15 -background '#181818' -fill white -tile "x$rows" -geometry +5+5 \
    "${labels[@]}" -quality 86 "$figures/$file"
}

# write_icon FILE NAME: makes an icon of Slicer's panel from an image. 64 colors keep it below 8 kB. The module's
# .qrc must list a new icon.
write_icon() {
  convert "$1" -resize 96x96 -strip +dither -colors 64 "PNG8:$top/SlicerModule/Resources/Icons/$2.png"
}

# write_section NAME: replaces the lines between <!-- NAME --> and <!-- end of NAME --> of README.md by
# $out/NAME.md.
write_section() {
  local page=$figures/README.md begin="<!-- $1 -->" end="<!-- end of $1 -->"
  grep -qx -e "$begin" "$page" && grep -qx -e "$end" "$page" || die "$page: has no section \"$1\""
  awk -v begin="$begin" -v end="$end" -v section="$out/$1.md" '
    $0 == end { inside = 0 }
    !inside
    $0 == begin { inside = 1; while ((getline line < section) > 0) print line }' "$page" >"$page.tmp"
  mv "$page.tmp" "$page"
  say "Done: section \"$1\" of $page"
}
