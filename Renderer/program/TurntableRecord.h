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
  /// Finished frame.
  struct Frame {
    nlohmann::json files;                ///< name, bytes and digest of each
    std::optional<SurfaceChange> change; ///< of the clipping surface since the preceding frame
  };

  /// Reads the existing record of these flags, if any; with options.restart, none of its frames
  /// counts as finished. Throws Error: usage if the record, or a frame without a record, belongs to
  /// other flags; input if the record is damaged. Keeps a reference to the options.
  TurntableRecord(const TurntableOptions& options, const FlagValues& flags);
  /// Adds the inputs beside the flags to the request: states of all files named or referred to, and
  /// digests of the voxels. Throws Error (usage) if the recorded frames have other inputs.
  void setInputs(const Scene& scene);

  /// Frames that are recorded and whose files are all unchanged, by number.
  const std::map<int, Frame>& finished() const { return m_finished; }
  /// Warning about files of the previous turntable that --restart does not replace; empty: none.
  const std::string& warning() const { return m_warning; }

  /// Throws the errors of Outputs.
  void declare(Outputs& outputs) const;
  /// Puts the record in place: before the first frame, for a frame without a record cannot be
  /// distinguished from another turntable's. Throws Error (output).
  void write(Outputs& outputs) const;
  /// Records sizes and digests of the frame's files, by which a damaged or replaced file is
  /// noticed. Call once they are in place. Throws Error (output).
  void finish(int frame, const std::optional<SurfaceChange>& change, Outputs& outputs);

private:
  void read();
  /// Throws Error (usage) if the record is of another request, as far as the latter is known.
  void requireSame() const;
  void refuseFramesWithoutRecord() const;

  const TurntableOptions& m_options;
  std::filesystem::path m_path;
  nlohmann::json m_request;
  nlohmann::json m_recorded; ///< request in the record file; null: no record
  std::string m_warning;
  std::map<int, Frame> m_finished;
};

/// JSON form in the record and in the statistics.
nlohmann::ordered_json changeJson(const SurfaceChange& change);

} // namespace fenestra
