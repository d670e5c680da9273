#pragma once
// Writes Slicer's data for the renderer into a folder: a small scene for `fenestra scene.mrml`.
// Flags are passed on the command line, since the renderer trusts a scene less. Needs neither
// Slicer nor VTK: built and tested everywhere, usable in any thread.

#include "FenestraImage.h"

#include <stdexcept>
#include <string>
#include <vector>

namespace SlicerExport {

/// Problem that the user can fix; the message is one sentence and a hint.
struct UserError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct Segment {
  std::string id, name;
  int label = 0;                                 ///< value of its voxels in its layer
  std::size_t layer = 0;                         ///< component of the labels; layers may overlap
  std::string tags = {};                         ///< terminology, "key:value|..."
  std::array<double, 3> color = {0.5, 0.5, 0.5}; ///< sRGB in [0, 1]; Slicer's default gray

  bool operator==(const Segment& other) const {
    return id == other.id && name == other.name && label == other.label && layer == other.layer &&
           tags == other.tags && color == other.color;
  }
};

/// Labels of segments that do not overlap; all layers of a segmentation share one voxel grid.
struct Layer {
  Image labels;
  std::array<long, 3> begin = {0, 0, 0}; ///< grid index of its first voxel
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

/// Equal keys mean the same volume (or segmentation); an empty key never matches.
struct Contents {
  Image volume;
  std::string volumeKey;
  Matrix volumeToWorld = identity;
  Segmentation segmentation; ///< without segments: none
  std::string segmentationKey;
  std::string property; ///< text of the volume property's file; empty: the renderer chooses
  std::string propertyExtension = ".vp"; ///< of the volume property file
  std::vector<Roi> crop;
};

/// Combines the layers as components of one image over their common bounding box.
Image composeLayers(const std::vector<Layer>& layers);

/// Writes a segmentation (.seg.nrrd) of one voxel in which each segment has its own label value,
/// for queries by name, tags and color. Throws FileError.
void writeSegmentNames(std::vector<Segment> segments, const std::filesystem::path& file);

/// Creates a folder and its parents unless it exists. Throws FileError.
void createFolder(const std::filesystem::path& folder);

/// Writes scenes into numbered folders of a private folder; files that are unchanged since the
/// preceding scene become hard links.
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
