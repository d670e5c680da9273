# No string literal of the renderer names an option, except in the program: below it, errors and warnings carry codes,
# which program/ErrorAdvice.cxx turns into advice. io/platform/SelfExec.h passes an argument to the dynamic loader.
# usage: cmake -DRENDERER=FOLDER -P Messages.cmake
cmake_minimum_required(VERSION 3.25)
include("${CMAKE_CURRENT_LIST_DIR}/RendererSources.cmake")
list(FILTER sources EXCLUDE REGEX "^program/|^io/platform/SelfExec.h$")
set(errors)
foreach(source IN LISTS sources)
  file(STRINGS "${RENDERER}/${source}" lines ENCODING UTF-8 REGEX "\"[^\"]*--[a-z]")
  foreach(line IN LISTS lines)
    list(APPEND errors "${source}: ${line}")
  endforeach()
endforeach()
report_errors("${errors}" "the above names options below the program")
