#pragma once
// Flags of `fenestra turntable`, and the options that follow for each frame.

#include "program/PresetFlags.h"

namespace fenestra {

inline constexpr int mostFrames = 10000; ///< numbers have four digits

struct TurntableOptions {
  RenderOptions render; ///< of all frames; view and files differ by frame
  int frames = 36;
  double degrees = 360.0;
  bool restart = false;

  /// Degrees from frame 0 to `frame`. Divides by `frames`, not frames - 1: a full turn loops
  /// without a repeated frame.
  double angle(int frame) const { return degrees * frame / frames; }
  /// True if the last frame leads back to frame 0.
  bool isClosed() const { return degrees != 0.0 && std::remainder(degrees, 360.0) == 0.0; }
};

/// Syntax of render, with the turntable's own flags.
const CommandSyntax& turntableSyntax();

/// Throws Error (usage).
TurntableOptions turntableOptions(const PresetFlags& given);

/// Picture of a frame: turn.png's frame 7 is turn_0007.png.
std::filesystem::path framePath(const std::filesystem::path& output, int frame);

/// Record of the finished frames: turn.png's is turn.turntable.json.
std::filesystem::path recordPath(const std::filesystem::path& output);

/// Render options with the frame's own file names.
RenderOptions frameOptions(const TurntableOptions& options, int frame);

/// All files that the image writer makes for a frame.
std::vector<std::filesystem::path> frameFiles(const TurntableOptions& options, int frame);

/// Request for the view of `start` with the eye turned around the target by `degrees`.
SceneRequest turnedRequest(const SceneRequest& request, const CameraPose& start, double degrees);

} // namespace fenestra
