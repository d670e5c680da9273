#pragma once
// For the child that reads transforms.

#include <string>

namespace fenestra {

/// Whether all that a HDF5 file holds is in it: no link, raw storage or virtual data set in another
/// file, which the library would open whatever it is. False where the file cannot be read.
bool holdsAllItsParts(const std::string& path);

} // namespace fenestra
