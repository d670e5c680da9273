#pragma once
// What the renderer needs of Slicer's scene, and how it is written into a folder: a small scene of
// its own that `fenestra scene.mrml` renders, with flags that are told beside it: what a scene
// holds the renderer trusts less. No Slicer, no VTK: built and tested everywhere, and free to run
// in any thread.

#include "FenestraImage.h"

#include <string>
#include <vector>

namespace FenestraScene {

struct Segment {
  std::string id, name;
  int label = 0;         ///< its voxels' value in its layer
  std::size_t layer = 0; ///< the component that holds it, for segments may overlap
  std::string tags;      ///< "key:value|...": its terminology
};

/// Labels of segments that do not overlap; all layers of a segmentation have one lattice.
struct Layer {
  Image labels;
  std::array<long, 3> begin = {0, 0, 0}; ///< of its first voxel on that lattice
};

struct Segmentation {
  std::vector<Layer> layers;
  std::vector<Segment> segments;
  Matrix toWorld = identity; ///< of the transforms above it
};

struct Roi {
  std::string markup; ///< a .mrk.json's text
  Matrix toWorld = identity;
};

/// A value of `key` stands for the same volume (or segmentation) as long as it is the same; empty
/// is like no other.
struct Contents {
  Image volume;
  std::string volumeKey;
  Matrix volumeToWorld = identity;
  Segmentation segmentation; ///< of no segments: none
  std::string segmentationKey;
  std::string property; ///< the volume property's file, as text; empty: the renderer's choice
  std::string propertyEnding = ".vp"; ///< of that file
  std::vector<Roi> crop;
};

/// All layers side by side, a component each, over the smallest box that holds them.
Image composed(const std::vector<Layer>& layers);

/// Writes scenes into numbered folders below a private one; what did not change since the scene
/// before is linked, not written again.
class Writer {
public:
  explicit Writer(std::filesystem::path folder) : m_folder(std::move(folder)) {}

  /// Returns the path of the new scene, "<folder>/<number>/scene.mrml". Throws FileError.
  std::filesystem::path write(const Contents& contents);

private:
  struct Kept {
    std::string key;
    std::filesystem::path file;
  };
  void writeOrLink(const Image& image, const std::string& key, Kept& kept,
                   const std::filesystem::path& file);

  std::filesystem::path m_folder;
  Kept m_volume, m_segmentation;
  int m_written = 0;
};

} // namespace FenestraScene
