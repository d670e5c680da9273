# The renderer beside the module: where Slicer looks for command line modules, with the libraries
# that a user may not have.
set(cli_folder "${CMAKE_BINARY_DIR}/${Slicer_CLIMODULES_BIN_DIR}")
add_custom_target(${COMMAND_MODULE_NAME} ALL
  COMMAND ${CMAKE_COMMAND} -E make_directory "${cli_folder}"
  COMMAND ${CMAKE_COMMAND} -E copy_if_different "$<TARGET_FILE:fenestra>"
    "${cli_folder}/${COMMAND_MODULE_NAME}${CMAKE_EXECUTABLE_SUFFIX}"
  COMMAND ${CMAKE_COMMAND} -E copy_if_different "$<TARGET_FILE:fenestra>.xml"
    "${cli_folder}/${COMMAND_MODULE_NAME}.xml"
  DEPENDS fenestra
  COMMENT "The renderer as a command line module")

# DT_RPATH, not DT_RUNPATH: it holds for the libraries of libraries, and LD_LIBRARY_PATH, which
# Slicer sets for its own, does not come before it.
set(libraries_folder "${Slicer_INSTALL_LIB_DIR}/fenestra")
set(cli_install "${Slicer_INSTALL_CLIMODULES_BIN_DIR}")
file(RELATIVE_PATH to_libraries "/${cli_install}" "/${libraries_folder}")
set_target_properties(fenestra PROPERTIES INSTALL_RPATH "$ORIGIN/${to_libraries}")
target_link_options(fenestra PRIVATE "LINKER:--disable-new-dtags")
install(TARGETS fenestra RUNTIME DESTINATION "${cli_install}" COMPONENT RuntimeLibraries)
install(CODE "
  file(RENAME \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${cli_install}/$<TARGET_FILE_NAME:fenestra>\"
    \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${cli_install}/${COMMAND_MODULE_NAME}${CMAKE_EXECUTABLE_SUFFIX}\")
" COMPONENT RuntimeLibraries)
install(FILES "$<TARGET_FILE:fenestra>.xml" DESTINATION "${cli_install}"
  RENAME "${COMMAND_MODULE_NAME}.xml" COMPONENT RuntimeLibraries)
install(CODE "
  file(GET_RUNTIME_DEPENDENCIES EXECUTABLES \"$<TARGET_FILE:fenestra>\"
    RESOLVED_DEPENDENCIES_VAR needed UNRESOLVED_DEPENDENCIES_VAR missing
    PRE_EXCLUDE_REGEXES \"^(ld-linux|libc|libm|libdl|libpthread|librt|libgcc_s|libstdc)[-.+]\")
  if(missing)
    message(FATAL_ERROR \"The renderer needs libraries that are not found: \${missing}\")
  endif()
  file(INSTALL DESTINATION \"\${CMAKE_INSTALL_PREFIX}/${libraries_folder}\" TYPE SHARED_LIBRARY
    FOLLOW_SYMLINK_CHAIN FILES \${needed})
" COMPONENT RuntimeLibraries)
