#pragma once
// Flags stored in a Slicer scene: the extension keeps the flags of a picture in a node of the
// scene, <FenestraRender focus="Femur" clip="surface" ... references="volume:ID;segmentation:ID;">,
// so that rendering the scene reproduces the picture.

#include "program/Flags.h"
#include "session/Input.h"

namespace fenestra {

struct SceneFlags {
  FlagValues flags;
  std::vector<std::string> leftOut = {}; ///< stored flags not taken, with the reason; a line each
};

/// Flags of `fenestra render` merged with those stored in the scene INPUT; the last of several
/// nodes counts; inputs other than scenes change nothing. Given flags win: one of view, of
/// clipping, or of when to stop replaces all stored ones of its kind; a given preset replaces the
/// stored flags that it sets. A scene comes from others, so these are left out: names of files
/// (presets, volume properties by name, and looks as text are taken), more than 4096 x 4096 pixels,
/// more than 65536 samples. Throws Error (input) for a damaged scene.
SceneFlags withSceneFlags(const FlagValues& given, const Input& input);

/// Stored flags in `merged`, as arguments.
std::vector<std::string> sceneArguments(const FlagValues& given, const FlagValues& merged);

} // namespace fenestra
