#pragma once
// The flags of `fenestra [render]`, and what they mean.

#include "files/pictures/ImageWriter.h"
#include "program/Flags.h"
#include "session/Picture.h"
#include "session/RenderRequest.h"

namespace fenestra {

enum class ProgressMode { automatic, bar, xml, none };

struct RenderOptions {
  SceneRequest scene;
  RenderSettings settings;
  std::optional<Background> background = {};  ///< by default the scene's, else that of the settings
  std::vector<std::filesystem::path> inputs;  ///< files named as such, presets aside
  std::vector<std::filesystem::path> outputs; ///< at least one
  NamedBy outputsNamedBy = NamedBy::user;
  LayerSet layers;
  std::optional<std::filesystem::path> surface = {}; ///< with a clip by depth alone
  std::optional<std::filesystem::path> stats = {};
  /// Slicer runs this program, listens to its standard output, and takes every word on the other
  /// one for an error.
  std::optional<std::filesystem::path> returnValues = {};
  ProgressMode progress = ProgressMode::automatic;
  std::optional<std::string> preset = {}; ///< the organ preset's name
};

extern const CommandSyntax renderSyntax;

/// Whether the picture depends on the flag, and not only its files or how the process works.
bool shapesPicture(const Flag& flag);

/// Whether the flag is of clipping, view or look: what an organ preset may say.
bool shapesLook(const Flag& flag);

/// Throws Error (usage) for values out of range and for flags that contradict each other.
RenderOptions renderOptions(const FlagValues& flags);

/// The settings with what is behind the scene: as the flags say, else as a Slicer scene says, which
/// gives nothing for other inputs.
RenderSettings settingsFor(const RenderOptions& options, const std::optional<Background>& scene);

} // namespace fenestra
