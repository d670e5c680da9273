# Run by CPack on the installed files: gives them the form and the places that Debian's policy requires.
find_program(GZIP gzip REQUIRED)
set(usr "${CPACK_TEMPORARY_INSTALL_DIRECTORY}/usr")
set(doc "${usr}/share/doc/fenestra")

file(REMOVE "${doc}/LICENSE") # the file copyright contains it
file(RENAME "${doc}/CHANGELOG.md" "${doc}/changelog")
file(COPY "${CMAKE_CURRENT_LIST_DIR}/copyright" DESTINATION "${doc}")
set(VERSION "${CPACK_DEBIAN_PACKAGE_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE}")
set(MAINTAINER "${CPACK_PACKAGE_CONTACT}")
set(SOURCE "${CPACK_FENESTRA_SOURCE}")
set(GIT "${CPACK_FENESTRA_GIT}")
set(TEMPLATE "${CMAKE_CURRENT_LIST_DIR}/changelog.in")
set(FILE "${doc}/changelog.Debian")
include("${SOURCE}/cmake/Commit.cmake")
# No upload to Debian: there is no bug to close.
file(WRITE "${usr}/share/lintian/overrides/fenestra" "fenestra: initial-upload-closes-no-bugs *\n")
file(RENAME "${usr}/share/zsh/site-functions" "${usr}/share/zsh/vendor-completions")
execute_process(COMMAND "${GZIP}" -9n changelog changelog.Debian ../../man/man1/fenestra.1
  WORKING_DIRECTORY "${doc}" COMMAND_ERROR_IS_FATAL ANY)
file(CHMOD_RECURSE "${usr}" DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
file(CHMOD_RECURSE "${usr}/share" FILE_PERMISSIONS OWNER_READ OWNER_WRITE GROUP_READ WORLD_READ)
