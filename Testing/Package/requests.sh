#!/bin/sh
# Runs user requests with a program installed anywhere; they use every library that reads or writes files. Runs in
# Busybox's shell. Reads FOLDER/data and writes FOLDER/out, to be compared with the results of another program.
# Reports failures and then exits with 1. usage: sh requests.sh FENESTRA FOLDER
set -u
fenestra=$1
data=../data
mkdir "$2/out" && cd "$2/out" || exit 1
failures=0
# run NAME COMMAND...: runs the command and reports a failure.
run() {
  name=$1
  shift
  "$@" >"$name.txt" 2>&1 && return
  echo "$name: exit status $?"
  cat "$name.txt"
  failures=$((failures + 1))
}
quick="--size 24x24 --samples 2 --threads 2"

run version "$fenestra" --version
run phantom "$fenestra" phantom knee --size 16x16x16 --output knee
run transform "$fenestra" render "$data/transformed.mrml" $quick --output transform.png --output transform.exr
run dicom "$fenestra" render "$data/native" $quick --output dicom.png --output dicom.exr --output dicom.tif
run jpeg2000 "$fenestra" render "$data/jpeg2000" $quick --output jpeg2000.png
run archive "$fenestra" render "$data/cube.mrb" $quick --output archive.nrrd
run turntable "$fenestra" turntable "$data/cube.mrb" $quick --frames 3 --output turn.png
printf 'name,input,view\nfront,%s,\nleft,%s,left\n' "$data/cube.mrb" "$data/cube.mrb" >cases.csv
run batch "$fenestra" batch cases.csv $quick --output batch
run compare "$fenestra" compare dicom.tif dicom.tif

# until_done ID: waits until serve has published its last image of a change.
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
[ "$(cat serve.ended)" = 0 ] || run serve false

# Ctrl-C after the first samples must write the image so far and exit with status 5.
{
  sh -c 'echo $$ >pid && exec "$@"' sh "$fenestra" render "$data/cube.mrb" --size 64x64 --samples 100000 \
    --progress xml --output stopped.png
  echo $? >stopped.ended
} 2>&1 | while read -r line; do
  case $line in
  *'<filter-progress>0.0'*[1-9]*) [ -e stopped.sent ] || { touch stopped.sent && kill -INT "$(cat pid)"; } ;;
  esac
done
[ "$(cat stopped.ended)" = 5 ] && [ -s stopped.png ] || run stopped false
[ "$failures" = 0 ]
