# What `cmake --install` puts where distributions expect it. Presets, lights, tables and materials are compiled in.
include(GNUInstallDirs)
install(TARGETS fenestra RUNTIME)
install(FILES LICENSE README.md CHANGELOG.md CITATION.cff DESTINATION "${CMAKE_INSTALL_DOCDIR}")
