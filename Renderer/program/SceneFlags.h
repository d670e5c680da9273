#pragma once
// Flags that come with a Slicer scene: the extension keeps what a picture was made with in a node
// of the scene, <FenestraRender focus="Femur" clip="surface" ...
// references="volume:ID;segmentation:ID;">, so that rendering the scene makes the picture again.

#include "program/Flags.h"

namespace fenestra {

struct SceneFlags {
  FlagValues flags;
  std::vector<std::string> leftOut = {}; ///< what is stored and not taken, and why; a line each
};

/// Flags of `fenestra render` with what the scene named by INPUT stores; of several nodes the last
/// counts. Flags that are given win: any of the view, of clipping, or of when to stop replaces all
/// stored ones of its kind, and a preset that is given those that it says. Other inputs change
/// nothing. A scene comes from others: names of files are left out (presets, volume properties by
/// name, and looks as text are taken), as are more than 4096 x 4096 pixels or 65536 samples. Throws
/// Error (input) for a damaged scene.
SceneFlags withSceneFlags(const FlagValues& given);

/// The stored ones among them, as arguments.
std::vector<std::string> sceneArguments(const FlagValues& given, const FlagValues& merged);

} // namespace fenestra
