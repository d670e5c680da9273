# Writes FILE, which defines fenestra::core::readerBuild (io/ReaderProgram.h): VERSION, and a digest of the sources in
# the folders FOLDERS of RENDERER, separated by "|".
# usage: cmake -DVERSION=VERSION -DRENDERER=FOLDER -DFOLDERS=A|B -DFILE=FILE -P ReaderBuild.cmake
string(REPLACE "|" ";" folders "${FOLDERS}")
set(digests)
foreach(folder IN LISTS folders)
  file(GLOB_RECURSE sources RELATIVE "${RENDERER}" "${RENDERER}/${folder}/*.h" "${RENDERER}/${folder}/*.cxx")
  foreach(source IN LISTS sources)
    file(SHA256 "${RENDERER}/${source}" digest)
    string(APPEND digests "${source} ${digest}\n")
  endforeach()
endforeach()
string(SHA256 digest "${digests}")
string(SUBSTRING "${digest}" 0 16 digest)
file(WRITE "${FILE}" "#include \"io/ReaderProgram.h\"

namespace fenestra::core {

const char* const readerBuild = \"${VERSION} ${digest}\";

} // namespace fenestra::core
")
