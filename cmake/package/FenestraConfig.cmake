# find_package(Fenestra): target Fenestra::fenestra, the shared library with its public headers.
include("${CMAKE_CURRENT_LIST_DIR}/FenestraTargets.cmake")
