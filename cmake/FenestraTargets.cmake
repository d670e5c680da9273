# Definition of all targets: one set of warnings, one set of sanitizers, no global flags.

# Warnings are errors in developer builds only, since newer compilers add warnings.
add_library(fenestra_warnings INTERFACE)
target_compile_options(fenestra_warnings INTERFACE -Wall -Wextra -Wconversion
  $<$<BOOL:${FENESTRA_DEVELOPER}>:-Werror>)

add_library(fenestra_sanitizers INTERFACE)
if(FENESTRA_SANITIZERS)
  target_compile_options(fenestra_sanitizers INTERFACE
    -fsanitize=${FENESTRA_SANITIZERS} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  # g++ warns about variables that its own instrumentation hides from it.
  target_compile_options(fenestra_sanitizers INTERFACE
    $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  target_link_options(fenestra_sanitizers INTERFACE -fsanitize=${FENESTRA_SANITIZERS})
endif()

# Checks of every memory access take a third of the compile time, so only the long test run has all of
# them. AddressSanitizer detects most of what null and object-size would. Code that reads files keeps
# the alignment check, since it converts bytes to numbers, and gets libFuzzer's instrumentation.
add_library(fenestra_reading INTERFACE)
if(FENESTRA_SANITIZERS MATCHES "undefined" AND NOT FENESTRA_CHECK_ACCESSES)
  target_compile_options(fenestra_sanitizers INTERFACE -fno-sanitize=null,alignment,object-size)
  target_compile_options(fenestra_reading INTERFACE -fsanitize=alignment)
endif()
if(FENESTRA_FUZZING)
  target_compile_options(fenestra_reading INTERFACE -fsanitize=fuzzer-no-link)
endif()

# fenestra_hide(TARGETS...): for libraries that are part of the shared library libfenestra, which exports its public
# interface alone.
function(fenestra_hide)
  set_target_properties(${ARGN} PROPERTIES
    POSITION_INDEPENDENT_CODE ON CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
endfunction()

# fenestra_precompile(NAME headers...): headers that targets with the same compiler options share by
# `target_precompile_headers(TARGET REUSE_FROM NAME)`.
function(fenestra_precompile name)
  add_library(${name} OBJECT "${PROJECT_SOURCE_DIR}/cmake/Headers.cxx")
  target_link_libraries(${name} PRIVATE Eigen3::Eigen fenestra_sanitizers fenestra_warnings)
  target_precompile_headers(${name} PRIVATE ${ARGN})
endfunction()

# What reads and writes files and composes requests takes longer to compile than to run: little optimization takes half
# the time. The headers are precompiled.
target_compile_options(fenestra_reading INTERFACE $<$<CONFIG:Release>:-O1>)
fenestra_precompile(fenestra_reading_headers
  <algorithm> <array> <charconv> <cmath> <filesystem> <fstream> <functional> <map> <memory> <optional> <span> <sstream>
  <string> <vector> <Eigen/Core> <nlohmann/json.hpp> <tbb/parallel_for.h>)
target_link_libraries(fenestra_reading_headers PRIVATE fenestra_reading)
fenestra_hide(fenestra_reading_headers)

# fenestra_simd_sources(sources...): sources that Highway compiles once per instruction set. A multiplication
# and an addition are fused only where the source says so: results must not depend on inlining.
# Sanitizer builds emulate the SIMD lanes, so that the reads of gathers are checked. With clang they omit
# UndefinedBehaviorSanitizer here, which would take a quarter of an hour to compile.
function(fenestra_simd_sources)
  set(options -ffp-contract=off)
  if(FENESTRA_SANITIZERS)
    list(APPEND options -DHWY_COMPILE_ONLY_EMU128
      $<$<CXX_COMPILER_ID:Clang>:-fno-sanitize=undefined>)
  endif()
  # Highway includes a source by its name, once per instruction set.
  set(root "${PROJECT_BINARY_DIR}/include/highway")
  foreach(source ${ARGN})
    if(NOT IS_ABSOLUTE "${source}")
      file(RELATIVE_PATH name "${PROJECT_SOURCE_DIR}/Renderer" "${CMAKE_CURRENT_SOURCE_DIR}/${source}")
      get_filename_component(folder "${root}/${name}" DIRECTORY)
      file(MAKE_DIRECTORY "${folder}")
      file(CREATE_LINK "${CMAKE_CURRENT_SOURCE_DIR}/${source}" "${root}/${name}" SYMBOLIC)
      set_source_files_properties(${source} PROPERTIES INCLUDE_DIRECTORIES "${root}")
    endif()
  endforeach()
  set_source_files_properties(${ARGN} PROPERTIES
    COMPILE_OPTIONS "${options}" SKIP_UNITY_BUILD_INCLUSION ON SKIP_PRECOMPILE_HEADERS ON)
endfunction()

# fenestra_library(FOLDER sources... [PUBLIC libraries...] [PRIVATE libraries...])
# A module of the renderer: the target fenestra_NAME, NAME being the last part of FOLDER (clip/focus:
# fenestra_focus). Its headers are included as "FOLDER/Header.h". Each library has its own include root
# with links to its headers, and only targets that link the library search that root: an include that
# violates the layers does not compile.
function(fenestra_library folder)
  cmake_parse_arguments(arg "" "" "PUBLIC;PRIVATE" ${ARGN})
  get_filename_component(name ${folder} NAME)
  set(target fenestra_${name})
  add_library(${target} STATIC ${arg_UNPARSED_ARGUMENTS})
  set_property(GLOBAL APPEND PROPERTY FENESTRA_MODULES ${target})
  fenestra_hide(${target})
  set(root "${PROJECT_BINARY_DIR}/include/${name}")
  file(REMOVE_RECURSE "${root}")
  file(MAKE_DIRECTORY "${root}/${folder}")
  file(GLOB headers CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/Renderer/${folder}/*.h")
  foreach(header ${headers})
    get_filename_component(file ${header} NAME)
    file(CREATE_LINK "${header}" "${root}/${folder}/${file}" SYMBOLIC)
    if(NOT file MATCHES "-inl.h$")
      list(APPEND standalone "${root}/${folder}/${file}")
    endif()
  endforeach()
  target_include_directories(${target} PUBLIC "${root}")
  # With CMAKE_VERIFY_INTERFACE_HEADER_SETS, all_verify_interface_header_sets compiles each header on its own.
  target_sources(${target} INTERFACE FILE_SET HEADERS BASE_DIRS "${root}" FILES ${standalone})
  target_link_libraries(${target} PUBLIC ${arg_PUBLIC} fenestra_sanitizers
    PRIVATE ${arg_PRIVATE} fenestra_warnings)
  if(folder MATCHES "^(io|files|scene|program|ranks)")
    target_link_libraries(${target} PRIVATE fenestra_reading)
    target_precompile_headers(${target} REUSE_FROM fenestra_reading_headers)
  endif()
endfunction()
