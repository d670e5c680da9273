# Checks include paths: integrator/render finds headers of lower layers and none of higher layers.
# usage: cmake -DCOMPILER=CXX -DINCLUDES=A|B|... -P IncludePaths.cmake (INCLUDES: those of integrator/render)
cmake_minimum_required(VERSION 3.25)
string(REPLACE "|" ";" folders "${INCLUDES}")
list(TRANSFORM folders PREPEND "-I")

# compile_include(HEADER RESULT ERRORS): compiles a source that includes HEADER; RESULT is 0 on success.
function(compile_include header result errors)
  file(WRITE "${CMAKE_CURRENT_BINARY_DIR}/include_paths.cxx" "#include \"${header}\"\n")
  execute_process(COMMAND "${COMPILER}" -std=c++20 -fsyntax-only ${folders} "${CMAKE_CURRENT_BINARY_DIR}/include_paths.cxx"
    RESULT_VARIABLE status ERROR_VARIABLE text)
  set(${result} ${status} PARENT_SCOPE)
  set(${errors} "${text}" PARENT_SCOPE)
endfunction()

compile_include(integrator/scalar/Tracker.h lower text)
if(NOT lower EQUAL 0)
  message(FATAL_ERROR "integrator/render does not find a header that it may include:\n${text}")
endif()
foreach(header scene/PreparedScene.h files/medical/VolumeReader.h clip/surface/ClippingSurface.h)
  compile_include(${header} higher text)
  if(higher EQUAL 0 OR NOT text MATCHES "${header}")
    message(FATAL_ERROR "integrator/render must not find ${header}, but the compiler does not report it as missing:\n${text}")
  endif()
endforeach()
