# What `cmake --install` puts where distributions expect it, and Resources/release.sh into its archive: component
# `program`. Presets, lights, tables and materials are compiled in.
include(GNUInstallDirs)
set(elsewhere)
if(Slicer_DIR) # the extension's package holds the archive
  set(elsewhere EXCLUDE_FROM_ALL)
endif()
install(TARGETS fenestra RUNTIME COMPONENT program ${elsewhere})
install(FILES LICENSE README.md CHANGELOG.md CITATION.cff DESTINATION "${CMAKE_INSTALL_DOCDIR}"
  COMPONENT program ${elsewhere})
