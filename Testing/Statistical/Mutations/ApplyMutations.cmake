# Copies layers of the renderer and applies every mutation of mutations.json to the copy. A mutation
# replaces one text of one file; MUTANT(name) in its new text switches it on at run time. The old text
# must occur exactly once: update a mutation together with the code that it changes. A SIMD mutation
# must be an error on every instruction set.
# usage: cmake -DFROM=Renderer -DTO=folder -DMUTATIONS=mutations.json -DLAYERS=a,b,... -P ApplyMutations.cmake
cmake_minimum_required(VERSION 3.25)

string(REPLACE "," ";" LAYERS "${LAYERS}")
foreach(layer ${LAYERS})
  get_filename_component(parent "${TO}/${layer}" DIRECTORY)
  file(COPY "${FROM}/${layer}" DESTINATION "${parent}" FILES_MATCHING PATTERN "*.h" PATTERN "*.cxx" PATTERN "*.inl")
endforeach()

file(READ "${MUTATIONS}" mutations)
string(JSON count LENGTH "${mutations}")
math(EXPR last "${count} - 1")
foreach(i RANGE ${last})
  foreach(field name file old new)
    string(JSON ${field} GET "${mutations}" ${i} ${field})
  endforeach()
  file(READ "${TO}/${file}" text)
  string(FIND "${text}" "${old}" first)
  string(FIND "${text}" "${old}" final REVERSE)
  if(first EQUAL -1 OR NOT first EQUAL final)
    message(FATAL_ERROR "mutations.json: ${name}: old text does not occur exactly once in ${file}; "
      "update the mutation")
  endif()
  string(REPLACE "${old}" "${new}" text "${text}")
  file(WRITE "${TO}/${file}" "${text}")
endforeach()
