#pragma once
// A phantom as a Slicer scene, as Slicer 5.2 to 5.12 write a volume with volume rendering.

#include "base/TextStream.h"
#include "phantoms/Phantom.h"

#include <string>

namespace fenestra::core {

/// Content of a .mrml file. Its nodes are named after `name`: Volume, Segmentation, VolumeProperty
/// and MarkupsROI with their storage and display nodes; uncropped GPU volume rendering; and view 1
/// with a parallel camera that frames the volume, seen from Phantom::towardViewer. World is RAS;
/// numbers have six significant digits, as in Slicer. `data`: path from the scene to its files,
/// empty or with a trailing /.
std::string makePhantomScene(const Phantom& phantom, const std::string& name,
                             const std::string& data = "");

/// Content of the region of interest's .mrk.json: the box that the volume's voxels fill, LPS mm.
std::string makePhantomRoi(const Phantom& phantom);

/// Formats numbers as Slicer writes them: six significant digits, separated by spaces.
template <typename... Numbers>
std::string joinSpaced(const Numbers&... numbers) {
  TextWriter stream;
  const char* separator = "";
  ((stream << std::exchange(separator, " ") << numbers), ...);
  return stream.str();
}

} // namespace fenestra::core
