# Copies the renderer to the folder where Slicer looks for command line modules.
set(cli_folder "${CMAKE_BINARY_DIR}/${Slicer_CLIMODULES_BIN_DIR}")
add_custom_target(${COMMAND_MODULE_NAME} ALL
  COMMAND ${CMAKE_COMMAND} -E make_directory "${cli_folder}"
  COMMAND ${CMAKE_COMMAND} -E copy_if_different "$<TARGET_FILE:fenestra>"
    "${cli_folder}/${COMMAND_MODULE_NAME}${CMAKE_EXECUTABLE_SUFFIX}"
  COMMAND ${CMAKE_COMMAND} -E copy_if_different "$<TARGET_FILE:fenestra>.xml"
    "${cli_folder}/${COMMAND_MODULE_NAME}.xml"
  DEPENDS fenestra
  COMMENT "The renderer as a command line module")

# The package contains the complete archive for users without Slicer, and a link to the archive's launcher. Slicer
# reads the .xml file beside the link instead of starting the launcher.
set(cli_install "${Slicer_INSTALL_CLIMODULES_BIN_DIR}")
set(archive_install "${Slicer_INSTALL_LIB_DIR}/fenestra")
file(RELATIVE_PATH to_launcher "/${cli_install}" "/${archive_install}/bin/fenestra")
install(CODE "
  set(prefix \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}\")
  set(made \"${CMAKE_CURRENT_BINARY_DIR}/archive\")
  file(REMOVE_RECURSE \"\${made}\" \"\${prefix}/${archive_install}\")
  execute_process(COMMAND bash \"${CMAKE_CURRENT_LIST_DIR}/../Resources/release.sh\" --stale-evidence
    \"\${made}\" \"$<TARGET_FILE_DIR:fenestra>/..\" COMMAND_ERROR_IS_FATAL ANY)
  file(GLOB archive \"\${made}/*.tar.gz\")
  file(ARCHIVE_EXTRACT INPUT \"\${archive}\" DESTINATION \"\${prefix}/${Slicer_INSTALL_LIB_DIR}\")
  string(REGEX REPLACE \".*/|[.]tar[.]gz$\" \"\" folder \"\${archive}\")
  file(RENAME \"\${prefix}/${Slicer_INSTALL_LIB_DIR}/\${folder}\" \"\${prefix}/${archive_install}\")
  file(MAKE_DIRECTORY \"\${prefix}/${cli_install}\")
  file(CREATE_LINK \"${to_launcher}\" \"\${prefix}/${cli_install}/${COMMAND_MODULE_NAME}\" SYMBOLIC)
" COMPONENT RuntimeLibraries)
install(FILES "$<TARGET_FILE:fenestra>.xml" DESTINATION "${cli_install}"
  RENAME "${COMMAND_MODULE_NAME}.xml" COMPONENT RuntimeLibraries)
