# Copies storeys of the renderer with every error of faults.json in them (README.md here).
# usage: cmake -DFROM=Renderer -DTO=folder -DFAULTS=faults.json -DSTOREYS=a,b,... -P PlantFaults.cmake
cmake_minimum_required(VERSION 3.25)

string(REPLACE "," ";" STOREYS "${STOREYS}")
foreach(storey ${STOREYS})
  file(COPY "${FROM}/${storey}" DESTINATION "${TO}" FILES_MATCHING PATTERN "*.h" PATTERN "*.cxx")
endforeach()

file(READ "${FAULTS}" faults)
string(JSON count LENGTH "${faults}")
math(EXPR last "${count} - 1")
foreach(i RANGE ${last})
  foreach(field name file old new)
    string(JSON ${field} GET "${faults}" ${i} ${field})
  endforeach()
  file(READ "${TO}/${file}" text)
  string(FIND "${text}" "${old}" first)
  string(FIND "${text}" "${old}" final REVERSE)
  if(first EQUAL -1 OR NOT first EQUAL final)
    message(FATAL_ERROR "faults.json: ${name}: its old text does not stand once in ${file}; "
      "plant it anew")
  endif()
  string(REPLACE "${old}" "${new}" text "${text}")
  file(WRITE "${TO}/${file}" "${text}")
endforeach()
