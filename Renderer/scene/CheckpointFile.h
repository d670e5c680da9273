#pragma once
// Films on disk: a render's sums, from which the same render goes on, and parts of a picture, which
// are merged. (Here, since image knows no files and files know no render.)
//
//   fenestra film 1 BYTES\n      version of the format, and size of the next line
//   {...}\n                      size, part and progress; what the film was made with
//   pixels                       PixelSums, of the part's tiles (image/Tiles), one after the other
//   plan                         floats, if the progress says so (SamplePlan::noise)
//   digest                       of all bytes before (io/Digest)
//
// Numbers are little-endian, 8 bytes each but the plan's, counts among them.

#include "integrator/render/Render.h"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <fstream>
#include <string>

namespace fenestra {

/// Content of a film's file. `made`: an object that tells what the film was made with.
std::string encodeCheckpoint(const RenderResult& result, const Shard& shard,
                             const nlohmann::ordered_json& metadata);

/// Film in a file, which may be damaged or come from strangers: sizes and digest are checked before
/// anything is believed, or memory taken.
class CheckpointFile {
public:
  /// Reads all but the pixels. Throws Error (input).
  explicit CheckpointFile(const std::filesystem::path& path);

  const std::filesystem::path& path() const { return m_path; }
  int width() const { return m_width; }
  int height() const { return m_height; }
  const Shard& shard() const { return m_shard; }
  /// Facts that the film was made with: an object.
  const nlohmann::json& metadata() const { return m_header.at("made"); }
  /// Arithmetic of the samples (RenderResult::target).
  std::string target() const;
  /// RenderResult::finishedSamples and begunSamples.
  std::uint64_t finishedSamples() const { return readCount("finished"); }
  std::uint64_t begunSamples() const { return readCount("begun"); }
  /// Counts of this part's work.
  Counters counters() const;

  /// Progress, over an empty film. Takes memory for width() x height() pixels.
  RenderResult readProgress() const;
  /// Puts the pixels of this part into a film of the same size. Throws Error (input).
  void readPixels(Film& film) const;

private:
  std::uint64_t readCount(const char* key) const;
  Error makeDamageError() const;
  std::ifstream open(std::uint64_t position) const;

  std::filesystem::path m_path;
  nlohmann::json m_header;
  std::uint64_t m_pixelsBegin = 0; ///< position in the file
  std::uint64_t m_planBegin = 0;   ///< position in the file
  bool m_hasPlan = false;
  int m_width = 0, m_height = 0;
  Shard m_shard;
};

} // namespace fenestra
