# How every target of this project is made: one warning set, one sanitizer set, no global flags.

add_library(fenestra_warnings INTERFACE)
target_compile_options(fenestra_warnings INTERFACE -Wall -Wextra -Wconversion -Werror)

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

# fenestra_lanes(sources...): sources that Highway compiles once for each instruction set. No multiply
# and add may be fused that is not written so: a lane's result must not depend on what was inlined
# around it. Sanitizers see lanes that are emulated (what gathers read is then checked), and nothing
# else of them: it would take clang a quarter of an hour.
function(fenestra_lanes)
  set(options -ffp-contract=off)
  if(FENESTRA_SANITIZERS)
    list(APPEND options -DHWY_COMPILE_ONLY_EMU128
      $<$<CXX_COMPILER_ID:Clang>:-fno-sanitize=undefined>)
  endif()
  set_source_files_properties(${ARGN} PROPERTIES
    COMPILE_OPTIONS "${options}" SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()

# fenestra_library(NAME [sources...] [PUBLIC libraries...] [PRIVATE libraries...])
# A concept of the renderer: the target fenestra_NAME, header-only where it has no sources.
# Headers are included as "NAME/Header.h".
function(fenestra_library name)
  cmake_parse_arguments(arg "" "" "PUBLIC;PRIVATE" ${ARGN})
  set(target fenestra_${name})
  if(arg_UNPARSED_ARGUMENTS)
    add_library(${target} STATIC ${arg_UNPARSED_ARGUMENTS})
    target_include_directories(${target} PUBLIC "${PROJECT_SOURCE_DIR}/Renderer")
    target_link_libraries(${target} PUBLIC ${arg_PUBLIC} fenestra_sanitizers
      PRIVATE ${arg_PRIVATE} fenestra_warnings)
    if(name MATCHES "^(io|scene|cli)")
      target_link_libraries(${target} PRIVATE fenestra_reading)
    endif()
  else()
    add_library(${target} INTERFACE)
    target_include_directories(${target} INTERFACE "${PROJECT_SOURCE_DIR}/Renderer")
    target_link_libraries(${target} INTERFACE ${arg_PUBLIC} fenestra_sanitizers)
  endif()
endfunction()
