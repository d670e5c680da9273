#pragma once
// Flags of `fenestra [render]`, and their meaning.

#include "files/images/ImageWriter.h"
#include "program/Options.h"
#include "scene/FilmImage.h"
#include "scene/RenderRequest.h"

namespace fenestra {

/// Pictures that are filtered: those for the eye (.png, .tif); the others, too, in channels of
/// their own; none.
enum class Denoise { automatic, on, off };
/// Noise that a render stops by: of the raw picture, of the filtered one; automatic: filtered if
/// all outputs are pictures for the eye.
enum class NoiseTarget { automatic, raw, filtered };

enum class ProgressMode { automatic, bar, xml, none };

struct RenderOptions {
  RenderRequest scene;
  RenderSettings settings;
  std::optional<Background> background = {};  ///< nullopt: the scene's, else the standard
  std::vector<std::filesystem::path> inputs;  ///< input files given as such, without presets
  std::vector<std::filesystem::path> outputs; ///< at least one
  NameOrigin outputNaming = NameOrigin::user;
  LayerSet layers = allLayers;
  Display display = {}; ///< of .png and .tif
  Denoise denoise = Denoise::automatic;
  NoiseTarget noiseTarget = NoiseTarget::automatic;  ///< settled: raw or filtered
  std::optional<std::filesystem::path> surface = {}; ///< only with a clip by depth
  std::optional<std::filesystem::path> stats = {};
  std::optional<std::filesystem::path> checkpoint = {}; ///< film of what is rendered so far
  /// True for a part of a picture, settings.shard: the checkpoint is the only result.
  bool isShard = false;
  /// Slicer's return parameters. If set, warnings go to standard output: Slicer reports everything
  /// on standard error as an error.
  std::optional<std::filesystem::path> returnValues = {};
  ProgressMode progress = ProgressMode::automatic;
  std::optional<std::string> preset = {}; ///< the organ preset's name

  /// True if an `.exr` or `.nrrd` has a layer that the filter makes.
  bool hasFilterLayer(const std::string& layer) const {
    return denoise == Denoise::on && layers.contains(layer);
  }
  HasDenoised filteredFiles() const {
    return hasFilterLayer("denoised") ? HasDenoised::yes : HasDenoised::no;
  }
};

inline constexpr double unlimited = 0x1p40; ///< limit of samples and of scatterings

extern const CommandSyntax renderSyntax;

/// True if the picture depends on the flag, not only its files or how the process works.
inline bool isImageOption(const Option& option) {
  return option.overrideGroup != OverrideGroup::process;
}

/// True for a flag of clipping; also how the focus's labels are shaped, and how the context looks.
bool isClipOption(const Option& option);
/// True for a flag of clipping, view or look: the flags that an organ preset may set.
bool isAppearanceOption(const Option& option);

/// Values of the flags in the places that the table says. Throws Error (usage) for values out of
/// range.
RenderOptions readOptions(const OptionValues& values);

/// Options from all flags. Throws Error (usage) for values out of range and for flags that
/// contradict each other.
RenderOptions makeRenderOptions(const OptionValues& values);

/// options.settings with their background: the flags', else `scene` (a Slicer scene's; nullopt for
/// other inputs), else Background::standard.
RenderSettings makeSettings(const RenderOptions& options, const std::optional<Background>& scene);

} // namespace fenestra
