#!/usr/bin/env bash
# Wraps the module's classes for Python as Slicer does: VTK's wrapper reads the header of every source in the lists of
# Logic and MRML (headers.cmake), its output is compiled, and a script uses the node. Stand-ins in this folder replace
# Slicer's classes. If Debian's VTK packages are not installed, they are unpacked into FOLDER.
# usage: wrap.sh FOLDER. Exit status 77: the wrapper is neither installed nor can be downloaded.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
module=$here/../../../SlicerModule
mkdir -p "$1"
cd "$1"

skip() {
  echo "SKIPPED: $*" >&2
  exit 77
}
[ "$(uname -m)" = x86_64 ] && [ -e /usr/bin/python3.11 ] || skip "needs Debian 12 on x86-64"
root=
if ! [ -x /usr/bin/vtkWrapPython-9.1 ] || ! [ -e /usr/include/vtk-9.1/vtkPythonArgs.h ]; then
  root=$PWD/debian
  packages=(libvtk9-dev libvtk9.1 python3-vtk9 vtk9 libpython3.11-dev)
  if ! [ -e "$root/usr/bin/vtkWrapHierarchy-9.1" ]; then
    command -v apt-get >/dev/null || skip "needs apt-get to download VTK's wrapper"
    apt-get download "${packages[@]}" >apt.log 2>&1 ||
      { apt-get update && apt-get download "${packages[@]}"; } >apt.log 2>&1 ||
      skip "the VTK 9.1 packages cannot be downloaded ($PWD/apt.log)"
    for package in *.deb; do dpkg -x "$package" "$root"; done
    rm ./*.deb
  fi
fi
wrap=$root/usr/bin/vtkWrapPython-9.1
libraries=$root/usr/lib/x86_64-linux-gnu
export LD_LIBRARY_PATH="$libraries${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}"
folders=("$here" "$module/Logic" "$module/MRML" "$module/Scene" "$module/View" "$module/../Renderer")
for export in vtkSlicerFenestraModuleLogicExport vtkSlicerFenestraModuleMRMLExport; do
  name=$(grep -rhoE 'VTK_SLICER_FENESTRA_MODULE_(LOGIC|MRML)_EXPORT' "$module/Logic" "$module/MRML" | sort -u)
  for one in $name; do printf '#ifndef %s\n#define %s\n#endif\n' "$one" "$one"; done >$export.h
done
includes=(-I. "${folders[@]/#/-I}" "-I$root/usr/include/vtk-9.1")

wrapped=$(cmake -D "MODULE=$module" -P "$here/headers.cmake")
headers=("$here"/vtk*.h)
while read -r header; do headers+=("$header"); done <<<"$wrapped"
printf '%s;FenestraPython\n' "${headers[@]}" >headers.txt
"$root/usr/bin/vtkWrapHierarchy-9.1" "${includes[@]}" -o ours.txt headers.txt
cp ours.txt FenestraPython-hierarchy.txt
types=(--types FenestraPython-hierarchy.txt)
for vtk_module in vtkCommonCore vtkCommonDataModel vtkCommonExecutionModel; do
  types+=(--types "$libraries/vtk/hierarchy/VTK/$vtk_module-hierarchy.txt")
done

compile=(g++ -std=c++17 -fPIC -O0 "${includes[@]}" "-I$root/usr/include/python3.11" -I/usr/include/python3.11)
objects=()
for header in "${headers[@]}"; do
  name=$(basename "$header" .h)
  "$wrap" "${includes[@]}" "${types[@]}" -o "${name}Python.cxx" "$header"
  "${compile[@]}" -c "${name}Python.cxx" -o "$name.o"
  case $name in vtkMRML*) objects+=("$name.o") ;; esac
done
echo "wrapped and compiled: ${#headers[@]} headers"

# Links the nodes into a Python module.
printf '%s\n' FenestraPython vtkMRMLNode vtkMRMLFenestraOpeningNode vtkMRMLFenestraRenderNode \
  vtkMRMLVectorVolumeDisplayNode vtkMRMLFenestraPictureDisplayNode >init.txt
"$root/usr/bin/vtkWrapPythonInit-9.1" init.txt FenestraPythonInit.cxx FenestraPythonInitImpl.cxx
for source in FenestraPythonInit.cxx FenestraPythonInitImpl.cxx "$module"/MRML/*.cxx "$module"/Scene/FenestraFlags.cxx \
  "$module"/../Renderer/clip/portable/SurfaceDepth.cxx; do
  "${compile[@]}" -c "$source" -o "$(basename "$source" .cxx)Source.o"
  objects+=("$(basename "$source" .cxx)Source.o")
done
g++ -shared "${objects[@]}" -o FenestraPython.so "-L$libraries" -lvtkCommonCore-9.1 \
  -lvtkCommonDataModel-9.1 -lvtkCommonExecutionModel-9.1 -lvtkImagingCore-9.1 -lvtkImagingColor-9.1 \
  -lvtkWrappingPythonCore3.11-9.1 "-Wl,-rpath-link,$libraries"
PYTHONPATH=.:$root/usr/lib/python3/dist-packages /usr/bin/python3.11 "$here/node.py" $wrapped
