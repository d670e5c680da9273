#pragma once
// Manifest of a turntable's finished frames. A frame depends only on its own request, even if its
// surface is smoothed with those of neighboring angles, so frames can be rendered in any order.

#include "metrics/SurfaceChange.h"
#include "program/Manifest.h"
#include "program/TurntableOptions.h"
#include "scene/PreparedScene.h"

namespace fenestra::core {

class TurntableManifest {
public:
  /// Reads an existing manifest of these options; with options.restart, ignores finished frames.
  /// Throws Error: usage if the manifest, or a frame without one, belongs to other options; input
  /// for a damaged manifest. Keeps a reference to the options.
  TurntableManifest(const TurntableOptions& options, const OptionValues& values);
  /// Adds the inputs to the request: states of all input files and digests of the voxels. Throws
  /// Error (usage) if the finished frames have other inputs.
  void setInputs(const PreparedScene& scene);

  /// Finished frames by number; all their files are unchanged.
  const std::map<int, Manifest::Item>& finished() const { return m_manifest.finished(); }
  /// Changes of the clipping surface since the preceding frame, of all finished frames that have
  /// one.
  std::vector<SurfaceChange> changes() const;
  /// Warning about files of the previous turntable that --restart does not replace; empty: none.
  const std::string& warning() const { return m_warning; }

  /// Throws the errors of Outputs.
  void declare(Outputs& outputs) const { m_manifest.declare(outputs); }
  /// Writes the manifest, before the first frame. Throws Error (output).
  void write(Outputs& outputs) const { m_manifest.write(outputs); }
  /// Adds a frame whose files are in place. Throws Error (output).
  void finish(int frame, const std::optional<SurfaceChange>& change, Outputs& outputs);

private:
  void read();
  /// Throws Error (usage) if the stored request differs from this one as far as it is known.
  void requireSame() const;
  void rejectUnknownFrames() const;
  /// Warning about files of the stored turntable that are no frames of these options.
  std::string makeStaleWarning();
  /// Most files that the manifest of a turntable with the maximum number of frames can name.
  int maxFiles() const;

  const TurntableOptions& m_options;
  Manifest m_manifest;
  std::string m_warning;
};

/// JSON form in the manifest and in the statistics.
nlohmann::ordered_json toJson(const SurfaceChange& change);

} // namespace fenestra::core
