#pragma once
// Flags of `fenestra render` that come from elsewhere than the command line: from a Slicer scene,
// and from an organ preset. Given flags win.

#include "program/RenderOptions.h"
#include "scene/Input.h"

namespace fenestra {

struct SceneOptions {
  OptionValues values;
  std::vector<std::string> ignored = {}; ///< stored flags not taken, with the reason; a line each
};

/// Given flags merged with those that Slicer's extension stored in the scene INPUT, in a node
/// <FenestraRender focus="Femur" clip="surface" ... references="volume:ID;segmentation:ID;">, the
/// last of several; other inputs store none. A given flag of view, of clipping, or of when to stop
/// replaces all stored ones of its kind; a given preset the stored flags that it sets. A scene
/// comes from others, so these are left out: names of files (presets, volume properties by name,
/// and looks as text are taken), more than 4096 x 4096 pixels, more than 65536 samples. Throws
/// Error (input) for a damaged scene.
SceneOptions mergeSceneOptions(const OptionValues& given, const Input& input);

struct PresetOptions {
  OptionValues values;
  /// Modality for which the transfer function was made; nullopt: it is not the preset's.
  std::optional<Modality> transferModality = {};
};

/// Given flags merged with those of their preset (--preset liver stands for a focus, a look, a view
/// and a clip), whose own name replaces "auto". Focus: all segments that the preset knows, from the
/// segmentation that a render would read; without a segmentation, nothing is clipped. A given
/// --clip wins over all that the preset says of clipping modes. Throws Error: usage; input, also if
/// the preset knows none of the segments.
PresetOptions mergePreset(const OptionValues& given, const Input& input);

/// Render options from given flags and their preset's.
RenderOptions makeRenderOptions(const PresetOptions& merged);

} // namespace fenestra
