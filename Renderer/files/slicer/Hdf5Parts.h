#pragma once
// Check of HDF5 files, for the child that reads transforms.

#include <string>

namespace fenestra {

/// True if an HDF5 file is self-contained: no link, raw storage or virtual data set lies in another
/// file, which the library would open unchecked. False where the file cannot be read.
bool holdsAllItsParts(const std::string& path);

} // namespace fenestra
