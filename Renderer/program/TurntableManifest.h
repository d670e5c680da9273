#pragma once
// Record of a turntable's finished frames.

#include "metrics/SurfaceChange.h"
#include "program/Manifest.h"
#include "program/TurntableOptions.h"
#include "scene/PreparedScene.h"

namespace fenestra {

class TurntableManifest {
public:
  /// Reads the existing record of these flags, if any; with options.restart, none of its frames
  /// counts as finished. Throws Error: usage if the record, or a frame without a record, belongs to
  /// other flags; input if the record is damaged. Keeps a reference to the options.
  TurntableManifest(const TurntableOptions& options, const OptionValues& values);
  /// Adds the inputs beside the flags to the request: states of all files named or referred to, and
  /// digests of the voxels. Throws Error (usage) if the recorded frames have other inputs.
  void setInputs(const PreparedScene& scene);

  /// Frames that are recorded and whose files are all unchanged, by number.
  const std::map<int, Manifest::Item>& finished() const { return m_manifest.finished(); }
  /// Changes of the clipping surface, each since the preceding frame, of the finished frames that
  /// have one.
  std::vector<SurfaceChange> changes() const;
  /// Warning about files of the previous turntable that --restart does not replace; empty: none.
  const std::string& warning() const { return m_warning; }

  /// Throws the errors of Outputs.
  void declare(Outputs& outputs) const { m_manifest.declare(outputs); }
  /// Puts the record in place, before the first frame. Throws Error (output).
  void write(Outputs& outputs) const { m_manifest.write(outputs); }
  /// Records a frame whose files are in place. Throws Error (output).
  void finish(int frame, const std::optional<SurfaceChange>& change, Outputs& outputs);

private:
  void read();
  /// Throws Error (usage) if the record is of another request, as far as the latter is known.
  void requireSame() const;
  void rejectUnknownFrames() const;
  /// Warning about existing files of the recorded turntable that are no frames of these options.
  std::string makeStaleWarning();
  /// Most files that a record of as many frames as there may be names.
  int maxFiles() const;

  const TurntableOptions& m_options;
  Manifest m_manifest;
  std::string m_warning;
};

/// JSON form in the record and in the statistics.
nlohmann::ordered_json toJson(const SurfaceChange& change);

} // namespace fenestra
