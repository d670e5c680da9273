# Installs the component `program`, with files where distributions expect them; Resources/release.sh builds its archive
# from it. Presets, lights, tables and materials are compiled in.
set(CMAKE_INSTALL_DOCDIR share/doc/fenestra CACHE PATH "Folder of README and changes")
include(GNUInstallDirs)
set(exclude)
if(Slicer_DIR) # the extension's package contains the archive
  set(exclude EXCLUDE_FROM_ALL)
endif()
install(TARGETS fenestra RUNTIME COMPONENT program ${exclude})
install(FILES LICENSE README.md CHANGELOG.md CITATION.cff DESTINATION "${CMAKE_INSTALL_DOCDIR}"
  COMPONENT program ${exclude})
foreach(output IN ITEMS
    "man:fenestra.1:${CMAKE_INSTALL_MANDIR}/man1"
    "bash:fenestra:${CMAKE_INSTALL_DATADIR}/bash-completion/completions"
    "zsh:_fenestra:${CMAKE_INSTALL_DATADIR}/zsh/site-functions"
    "fish:fenestra.fish:${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d")
  string(REPLACE ":" ";" output "${output}")
  list(POP_FRONT output kind name folder)
  install(FILES "$<TARGET_FILE_DIR:fenestra>/described/${kind}" RENAME ${name} DESTINATION "${folder}"
    COMPONENT program ${exclude})
endforeach()
