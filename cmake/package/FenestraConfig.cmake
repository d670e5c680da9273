# find_package(Fenestra): targets Fenestra::fenestra, the shared library, and Fenestra::static, the static one, with the
# public headers.
include("${CMAKE_CURRENT_LIST_DIR}/FenestraTargets.cmake")
include("${CMAKE_CURRENT_LIST_DIR}/FenestraStatic.cmake")
