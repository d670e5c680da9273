# Sourced by the scripts of figures: where the renderer, subjects and pictures are, and how a picture is
# made. Pictures and numbers go into build/figures; what a script shows goes into Resources/figures.
# Environment: FENESTRA_DATA, a folder of real volumes (left out where there is none); SIZE and SAMPLES
# for rougher or finer pictures.

set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../setup.sh"
install_packages imagemagick fonts-dejavu-core jq gnuplot-nox bc
fenestra=${FENESTRA:-$top/build/bin/fenestra}
[ -x "$fenestra" ] || die "$fenestra is not there; build first: bash Resources/demo.sh, or FENESTRA=FILE"
shown=$top/Resources/figures
out=$top/build/figures
data=${FENESTRA_DATA:-$top/../shared/data}
size=${SIZE:-384}
samples=${SAMPLES:-96}
mkdir -p "$out"

# phantom KIND [FOLDER [flags]]: makes a subject, once.
phantom() {
  local kind=$1 folder=$out/${2:-$1}
  [ -s "$folder/$kind.nrrd" ] || "$fenestra" phantom "$kind" --output "$folder" "${@:3}" >/dev/null
}

# render NAME arguments...: $out/NAME.png and NAME.json, unless they are there from the same arguments
# and executable.
render() {
  local name=$1
  shift
  local line="$* $size $samples $(stat -c %Y "$fenestra")"
  if [ "$(cat "$out/$name.arguments" 2>/dev/null)" != "$line" ]; then
    say "Rendering: $name"
    "$fenestra" "$@" --size "${size}x$size" --samples "$samples" --progress none \
      --output "$out/$name.png" --stats "$out/$name.json" >/dev/null
    printf '%s' "$line" >"$out/$name.arguments"
  fi
}

# number NAME KEY [FORMAT]: of its stats; a dash where it has none.
number() {
  local value
  value=$(jq -r "$2 // empty" "$out/$1.json")
  [ -n "$value" ] && printf "${3:-%.2f}" "$value" || printf -- '-'
}

# row FILE.jpg NAME CAPTION ...: pictures side by side.
row() {
  local file=$1 labels=()
  shift
  while [ $# -gt 0 ]; do
    labels+=(-label "$2" "$out/$1.png")
    shift 2
  done
  montage -font DejaVu-Sans -pointsize 15 -background '#181818' -fill white -tile x1 -geometry +5+5 \
    "${labels[@]}" -quality 88 "$shown/$file"
}
