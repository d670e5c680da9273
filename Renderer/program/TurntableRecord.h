#pragma once
// Record of a turntable's finished frames, in a file beside them: the same command resumes where it
// was stopped, and another command does not mix its frames with these.

#include "base/safe/Outputs.h"
#include "measure/SurfaceChange.h"
#include "program/TurntableFrames.h"
#include "session/Scene.h"

#include <nlohmann/json.hpp>

#include <map>

namespace fenestra {

class TurntableRecord {
public:
  /// Reads the existing record of these flags, if any; with options.restart, none of its frames
  /// counts as finished. Throws Error: usage if the record, or a frame without a record, belongs to
  /// other flags; input if the record is damaged.
  TurntableRecord(const TurntableOptions& options, const FlagValues& flags);
  /// Adds the inputs beside the flags to the request: states of all files named or referred to, and
  /// digests of the voxels. Throws Error (usage) if the recorded frames have other inputs.
  void setInputs(const TurntableOptions& options, const Scene& scene);

  int finishedCount() const;
  /// True if the frame is recorded and all its files are unchanged.
  bool isFinished(int frame) const { return m_finished[static_cast<std::size_t>(frame)]; }
  /// Change of the clipping surface since the preceding frame, by frame; all recorded frames that
  /// have one.
  const std::map<int, SurfaceChange>& changes() const { return m_changes; }

  /// Warning about files of the previous turntable that --restart does not replace.
  std::optional<std::string> warning() const;

  /// Throws the errors of Outputs.
  void declare(Outputs& outputs) const;
  /// Puts the record in place. Call before the first frame: a frame without a record cannot be
  /// distinguished from another turntable's. Throws Error (output).
  void write(Outputs& outputs) const;
  /// Records sizes and digests of the frame's files, by which a damaged or replaced file is
  /// noticed. Call once they are in place. Throws Error (output).
  void finish(int frame, const std::vector<std::filesystem::path>& files,
              const std::optional<SurfaceChange>& change, Outputs& outputs);

private:
  void read(const TurntableOptions& options);
  /// Refuses existing frames without a record.
  void refuseOthers(const TurntableOptions& options) const;

  std::filesystem::path m_path;
  nlohmann::json m_request;
  nlohmann::json m_recorded;                   ///< request in the record file; null: no record
  std::vector<std::filesystem::path> m_beyond; ///< files of the previous turntable only
  std::vector<bool> m_finished;
  std::map<int, nlohmann::json> m_files; ///< of finished frames: name, bytes, digest
  std::map<int, SurfaceChange> m_changes;
};

/// JSON form in the record and in the statistics.
nlohmann::ordered_json changeJson(const SurfaceChange& change);

} // namespace fenestra
