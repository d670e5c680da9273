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

# The component `library`: libfenestra, its headers, what CMake and pkg-config need to find it, and the program that it
# reads files with.
include(CMakePackageConfigHelpers)
set(package "${CMAKE_INSTALL_LIBDIR}/cmake/Fenestra")
install(TARGETS fenestra_shared EXPORT FenestraTargets
  LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT library NAMELINK_COMPONENT library ${exclude})
install(TARGETS fenestra-reader RUNTIME DESTINATION "${CMAKE_INSTALL_LIBDIR}/fenestra" COMPONENT library ${exclude})
install(DIRECTORY Renderer/include/fenestra DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}" COMPONENT library ${exclude})
install(EXPORT FenestraTargets NAMESPACE Fenestra:: DESTINATION "${package}" COMPONENT library ${exclude})
write_basic_package_version_file("${PROJECT_BINARY_DIR}/FenestraConfigVersion.cmake" COMPATIBILITY SameMinorVersion)
file(RELATIVE_PATH relative_prefix "/${CMAKE_INSTALL_LIBDIR}/pkgconfig" "/")
set(NEEDED "@NEEDED@") # for static.sh
configure_file(cmake/package/fenestra.pc.in package/fenestra.pc.in @ONLY)
configure_file(cmake/package/FenestraStatic.cmake.in package/FenestraStatic.cmake.in COPYONLY)
get_property(modules GLOBAL PROPERTY FENESTRA_MODULES)
list(TRANSFORM modules REPLACE ".+" "$<TARGET_FILE:\\0>" OUTPUT_VARIABLE archives)
set(static "${PROJECT_BINARY_DIR}/package/libfenestra.a")
add_custom_command(OUTPUT "${static}"
  BYPRODUCTS package/fenestra.pc package/FenestraStatic.cmake
  COMMAND bash "${PROJECT_SOURCE_DIR}/cmake/package/static.sh" "$<TARGET_FILE:fenestra_shared>" "${PROJECT_BINARY_DIR}/package"
    "$<TARGET_FILE:fenestra_library>" ${archives}
  DEPENDS fenestra_shared ${modules} cmake/package/static.sh "${PROJECT_BINARY_DIR}/package/fenestra.pc.in"
    "${PROJECT_BINARY_DIR}/package/FenestraStatic.cmake.in"
  COMMENT "Linking static library libfenestra.a" VERBATIM)
add_custom_target(fenestra_static ALL DEPENDS "${static}")
install(FILES "${static}" DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT library ${exclude})
install(FILES cmake/package/FenestraConfig.cmake "${PROJECT_BINARY_DIR}/FenestraConfigVersion.cmake"
  "${PROJECT_BINARY_DIR}/package/FenestraStatic.cmake" DESTINATION "${package}" COMPONENT library ${exclude})
install(FILES "${PROJECT_BINARY_DIR}/package/fenestra.pc" DESTINATION "${CMAKE_INSTALL_LIBDIR}/pkgconfig"
  COMPONENT library ${exclude})
