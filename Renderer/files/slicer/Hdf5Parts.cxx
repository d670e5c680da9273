#include "files/slicer/Hdf5Parts.h"

#include <hdf5.h>

namespace fenestra {
namespace {

constexpr herr_t goOn = 0, leaveOff = -1;

herr_t visitLink(hid_t, const char*, const H5L_info_t* link, void*) {
  return link->type == H5L_TYPE_HARD || link->type == H5L_TYPE_SOFT ? goOn : leaveOff;
}

herr_t visitObject(hid_t file, const char* name, const H5O_info_t* object, void*) {
  if (object->type != H5O_TYPE_DATASET)
    return goOn;
  const hid_t data = H5Dopen2(file, name, H5P_DEFAULT);
  const hid_t properties = H5Dget_create_plist(data);
  const bool isInside =
      H5Pget_external_count(properties) == 0 && H5Pget_layout(properties) != H5D_VIRTUAL;
  H5Pclose(properties);
  H5Dclose(data);
  return isInside ? goOn : leaveOff;
}

} // namespace

bool holdsAllItsParts(const std::string& path) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  // Each group and object is visited once, however often it is named.
  const bool isWhole = file >= 0 &&
                       H5Lvisit(file, H5_INDEX_NAME, H5_ITER_NATIVE, visitLink, nullptr) >= 0 &&
                       H5Ovisit(file, H5_INDEX_NAME, H5_ITER_NATIVE, visitObject, nullptr) >= 0;
  H5Fclose(file);
  return isWhole;
}

} // namespace fenestra
