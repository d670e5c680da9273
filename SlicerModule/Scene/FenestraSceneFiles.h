#pragma once
// Slicer's data for the renderer, written into a folder: a small scene for `fenestra scene.mrml`.
// Flags are passed on the command line, since the renderer trusts a scene less. Independent of
// Slicer and VTK: built and tested everywhere, usable in any thread.

#include "FenestraImage.h"

#include <stdexcept>
#include <string>
#include <vector>

namespace SlicerExport {

/// Problem that a user can solve; one sentence that says how.
struct UserError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct Segment {
  std::string id, name;
  int label = 0;                                 ///< value of its voxels in its layer
  std::size_t layer = 0;                         ///< component that holds it; segments may overlap
  std::string tags = {};                         ///< terminology, "key:value|..."
  std::array<double, 3> color = {0.5, 0.5, 0.5}; ///< sRGB in [0, 1]; Slicer's grey: none given

  bool operator==(const Segment& other) const {
    return id == other.id && name == other.name && label == other.label && layer == other.layer &&
           tags == other.tags && color == other.color;
  }
};

/// Labels of segments that do not overlap; all layers of a segmentation share one lattice.
struct Layer {
  Image labels;
  std::array<long, 3> begin = {0, 0, 0}; ///< lattice index of its first voxel
};

struct Segmentation {
  std::vector<Layer> layers;
  std::vector<Segment> segments;
  Matrix toWorld = identity; ///< of its parent transforms
};

struct Roi {
  std::string markup; ///< text of a .mrk.json
  Matrix toWorld = identity;
};

/// Equal values of a key mean the same volume (or segmentation); an empty key equals no other.
struct Contents {
  Image volume;
  std::string volumeKey;
  Matrix volumeToWorld = identity;
  Segmentation segmentation; ///< without segments: none
  std::string segmentationKey;
  std::string property; ///< text of the volume property's file; empty: the renderer chooses
  std::string propertyExtension = ".vp"; ///< of the property's file
  std::vector<Roi> crop;
};

/// All layers as components of one image, over the smallest box that holds them.
Image composeLayers(const std::vector<Layer>& layers);

/// Writes a segmentation (.seg.nrrd) of one voxel in which each segment has a value of its own: for
/// questions about names, tags and colours. Throws FileError.
void writeSegmentNames(std::vector<Segment> segments, const std::filesystem::path& file);

/// Writes scenes into numbered folders below a private one; files unchanged since the preceding
/// scene are linked, not written again.
class Writer {
public:
  explicit Writer(std::filesystem::path folder) : m_folder(std::move(folder)) {}

  /// Writes a scene and returns its path, "<folder>/<number>/scene.mrml". Throws FileError.
  std::filesystem::path write(const Contents& contents);

private:
  struct WrittenFile {
    std::string key;
    std::filesystem::path file;
  };
  void writeOrLink(const Image& image, const std::string& key, WrittenFile& last,
                   const std::filesystem::path& file);

  std::filesystem::path m_folder;
  WrittenFile m_volume, m_segmentation;
  int m_written = 0;
};

} // namespace SlicerExport
