#pragma once
// The flags of `fenestra turntable`, and what they make of each frame.

#include "program/PresetFlags.h"

namespace fenestra {

inline constexpr int mostFrames = 10000; ///< four digits

struct TurntableOptions {
  RenderOptions render; ///< of any frame, but for its view and its files
  int frames = 36;
  double degrees = 360.0;
  bool restart = false;

  /// Degrees from the first frame to this one: a full turn's frames follow each other for ever.
  double angle(int frame) const { return degrees * frame / frames; }
  /// Whether the first frame follows the last.
  bool isClosed() const { return degrees != 0.0 && std::remainder(degrees, 360.0) == 0.0; }
};

/// What render takes, and what is a turntable's own.
const CommandSyntax& turntableSyntax();

/// Throws Error (usage).
TurntableOptions turntableOptions(const PresetFlags& given);

/// turn.png's frame 7 is turn_0007.png.
std::filesystem::path framePath(const std::filesystem::path& output, int frame);

/// Of what of a turntable is finished: turn.png's is turn.turntable.json.
std::filesystem::path recordPath(const std::filesystem::path& output);

/// The frame's own files.
RenderOptions frameOptions(const TurntableOptions& options, int frame);

/// All that the writer of images makes for a frame.
std::vector<std::filesystem::path> frameFiles(const TurntableOptions& options, int frame);

/// A picture of what `start` sees, by an eye that has gone around the target from there.
SceneRequest turnedRequest(const SceneRequest& request, const CameraPose& start, double degrees);

} // namespace fenestra
