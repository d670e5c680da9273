#!/bin/sh
# Requests of users, of a program anywhere: files of every library that reads or writes some. Busybox's shell is
# enough. FOLDER/data has the inputs, FOLDER/out gets the results, for a comparison with those of another program.
# Says what failed, and exits 1 then. usage: sh requests.sh FENESTRA FOLDER
set -u
fenestra=$1
data=../data
mkdir "$2/out" && cd "$2/out" || exit 1
failures=0
# asked NAME COMMAND...: runs it, and tells if it fails.
asked() {
  name=$1
  shift
  "$@" >"$name.txt" 2>&1 && return
  echo "$name: exit status $?"
  cat "$name.txt"
  failures=$((failures + 1))
}
quick="--size 24x24 --samples 2 --threads 2"

asked version "$fenestra" --version
asked phantom "$fenestra" phantom knee --size 16x16x16 --output knee
asked transform "$fenestra" render "$data/transformed.mrml" $quick --output transform.png --output transform.exr
asked dicom "$fenestra" render "$data/native" $quick --output dicom.png --output dicom.exr --output dicom.tif
asked jpeg2000 "$fenestra" render "$data/jpeg2000" $quick --output jpeg2000.png
asked archive "$fenestra" render "$data/cube.mrb" $quick --output archive.nrrd
asked turntable "$fenestra" turntable "$data/cube.mrb" $quick --frames 3 --output turn.png
printf 'name,input,view\nfront,%s,\nleft,%s,left\n' "$data/cube.mrb" "$data/cube.mrb" >cases.csv
asked study "$fenestra" study cases.csv $quick --output study
asked compare "$fenestra" compare dicom.tif dicom.tif

# until_done ID: waits until serve has told of its last picture of a change.
until_done() {
  until grep -qE "\"id\":$1,.*\"done\":true" serve.txt; do
    [ ! -e serve.ended ] || return
    sleep 0.1
  done
}
touch serve.txt
{
  until_done null
  echo '{"id":1,"view":"left"}'
  until_done 1
} | { "$fenestra" serve "$data/cube.mrb" $quick --output serve.png; echo $? >serve.ended; } >serve.txt 2>&1
[ "$(cat serve.ended)" = 0 ] || asked serve false

# Ctrl-C after the first samples: the picture so far, exit status 5.
{
  sh -c 'echo $$ >pid && exec "$@"' sh "$fenestra" render "$data/cube.mrb" --size 64x64 --samples 100000 \
    --progress xml --output stopped.png
  echo $? >stopped.ended
} 2>&1 | while read -r line; do
  case $line in
  *'<filter-progress>0.0'*[1-9]*) [ -e stopped.sent ] || { touch stopped.sent && kill -INT "$(cat pid)"; } ;;
  esac
done
[ "$(cat stopped.ended)" = 5 ] && [ -s stopped.png ] || asked stopped false
[ "$failures" = 0 ]
