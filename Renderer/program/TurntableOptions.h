#pragma once
// Flags of `fenestra turntable`, and the options that follow for each frame.

#include "program/RenderOptions.h"

namespace fenestra {

inline constexpr int maxFrames = 10000; ///< numbers have four digits

struct TurntableOptions {
  RenderOptions render; ///< of all frames; view and files differ by frame
  int frames = 36;
  double degrees = 360.0;
  bool restart = false;
  Shard shard = {}; ///< of the frames: those from `first` to `end` - 1

  int first() const { return frames * shard.index / shard.count; }
  int end() const { return frames * (shard.index + 1) / shard.count; }

  /// Degrees from frame 0 to `frame`; a full turn loops without a repeated frame.
  double angle(int frame) const { return degrees * frame / frames; }
  /// True if the last frame leads back to frame 0.
  bool isClosed() const { return degrees != 0.0 && std::remainder(degrees, 360.0) == 0.0; }

  /// Pictures of a frame, an output each: turn.png's frame 7 is turn_0007.png.
  std::vector<std::filesystem::path> images(int frame) const;
  /// All files that the image writer makes for a frame.
  std::vector<std::filesystem::path> files(int frame) const;
};

/// Syntax of render, with the turntable's own flags.
const CommandSyntax& turntableSyntax();

/// `render`: options of the same flags. Throws Error (usage).
TurntableOptions makeTurntableOptions(const OptionValues& values, const RenderOptions& render);

/// Record of the finished frames: turn.png's is turn.turntable.json, that of its second part of
/// three turn.2of3.turntable.json, so that parts are rendered beside each other.
std::filesystem::path manifestPath(const std::filesystem::path& output, const Shard& shard);

} // namespace fenestra
