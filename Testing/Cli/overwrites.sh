#!/usr/bin/env bash
# Each case names an input file or a foreign file (of another program) as an output, in a new folder with
# copies of the test data. The command must fail before it renders: one error line, exit status 2, 3 or 4,
# nothing on standard output, no new file (`event` cases: an error event of serve). All existing files and
# links must be unchanged. Prints one table row per failed case; exit status 1 if there is one.
# usage: overwrites.sh FENESTRA [CASE...]
set -uo pipefail
export LC_ALL=C
program=$(realpath "$1")
data=$(realpath "$(dirname "${BASH_SOURCE[0]}")/../Data")
corpus=$data/../Fuzz/Corpus
sandbox=$data/../Fuzz/Sandbox
shift
work=$(mktemp -d -p "$([ -w /dev/shm ] && echo /dev/shm || echo "${TMPDIR:-/tmp}")" overwrites-XXXXXX)
trap 'rm -rf "$work"' EXIT

# Commands of the table below. `serve` reads its changes from standard input.
quick=(--size 8x8 --samples 1)
render() { "$program" render "$@" "${quick[@]}" --progress xml; }
turn() { "$program" turntable "$@" "${quick[@]}" --frames 4 --progress xml; }
serve() { "$program" serve "$@" "${quick[@]}"; }
compare() { "$program" compare "$@"; }
phantom() { "$program" phantom "$@" --size 16; }
# scene FROM TO: writes s.mrml, the scene with FROM replaced by TO.
scene() { sed "s#$1#$2#" scene.mrml >s.mrml; }
# unused FILE [ATTRIBUTES]: writes s.mrml, the scene with an additional volume that is not rendered.
unused() {
  sed "s#</MRML>#<VolumeArchetypeStorage id=\"us\" fileName=\"$1\" ${2-}/><Volume id=\"u\" name=\"u\" references=\"storage:us;\"/>&#" scene.mrml >s.mrml
}
# shifted FILE: writes s.mrml, the scene with its inner transform in FILE.
shifted() {
  sed -e 's#\(name="Inner" references="\)\([^"]*\)" matrix[^>]*>#\1storage:ts;\2">#' \
    -e "s#</MRML>#<TransformStorage id=\"ts\" fileName=\"$1\"/></MRML>#" scene.mrml >s.mrml
}
# wait_for_output EXPRESSION: waits until the output of serve matches, or serve has ended.
wait_for_output() {
  while [ -e ../out ] && [ ! -e ../after ] && ! grep -qE "$1" ../out; do
    sleep 0.1
  done 2>/dev/null
}
# send_change CHANGE: sends it to serve after the first image, and waits for the event that results.
send_change() {
  wait_for_output '"id":null,.*"done":true'
  echo "{\"id\":1,$1}"
  wait_for_output '"id":1,.*("done":true|"message")'
}
write_foreign() { printf 'data of another program\n' >"$1"; }
slicer=home/share/Slicer-5.6/qt-loadable-modules/VolumeRendering
look='name="Mine" scalarOpacity="4 0 0 200 1" gradientOpacity="4 0 1 255 1" colorTransfer="4 0 1 1 1" shade="0"'

# Fills the folder of a case.
fill() {
  cp "$data"/traps/{scene.mrml,plain.nrrd,layers.seg.nrrd,labels.nrrd,property.vp,roi.mrk.json} \
    "$data"/traps/{detached.nhdr,detached.raw,lights.json,thin.json} "$data/cube/cube.mrb" .
  cp "$data/baselines/plain.exr" sky.exr
  cp sky.exr other.exr
  mkdir d
  cp "$sandbox/Dicom/native.dcm" d/a.dcm
}

# CASE | EXPECTED | PREPARATION | COMMAND
cases() {
  cat <<'END'
volume of a scene                    | refused |  | render scene.mrml --output plain.nrrd
volume of a scene, return values     | refused |  | render scene.mrml --output o.png --returnparameterfile plain.nrrd
volume of a scene, stats             | refused |  | render scene.mrml --output o.png --stats-json plain.nrrd
volume of a scene, from elsewhere    | refused | mkdir e | cd e && render ../scene.mrml --output ../plain.nrrd
volume of a scene, absolute          | refused |  | render scene.mrml --output "$PWD/plain.nrrd"
volume of a scene, through /proc     | refused |  | render scene.mrml --output /proc/self/cwd/plain.nrrd
volume of a scene, hard link         | refused | ln plain.nrrd hard.nrrd | render scene.mrml --output hard.nrrd
volume of a scene, link to it        | refused | ln -s plain.nrrd soft.nrrd | render scene.mrml --output soft.nrrd
volume of a scene, folder's link     | refused | ln -s . again | render scene.mrml --output again/plain.nrrd
volume of a scene that is a link     | refused | mkdir r; mv plain.nrrd r; ln -s r/plain.nrrd . | render scene.mrml --output r/plain.nrrd
volume of a scene, the link itself   | refused | mkdir r; mv plain.nrrd r; ln -s r/plain.nrrd . | render scene.mrml --output plain.nrrd
volume of a scene, escaped           | refused | mv plain.nrrd p%n.nrrd; scene plain.nrrd p%25n.nrrd | render s.mrml --output p%n.nrrd
segmentation of a scene              | refused |  | render scene.mrml --focus Heart --output layers.seg.nrrd
segmentation of a scene, no focus    | refused |  | render scene.mrml --output layers.seg.nrrd
property of a scene                  | refused |  | render scene.mrml --output o.png --stats-json property.vp
box of a scene                       | refused |  | render scene.mrml --output o.png --stats-json roi.mrk.json
transform of a scene                 | refused | cp "$sandbox/Transform/affine.tfm" t.tfm; shifted t.tfm | render s.mrml --output o.png --stats-json t.tfm
piece of a closed surface            | refused | cp "$corpus/Surface/box.vtm" b.vtm; sed 1s/^.// -i b.vtm; sed 1s/^.// "$corpus/Surface/box.vtp" >s.vtp | render plain.nrrd --segmentation b.vtm --focus 1 --output o.png --surface s.vtp
piece of an unused closed surface    | refused | mkdir b; cp "$corpus/Surface/box.vtm" b.vtm; sed -e 1s/^.// -e s#s.vtp#b/s.vtp# -i b.vtm; sed 1s/^.// "$corpus/Surface/box.vtp" >b/s.vtp; scene layers.seg.nrrd b.vtm | render s.mrml --output o.png --stats-json b/s.vtp
unused volume of a scene             | refused | write_foreign u.nrrd; unused u.nrrd | render s.mrml --output u.nrrd
unused volume, samples of a header   | refused | unused detached.nhdr | render s.mrml --output o.png --stats-json detached.raw
unused volume, samples of a .nrrd    | refused | mv detached.nhdr a.nrrd; unused a.nrrd | render s.mrml --output o.png --stats-json detached.raw
unused volume, a header's list       | refused | write_foreign b.raw; printf 'NRRD0004\ndata file: LIST\na.raw\nb.raw\n' >u.nhdr; unused u.nhdr | render s.mrml --output o.png --stats-json b.raw
unused volume, a header's series     | refused | write_foreign b07.raw; printf 'NRRD0004\ndata file: b%%02d.raw 1 9 1\n\n' >u.nhdr; unused u.nhdr | render s.mrml --output o.png --stats-json b07.raw
unused volume, samples of a .mhd     | refused | write_foreign b.raw; printf 'ObjectType = Image\nElementDataFile = b.raw\n' >u.mhd; unused u.mhd | render s.mrml --output o.png --stats-json b.raw
unused volume, second file of a pair | refused | write_foreign u.img; write_foreign u.hdr; unused u.hdr | render s.mrml --output o.png --stats-json u.img
unused volume, a slice of its list   | refused | write_foreign a.dcm; write_foreign b.dcm; unused a.dcm 'fileListMember0="a.dcm" fileListMember1="b.dcm"' | render s.mrml --output o.png --stats-json b.dcm
file of a scene view                 | refused | write_foreign v.nrrd; sed 's#</MRML>#<SceneView id="v"><VolumeArchetypeStorage id="vs" fileName="v.nrrd"/></SceneView>&#' scene.mrml >s.mrml | render s.mrml --output o.png --stats-json v.nrrd
samples of a header                  | refused |  | render detached.nhdr --output o.png --stats-json detached.raw
samples of a header, a .nrrd         | refused | mv detached.raw data.nrrd; sed -i s/detached.raw/data.nrrd/ detached.nhdr | render detached.nhdr --output data.nrrd
samples of a scene's header          | refused | scene plain.nrrd detached.nhdr | render s.mrml --output o.png --stats-json detached.raw
samples of a MetaImage header        | refused | mv detached.raw raw.nrrd; printf 'ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\nDimSize = 25 25 25\nElementSpacing = 1 1 1\nElementType = MET_SHORT\nElementDataFile = raw.nrrd\n' >m.mhd | render m.mhd --output raw.nrrd
slice of a DICOM folder, stats       | refused |  | render d --output o.png --stats-json d/a.dcm
slice of a DICOM folder, values      | refused |  | render d --output o.png --returnparameterfile d/a.dcm
slice of a DICOM folder with a slash | refused |  | render d/ --output o.png --stats-json d/a.dcm
slice with extension .nrrd           | refused | mv d/a.dcm d/a.nrrd | render d --output d/a.nrrd
slice of another series              | refused | sed 's/1[.]2[.]3/1.2.4/g' d/a.dcm >d/b.dcm | render d --volume 1.2.3 --output o.png --stats-json d/b.dcm
file of a DICOM folder, no slice     | refused | write_foreign d/notes.json | render d --output o.png --stats-json d/notes.json
depth of an image = volume           | refused | mv plain.nrrd a-Z.nrrd; scene plain.nrrd a-Z.nrrd | render s.mrml --output a.nrrd
depth of an image = INPUT            | refused | mv plain.nrrd a-Z.nrrd | render a-Z.nrrd --output a.nrrd
depth of an image, foreign           | refused | write_foreign a-Z.nrrd | render plain.nrrd --output a.nrrd
depth of an image, label map         | refused | cp labels.nrrd a-Z.nrrd | render plain.nrrd --output a.nrrd
default output, foreign              | refused | write_foreign plain.png | render plain.nrrd
default output, image without tag    | refused | cp "$corpus/Image/picture.png" plain.png; sed -i 1s/^.// plain.png | render plain.nrrd
map of --lights                      | refused | echo '{"lights":[{"type":"environment","file":"sky.exr"}]}' >l.json | render plain.nrrd --lights l.json --output sky.exr
map of --environment                 | refused |  | render plain.nrrd --environment sky.exr --output sky.exr
file of --lights                     | refused |  | render plain.nrrd --lights lights.json --output o.png --stats-json lights.json
file of --transfer                   | refused |  | render plain.nrrd --transfer thin.json --output o.png --stats-json thin.json
file of --preset                     | refused | echo '{"title": "t", "modality": "CT", "focus": {"codes": ["a^b"]}, "flags": {}}' >p.json | render plain.nrrd --preset p.json --output o.png --stats-json p.json
file of --segmentation               | refused |  | render plain.nrrd --segmentation labels.nrrd --focus 1 --output labels.nrrd
presets of an installed Slicer       | refused | mkdir -p "$slicer"; echo "<MRML><VolumeProperty $look/></MRML>" >"$slicer/presets.xml"; export SLICER_HOME=$PWD/home | render plain.nrrd --transfer Mine --output o.png --stats-json "$slicer/presets.xml"
INPUT                                | refused |  | render plain.nrrd --output plain.nrrd
INPUT, relative                      | refused | mkdir -p x | render plain.nrrd --output ./x/../plain.nrrd
INPUT, hard link                     | refused | ln plain.nrrd hard.nrrd | render plain.nrrd --output hard.nrrd
INPUT, link to it                    | refused | ln -s plain.nrrd soft.nrrd | render plain.nrrd --output soft.nrrd
INPUT that is a link                 | refused | ln -s plain.nrrd soft.nrrd | render soft.nrrd --output plain.nrrd
INPUT, link to a link                | refused | ln -s b a.nrrd; ln -s plain.nrrd b | render plain.nrrd --output a.nrrd
INPUT, a scene                       | refused |  | render scene.mrml --output o.png --stats-json scene.mrml
INPUT, an archive                    | refused |  | render cube.mrb --output o.png --stats-json cube.mrb
INPUT, an archive's hard link        | refused | ln cube.mrb c.json | render cube.mrb --output o.png --stats-json c.json
INPUT, a header                      | refused |  | render detached.nhdr --output o.png --stats-json detached.nhdr
two outputs, one name                | refused | write_foreign o.png | render plain.nrrd --output o.png --output ./o.png
two outputs, one file                | refused | write_foreign o.png; ln o.png p.png | render plain.nrrd --output o.png --output p.png
two outputs, folder's links          | refused | ln -s . a; ln -s . b | render plain.nrrd --output a/o.png --output b/o.png
two outputs, one a link              | refused | ln -s o.png p.png | render plain.nrrd --output o.png --output p.png
stats = output                       | refused | write_foreign o.png | render plain.nrrd --output o.png --stats-json o.png
stats = depth of an image            | refused |  | render plain.nrrd --output o.nrrd --stats-json o-Z.nrrd
output = depth of an image           | refused |  | render plain.nrrd --output o.nrrd --output o-Z.nrrd
stats = values                       | refused |  | render plain.nrrd --output o.png --stats-json s.json --returnparameterfile s.json
compare: A                           | refused |  | compare sky.exr other.exr --output sky.exr
compare: B                           | refused |  | compare sky.exr other.exr --output other.exr
compare: hard link of B              | refused | ln other.exr h.exr | compare sky.exr other.exr --output h.exr
compare: error of A                  | refused | cp sky.exr e.exr | compare sky.exr other.exr --error-a e.exr --error-b sky.exr --output e.exr
compare: error of B                  | refused | cp sky.exr e.exr | compare sky.exr other.exr --error-a sky.exr --error-b e.exr --output e.exr
turntable: frame = volume            | refused | mv plain.nrrd turn_0003.nrrd; scene plain.nrrd turn_0003.nrrd | turn s.mrml --output turn.nrrd
turntable: frame = volume, restart   | refused | mv plain.nrrd turn_0003.nrrd; scene plain.nrrd turn_0003.nrrd | turn s.mrml --output turn.nrrd --restart
default output of the folder .       | refused | write_foreign d/d.png | cd d && render .
turntable: frame = INPUT, restart    | refused | mv plain.nrrd turn_0003.nrrd | turn turn_0003.nrrd --output turn.nrrd --restart
turntable: frame's depth = volume    | refused | mv plain.nrrd turn_0001-Z.nrrd; scene plain.nrrd turn_0001-Z.nrrd | turn s.mrml --output turn.nrrd --restart
turntable: frame's depth, foreign    | refused | write_foreign turn_0001-Z.nrrd | turn plain.nrrd --output turn.nrrd --restart
turntable: stats = volume            | refused |  | turn scene.mrml --output turn.png --stats-json plain.nrrd
turntable: manifest = scene file     | refused | mv roi.mrk.json turn.turntable.json; scene roi.mrk.json turn.turntable.json | turn s.mrml --output turn.png --restart
turntable: manifest, foreign         | refused | write_foreign turn.turntable.json | turn plain.nrrd --output turn.png --restart
turntable: manifest, foreign JSON    | refused | cp lights.json turn.turntable.json | turn plain.nrrd --output turn.png --restart
turntable: manifest = stats          | refused |  | turn plain.nrrd --output turn.png --stats-json turn.turntable.json
serve: volume of a scene             | refused |  | serve scene.mrml --output plain.nrrd < <(send_change '"seed":1')
serve: hard link of a volume         | refused | ln plain.nrrd hard.nrrd | serve scene.mrml --output hard.nrrd < <(send_change '"seed":1')
serve: output that a change reads    | event   |  | serve plain.nrrd --output new.exr < <(send_change '"environment":"new.exr"')
serve: output that its lights read   | event   | echo '{"lights":[{"type":"environment","file":"new.exr"}]}' >l.json | serve plain.nrrd --output new.exr < <(send_change '"lights":"l.json"')
serve: map that a change writes      | event   |  | serve plain.nrrd --environment sky.exr --output o.exr < <(send_change '"output":["sky.exr"]')
phantom: foreign volume              | refused | cp plain.nrrd cube.nrrd; rm cube.mrb | phantom cube --output .
phantom: foreign segmentation        | refused | cp labels.nrrd cube.seg.nrrd; rm cube.mrb | phantom cube --output .
phantom: foreign scene               | refused | cp scene.mrml cube.mrml; rm cube.mrb | phantom cube --output .
phantom: foreign archive             | refused | write_foreign cube.mrb | phantom cube --output .
phantom: foreign property            | refused | cp property.vp cube.vp; rm cube.mrb | phantom cube --output .
phantom: foreign box                 | refused | cp roi.mrk.json cube-roi.mrk.json; rm cube.mrb | phantom cube --output .
phantom: link to a foreign file      | refused | ln -s plain.nrrd cube.nrrd; rm cube.mrb | phantom cube --output .
phantom: through a folder's link     | refused | mkdir p; write_foreign p/cube.vp.json; ln -s p q | phantom cube --output q
END
}

# state: name, type, link target and digest of everything in the folder.
state() {
  find . ! -name . -printf '%P|%y|%l|' \( -type f -exec sha256sum {} \; -o -printf '\n' \) | sort
}

# find_errors EXPECTED STATUS: prints the violations of a run, nothing if there are none.
find_errors() {
  local lost more
  lost=$(comm -23 ../before ../after | cut -d'|' -f1 | paste -sd' ')
  more=$(comm -13 <(cut -d'|' -f1 ../before | sort) <(cut -d'|' -f1 ../after | sort) | paste -sd' ')
  [ -z "$lost" ] || printf 'changed or removed: %s; ' "$lost"
  if [ "$1" = event ]; then
    grep -q '"event":"error"' ../out || printf 'no error event; '
    return
  fi
  [ -z "$more" ] || printf 'new files: %s; ' "$more"
  [[ $2 == [234] ]] || printf 'status %s; ' "$2"
  [ ! -s ../out ] || printf 'rendered; '
  [ "$(grep -vc '^fenestra: warning' ../err)" = 1 ] || printf 'not one line; '
}

trim() { sed 's/^ *//; s/ *$//' <<<"$1"; }

count=0 failed=0
while IFS='|' read -r name expected prepare command; do
  name=$(trim "$name")
  [ $# -eq 0 ] || [[ " $* " == *" $name "* ]] || continue
  rm -rf "${work:?}"/*
  mkdir "$work/folder"
  count=$((count + 1))
  wrong=$(
    cd "$work/folder" && fill && eval "$prepare" || printf 'preparation failed; '
    state >../before
    eval "$command" >../out 2>../err
    status=$?
    cd "$work/folder" && state >../after
    find_errors "$(trim "$expected")" "$status"
  )
  [ -z "$wrong" ] && continue
  [ $failed -gt 0 ] || printf '| case | command | violation | error |\n|---|---|---|---|\n'
  failed=$((failed + 1))
  printf '| %s | `%s` | %s | %s |\n' "$name" "$(trim "$command")" "${wrong%; }" "$(head -1 "$work/err")"
done < <(cases)
echo "$((count - failed)) of $count cases pass"
[ $count -gt 0 ] && [ $failed -eq 0 ]
