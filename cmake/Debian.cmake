# The Debian package: `cpack` in the build folder of a Release build creates fenestra_VERSION-1_ARCHITECTURE.deb. It
# depends on the libraries of the Debian release that it was built on.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME fenestra)
set(CPACK_PACKAGE_CONTACT "The Fenestra maintainers <fenestra-render@users.noreply.github.com>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_INSTALL_CMAKE_PROJECTS "${PROJECT_BINARY_DIR};Fenestra;program;/")
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_VERSION "${PROJECT_VERSION}")
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "path tracer for medical volumes that leaves the focus unoccluded")
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION
"Renders CT, MR and ultrasound volumes, from files or 3D Slicer scenes, by
unbiased Monte Carlo path tracing. A smooth clipping surface exposes the
segments of interest and continues into the surrounding tissue.
.
Reads NRRD, NIfTI, MetaImage, DICOM, and scenes (.mrml, .mrb); writes PNG,
TIFF, OpenEXR and NRRD. No graphics card is needed.")
set(CPACK_PRE_BUILD_SCRIPTS "${CMAKE_CURRENT_LIST_DIR}/debian/finish.cmake")
set(CPACK_FENESTRA_SOURCE "${PROJECT_SOURCE_DIR}")
set(CPACK_FENESTRA_GIT "${GIT_EXECUTABLE}")
include(CPack)
