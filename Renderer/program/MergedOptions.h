#pragma once
// Render options from sources other than the command line: a Slicer scene and an organ preset.
// Precedence: command line, preset given there, options stored in the scene, preset stored there.
// A preset only supplies option values: all later code sees options that a user could have given.

#include "program/RenderOptions.h"
#include "scene/Input.h"

namespace fenestra::core {

struct SceneOptions {
  OptionValues values;
  std::vector<std::string> ignored = {}; ///< one message per stored option that was not applied
};

/// Merges given options with those that Slicer's extension stored in the scene INPUT, in the last
/// node <FenestraRender focus="Femur" clip="surface" ... references="volume:ID;segmentation:ID;">.
/// Other inputs store none. A given option replaces all stored ones of its override group; a given
/// preset replaces those that it sets. Scenes are untrusted: stored file names are ignored (names
/// of presets and volume properties, and inline JSON, are accepted), as are sizes above 4096 x 4096
/// pixels and more than 65536 samples. Throws Error (input) for a damaged scene.
SceneOptions mergeSceneOptions(const OptionValues& given, const Input& input);

struct PresetOptions {
  OptionValues values;
  /// Modality that the transfer function was made for; nullopt: it is not the preset's.
  std::optional<Modality> transferModality = {};
};

/// Merges given options with those of the preset, and replaces the name "auto" by the chosen one.
/// Without a given focus, it becomes all segments that the preset knows in the input. Without a
/// segmentation, the preset's options of clip and materials are dropped. A given --clip overrides
/// all clip options of the preset. Throws Error: usage; input, also if the preset knows none of the
/// segments.
PresetOptions mergePreset(const OptionValues& given, const Input& input);

RenderOptions makeRenderOptions(const PresetOptions& merged);

} // namespace fenestra::core
