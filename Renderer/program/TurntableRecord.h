#pragma once
// What of a turntable is finished, in a file beside its frames, so that the same command goes on
// where it was stopped and another one does not mix its frames with these.

#include "base/safe/Outputs.h"
#include "measure/SurfaceChange.h"
#include "program/TurntableFrames.h"
#include "session/Scene.h"

#include <nlohmann/json.hpp>

#include <map>

namespace fenestra {

class TurntableRecord {
public:
  /// Reads the record that there is for these flags; with options.restart as if there were none.
  /// Throws Error: usage where it, or any of the frames, is of other flags; input where it is
  /// damaged.
  TurntableRecord(const TurntableOptions& options, const FlagValues& flags);
  /// What the frames are made of, beside the flags: files that were named or are referred to, and
  /// the voxels. Throws Error (usage) where the recorded frames are of others.
  void setInputs(const TurntableOptions& options, const Scene& scene);

  int finishedCount() const;
  /// Recorded, and all its files are as they were then.
  bool isFinished(int frame) const { return m_finished[static_cast<std::size_t>(frame)]; }
  /// From the frame before, where there is a clipping surface; of all that are recorded.
  const std::map<int, SurfaceChange>& changes() const { return m_changes; }

  /// Of frames of the turntable before that --restart does not replace.
  std::optional<std::string> warning() const;

  /// Throws what Outputs does.
  void declare(Outputs& outputs) const;
  /// Puts the record in place: frames can only be told from others' once this is done. Throws Error
  /// (output).
  void write(Outputs& outputs) const;
  /// The frame's files are in place: records their sizes and digests, by which a damaged or another
  /// file is noticed. Throws Error (output).
  void finish(int frame, const std::vector<std::filesystem::path>& files,
              const std::optional<SurfaceChange>& change, Outputs& outputs);

private:
  void read(const TurntableOptions& options);
  /// Frames that no record tells of.
  void refuseOthers(const TurntableOptions& options) const;

  std::filesystem::path m_path;
  nlohmann::json m_request;
  nlohmann::json m_recorded; ///< the request that the record has; null where there is none
  std::vector<std::filesystem::path> m_beyond; ///< of the turntable before, and no frames of this
  std::vector<bool> m_finished;
  std::map<int, nlohmann::json> m_files; ///< of finished frames: name, bytes, digest
  std::map<int, SurfaceChange> m_changes;
};

/// As it is recorded, and in the statistics.
nlohmann::ordered_json changeJson(const SurfaceChange& change);

} // namespace fenestra
