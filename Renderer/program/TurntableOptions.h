#pragma once
// Options of `fenestra turntable`, and the names of its frames and manifest.

#include "program/RenderOptions.h"

namespace fenestra::core {

inline constexpr int maxFrames = 10000; ///< file names have four digits

struct TurntableOptions {
  RenderOptions render; ///< common to all frames; view and files differ per frame
  int frames = 36;
  double degrees = 360.0;
  bool restart = false;
  Shard shard = {}; ///< of the frames: first() to end() - 1

  int first() const { return frames * shard.index / shard.count; }
  int end() const { return frames * (shard.index + 1) / shard.count; }

  /// Rotation from frame 0 to `frame`, degrees. A full turn loops without a duplicate frame.
  double angle(int frame) const { return degrees * frame / frames; }
  /// True if frame 0 follows the last frame.
  bool isClosed() const { return degrees != 0.0 && std::remainder(degrees, 360.0) == 0.0; }

  /// Images of a frame, one per output: frame 7 of turn.png is turn_0007.png.
  std::vector<std::filesystem::path> images(int frame) const;
  /// All files that the image writer creates for a frame.
  std::vector<std::filesystem::path> files(int frame) const;
};

/// Syntax of render with the turntable's own options.
const CommandSyntax& turntableSyntax();

/// `render`: already parsed from the same values. Throws Error (usage).
TurntableOptions makeTurntableOptions(const OptionValues& values, const RenderOptions& render);

/// Manifest of finished frames: turn.turntable.json for turn.png, turn.2of3.turntable.json for the
/// second of three shards, so that shards can render at the same time.
std::filesystem::path manifestPath(const std::filesystem::path& output, const Shard& shard);

} // namespace fenestra::core
