// Versions of all libraries, in the one source file that includes a header of each.

#include "base/Text.h"
#include "program/about/About.h"

#include <Eigen/Core>
#include <OpenColorIO/OpenColorIO.h>
#include <OpenEXRConfig.h>
#include <ft2build.h>
#include <gdcmVersion.h>
#include <gnu/libc-version.h>
#include <hdf5.h>
#include <hwy/highway.h>
#include <itkVersion.h>
#include <nlohmann/json.hpp>
#include <png.h>
#include <pugixml.hpp>
#include <tbb/version.h>
#include <tiffio.h>
#include <volk.h>
#include <zip.h>
#include <zlib.h>

#include FT_FREETYPE_H

#include <array>

namespace fenestra::core {
namespace {

std::string joinVersion(std::initializer_list<std::size_t> parts) {
  return joinNumbers(parts, ".");
}

std::string hdf5Version() {
  std::array<unsigned, 3> parts = {};
  H5get_libversion(&parts[0], &parts[1], &parts[2]);
  return joinNumbers(parts, ".");
}

/// Third word of "LIBTIFF, Version 4.5.0".
std::string tiffVersion() {
  const std::vector<std::string> all = splitWords(TIFFGetVersion());
  return all.size() < 3 ? "" : all[2];
}

} // namespace

std::vector<std::pair<std::string, std::string>> libraryVersions() {
  return {
      {"Eigen", joinVersion({EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION})},
      {"FreeType", joinVersion({FREETYPE_MAJOR, FREETYPE_MINOR, FREETYPE_PATCH})},
      {"GDCM", gdcm::Version::GetVersion()},
      {"glibc", gnu_get_libc_version()},
      {"HDF5", hdf5Version()},
      {"Highway", joinVersion({HWY_MAJOR, HWY_MINOR, HWY_PATCH})},
      {"ITK", itk::Version::GetITKVersion()},
      {"libpng", png_get_libpng_ver(nullptr)},
      {"libtiff", tiffVersion()},
      {"libzip", zip_libzip_version()},
      {"nlohmann-json", joinVersion({NLOHMANN_JSON_VERSION_MAJOR, NLOHMANN_JSON_VERSION_MINOR,
                                     NLOHMANN_JSON_VERSION_PATCH})},
      {"oneTBB", TBB_runtime_version()},
      {"OpenColorIO", OCIO_NAMESPACE::GetVersion()},
      {"OpenEXR", OPENEXR_VERSION_STRING},
      {"pugixml", joinVersion({PUGIXML_VERSION / 1000, PUGIXML_VERSION / 10 % 100})},
      {"volk",
       joinVersion({VK_API_VERSION_MAJOR(VK_HEADER_VERSION_COMPLETE),
                    VK_API_VERSION_MINOR(VK_HEADER_VERSION_COMPLETE), VOLK_HEADER_VERSION})},
      {"zlib", zlibVersion()},
  };
}

} // namespace fenestra::core
