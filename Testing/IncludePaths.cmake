# The build's fence: what stands below a library is found by its sources, what stands above is not.
# usage: cmake -DCOMPILER=CXX -DINCLUDES=A|B|... -P Fence.cmake, INCLUDES being those of integrator/render
cmake_minimum_required(VERSION 3.25)
string(REPLACE "|" ";" folders "${INCLUDES}")
list(TRANSFORM folders PREPEND "-I")

# compiles(HEADER RESULT ERRORS): whether a source that includes HEADER does.
function(compiles header result errors)
  file(WRITE "${CMAKE_CURRENT_BINARY_DIR}/fence.cxx" "#include \"${header}\"\n")
  execute_process(COMMAND "${COMPILER}" -std=c++20 -fsyntax-only ${folders} "${CMAKE_CURRENT_BINARY_DIR}/fence.cxx"
    RESULT_VARIABLE status ERROR_VARIABLE text)
  set(${result} ${status} PARENT_SCOPE)
  set(${errors} "${text}" PARENT_SCOPE)
endfunction()

compiles(integrator/scalar/Tracker.h below text)
if(NOT below EQUAL 0)
  message(FATAL_ERROR "integrator/render does not find what it may include:\n${text}")
endif()
foreach(header scene/PreparedScene.h files/medical/VolumeReader.h clip/surface/ClippingSurface.h)
  compiles(${header} above text)
  if(above EQUAL 0 OR NOT text MATCHES "${header}")
    message(FATAL_ERROR "integrator/render may not include ${header}, and the build does not say so:\n${text}")
  endif()
endforeach()
