#pragma once
// Phantom as a Slicer scene, as Slicer 5.2 to 5.12 write a volume with volume rendering.

#include "base/TextStream.h"
#include "phantoms/Phantom.h"

#include <string>

namespace fenestra {

/// Text of a .mrml, its nodes named after `name`: Volume, Segmentation, VolumeProperty and
/// MarkupsROI, each with its storage and display; GPU volume rendering of the volume, not cropped;
/// view 1 with its parallel camera, which frames the volume seen from Phantom::towardViewer. World
/// is RAS; numbers have six digits, as Slicer's. `data`: path of the scene's files from the scene,
/// empty or with a / at its end.
std::string makePhantomScene(const Phantom& phantom, const std::string& name,
                             const std::string& data = "");

/// Text of the region of interest's .mrk.json: the box that the volume's voxels fill, LPS mm.
std::string makePhantomRoi(const Phantom& phantom);

/// Numbers as Slicer writes them: a stream's six digits, separated by blanks.
template <typename... Numbers>
std::string joinSpaced(const Numbers&... numbers) {
  TextWriter stream;
  const char* separator = "";
  ((stream << std::exchange(separator, " ") << numbers), ...);
  return stream.str();
}

} // namespace fenestra
