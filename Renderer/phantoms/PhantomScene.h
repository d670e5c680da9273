#pragma once
// A phantom as a Slicer scene: what Slicer 5.2 to 5.12 write of a volume with volume rendering.

#include "phantoms/Phantom.h"

#include <string>

namespace fenestra {

/// The names of a scene's files, relative to its folder or absolute; not encoded.
struct PhantomFileNames {
  std::string volume, segmentation, property, roi;
};

/// The text of a .mrml, its nodes named after `name`: Volume, Segmentation, VolumeProperty and
/// MarkupsROI, each with its storage and display; GPU volume rendering of the volume, not cropped;
/// and view 1 with its camera, parallel, which frames the volume from where
/// Phantom::towardViewer says. World is RAS; numbers have six digits, as Slicer's.
std::string phantomScene(const Phantom& phantom, const std::string& name,
                         const PhantomFileNames& files);

/// The text of the region of interest's .mrk.json: the box that the volume's voxels fill, in LPS.
std::string phantomRoi(const Phantom& phantom);

/// As Slicer writes file names and segment ids in attributes: all but letters, digits and "-_./"
/// become %XX.
std::string urlEncoded(const std::string& text);

} // namespace fenestra
