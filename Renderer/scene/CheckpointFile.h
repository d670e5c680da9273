#pragma once
// Checkpoint files. A checkpoint stores the sums of a render, so that the render resumes as if it
// had not been interrupted. A shard's checkpoint holds only its tiles; `merge` joins shards. The
// next sample index of a pixel is its sample count, so tiles may be ahead of the current pass. This
// class is not in `image` or `files`: `image` must not depend on `files`, nor `files` on `render`.
//
//   fenestra film 1 BYTES\n      format version, and size of the next line
//   {...}\n                      JSON header: image size, shard, progress and metadata
//   pixels                       PixelSums of the shard's tiles (image/Tiles), tile by tile
//   plan                         floats, if the header says so (SamplePlan::noise)
//   digest                       of all bytes before (io/Digest)
//
// Numbers are little-endian. All numbers, counts included, have 8 bytes; those of the plan have 4.

#include "integrator/render/Render.h"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <fstream>
#include <string>

namespace fenestra::core {

/// Encodes a checkpoint file. `metadata`: JSON object that identifies the request and its inputs.
std::string encodeCheckpoint(const RenderResult& result, const Shard& shard,
                             const nlohmann::ordered_json& metadata);

/// Checkpoint file, which may be damaged or untrusted: sizes and digest are verified before any
/// content is used and before memory is allocated.
class CheckpointFile {
public:
  /// Reads everything except the pixels. Throws Error (input).
  explicit CheckpointFile(const std::filesystem::path& path);

  const std::filesystem::path& path() const { return m_path; }
  int width() const { return m_width; }
  int height() const { return m_height; }
  const Shard& shard() const { return m_shard; }
  /// JSON object that identifies the request and its inputs.
  const nlohmann::json& metadata() const { return m_header.at("made"); }
  /// Instruction set that computed the samples (RenderResult::target).
  std::string target() const;
  /// RenderResult::finishedSamples and begunSamples.
  std::uint64_t finishedSamples() const { return readCount("finished"); }
  std::uint64_t begunSamples() const { return readCount("begun"); }
  /// Counters of this shard's work.
  Counters counters() const;

  /// Returns the progress with an empty film. Allocates width() x height() pixels.
  RenderResult readProgress() const;
  /// Copies the pixels of this shard into a film of the same size. Throws Error (input).
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

} // namespace fenestra::core
