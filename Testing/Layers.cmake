# Checks #include directives against the table in Renderer/README.md: a folder may include its own headers, those
# of the folders in its row's last column, and transitively those that these may include. A row may name only rows
# above it, so there are no cycles. System calls are in io/platform alone, so no other folder includes POSIX or Linux
# headers, but two files below it.
# usage: cmake -DRENDERER=FOLDER -P Layers.cmake
cmake_minimum_required(VERSION 3.25)
include("${CMAKE_CURRENT_LIST_DIR}/RendererSources.cmake")
set(folders)
set(errors)

file(STRINGS "${RENDERER}/README.md" rows ENCODING UTF-8 REGEX "^\\| `[a-z/]+` \\|")
foreach(row IN LISTS rows)
  string(REGEX MATCH "^\\| `([a-z/]+)` \\|.*\\|([^|]*)\\|$" matched "${row}")
  set(folder ${CMAKE_MATCH_1})
  string(REGEX MATCHALL "[a-z/]+" named "${CMAKE_MATCH_2}")
  set(allowed_${folder} ${folder})
  foreach(other IN LISTS named)
    list(APPEND allowed_${folder} ${allowed_${other}})
    if(NOT other IN_LIST folders)
      list(APPEND errors "README.md: `${folder}` includes `${other}`, which has no row above it")
    endif()
  endforeach()
  list(APPEND folders ${folder})
endforeach()

string(CONCAT system "^ *# *include <((arpa|linux|net|netinet|sys)/|"
  "(aio|dirent|dlfcn|elf|fcntl|glob|grp|libgen|link|netdb|poll|pthread|pwd|sched|semaphore|signal|spawn|termios|"
  "unistd|utime)[.]h>)")
set(below_platform base/LargePages.cxx base/PhysicalMemory.cxx)

foreach(source IN LISTS sources)
  get_filename_component(folder ${source} DIRECTORY)
  string(REGEX REPLACE "^include/" "" folder ${folder})
  if(NOT folder IN_LIST folders)
    list(APPEND errors "${source}: its folder has no row in README.md's table")
    continue()
  endif()
  if(NOT folder STREQUAL "io/platform" AND NOT source IN_LIST below_platform)
    file(STRINGS "${RENDERER}/${source}" lines REGEX "${system}")
    foreach(line IN LISTS lines)
      list(APPEND errors "${source}: ${line}: system calls belong into io/platform")
    endforeach()
  endif()
  file(STRINGS "${RENDERER}/${source}" lines REGEX "^ *# *include \"")
  foreach(line IN LISTS lines)
    string(REGEX REPLACE "^[^\"]*\"([^\"]*)\".*$" "\\1" header "${line}")
    get_filename_component(other ${header} DIRECTORY)
    if(NOT other IN_LIST allowed_${folder})
      list(APPEND errors "${source}: includes ${header}, which README.md's table does not allow for `${folder}`")
    endif()
  endforeach()
endforeach()

report_errors("${errors}" "fix the above, or the table")
