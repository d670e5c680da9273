# How every target of this project is made: one warning set, one sanitizer set, no global flags.

# Warnings stop the build of developers alone: a newer compiler has new ones.
add_library(fenestra_warnings INTERFACE)
target_compile_options(fenestra_warnings INTERFACE -Wall -Wextra -Wconversion
  $<$<BOOL:${FENESTRA_DEVELOPER}>:-Werror>)

add_library(fenestra_sanitizers INTERFACE)
if(FENESTRA_SANITIZERS)
  target_compile_options(fenestra_sanitizers INTERFACE
    -fsanitize=${FENESTRA_SANITIZERS} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  # g++ warns of what its own instrumentation hides from it.
  target_compile_options(fenestra_sanitizers INTERFACE
    $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  target_link_options(fenestra_sanitizers INTERFACE -fsanitize=${FENESTRA_SANITIZERS})
endif()

# Checks of which each access has one take a third of the time of compiling: the long run alone has all.
# AddressSanitizer sees most of what null and object-size would; bytes become numbers, and may be
# unaligned, in what reads files. There, too, is what leads libFuzzer.
add_library(fenestra_reading INTERFACE)
if(FENESTRA_SANITIZERS MATCHES "undefined" AND NOT FENESTRA_CHECK_ACCESSES)
  target_compile_options(fenestra_sanitizers INTERFACE -fno-sanitize=null,alignment,object-size)
  target_compile_options(fenestra_reading INTERFACE -fsanitize=alignment)
endif()
if(FENESTRA_FUZZING)
  target_compile_options(fenestra_reading INTERFACE -fsanitize=fuzzer-no-link)
endif()

# fenestra_simd_sources(sources...): sources that Highway compiles once for each instruction set. No multiply
# and add may be fused that is not written so: a lane's result must not depend on what was inlined
# around it. Sanitizers see lanes that are emulated (what gathers read is then checked), and nothing
# else of them: it would take clang a quarter of an hour.
function(fenestra_simd_sources)
  set(options -ffp-contract=off)
  if(FENESTRA_SANITIZERS)
    list(APPEND options -DHWY_COMPILE_ONLY_EMU128
      $<$<CXX_COMPILER_ID:Clang>:-fno-sanitize=undefined>)
  endif()
  # Highway includes a source by its name, once for each instruction set.
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
    COMPILE_OPTIONS "${options}" SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()

# fenestra_library(FOLDER sources... [PUBLIC libraries...] [PRIVATE libraries...])
# A concept of the renderer: the target fenestra_NAME, NAME being the last part of FOLDER (clip/focus:
# fenestra_focus). Its headers are included as "FOLDER/Header.h", and found by those alone that link it,
# for each library has an include root of its own, of links to its headers: an include that the floor plan
# forbids does not compile.
function(fenestra_library folder)
  cmake_parse_arguments(arg "" "" "PUBLIC;PRIVATE" ${ARGN})
  get_filename_component(name ${folder} NAME)
  set(target fenestra_${name})
  add_library(${target} STATIC ${arg_UNPARSED_ARGUMENTS})
  set(root "${PROJECT_BINARY_DIR}/include/${name}")
  file(REMOVE_RECURSE "${root}")
  file(MAKE_DIRECTORY "${root}/${folder}")
  file(GLOB headers CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/Renderer/${folder}/*.h")
  foreach(header ${headers})
    get_filename_component(file ${header} NAME)
    file(CREATE_LINK "${header}" "${root}/${folder}/${file}" SYMBOLIC)
    if(NOT file MATCHES "-inl.h$")
      list(APPEND alone "${root}/${folder}/${file}")
    endif()
  endforeach()
  target_include_directories(${target} PUBLIC "${root}")
  # With CMAKE_VERIFY_INTERFACE_HEADER_SETS, all_verify_interface_header_sets compiles each header alone.
  target_sources(${target} INTERFACE FILE_SET HEADERS BASE_DIRS "${root}" FILES ${alone})
  target_link_libraries(${target} PUBLIC ${arg_PUBLIC} fenestra_sanitizers
    PRIVATE ${arg_PRIVATE} fenestra_warnings)
  if(folder MATCHES "^(io|files|scene|program)")
    target_link_libraries(${target} PRIVATE fenestra_reading)
  endif()
endfunction()
