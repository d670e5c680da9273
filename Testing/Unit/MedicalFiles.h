#pragma once
// Writes small medical image files for tests.

#include "Refusals.h"

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace fenestra::core {

template <typename T>
std::string rawBytes(const std::vector<T>& samples) {
  return {reinterpret_cast<const char*>(samples.data()), samples.size() * sizeof(T)};
}

/// Geometry in LPS, as in ITK.
struct FileGeometry {
  std::vector<std::size_t> size = {3, 4, 2};
  std::vector<std::vector<double>> directions = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  std::vector<double> spacing = {1, 1, 1};
  std::vector<double> origin = {0, 0, 0};
  unsigned components = 1;
  bool compress = false;
  std::map<std::string, std::string> fields = {};
};

/// Adds Slicer's fields for segment n.
inline void addSegment(FileGeometry& geometry, int n, const std::string& id,
                       const std::string& name, const std::string& value,
                       const std::string& layer) {
  const std::string prefix = "Segment" + std::to_string(n) + "_";
  geometry.fields[prefix + "ID"] = id;
  geometry.fields[prefix + "Name"] = name;
  geometry.fields[prefix + "Color"] = "0.5 0.25 1";
  geometry.fields[prefix + "LabelValue"] = value;
  if (!layer.empty())
    geometry.fields[prefix + "Layer"] = layer;
}

/// Writes the samples through ITK; the file extension selects the format.
template <typename T>
void writeFile(const std::filesystem::path& path, const std::vector<T>& samples,
               const FileGeometry& geometry = {});

} // namespace fenestra::core
