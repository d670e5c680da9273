#pragma once
// Options of `fenestra [render]`, and the request and settings that they result in.

#include "files/images/ImageWriter.h"
#include "program/Options.h"
#include "scene/FilmImage.h"
#include "scene/RenderRequest.h"

namespace fenestra::core {

/// Which images are denoised: automatic, display images (.png, .tif) only; on, also .exr and .nrrd,
/// in additional channels; off, none.
enum class Denoise { automatic, on, off };
/// Noise that --noise limits: of the raw or of the denoised image. Automatic: denoised if all
/// outputs are display images.
enum class NoiseTarget { automatic, raw, denoised };

/// What renders: automatic, the GPU if a device and the scene allow it, else the CPU; gpu, the same
/// with a warning.
enum class DeviceChoice { cpu, gpu, automatic };

enum class ProgressMode { automatic, bar, xml, none };

struct RenderOptions {
  RenderRequest scene;
  RenderSettings settings;
  std::optional<Background> background = {};  ///< nullopt: the scene's, or else the standard one
  std::vector<std::filesystem::path> inputs;  ///< given input files, without those of presets
  std::vector<std::filesystem::path> outputs; ///< at least one, except for a shard
  NameOrigin outputNaming = NameOrigin::user;
  LayerSet layers = allLayers;
  Display display = {}; ///< of .png and .tif
  SmoothingRequest smoothing = {
      SmoothingRequest::Kind::automatic}; ///< as given; scene.smoothing is resolved
  Denoise denoise = Denoise::automatic;
  DeviceChoice device = DeviceChoice::cpu;
  NoiseTarget noiseTarget = NoiseTarget::automatic;  ///< raw or filtered after makeRenderOptions
  std::optional<std::filesystem::path> surface = {}; ///< only with a depth clip
  std::optional<std::filesystem::path> stats = {};
  std::optional<std::filesystem::path> checkpoint = {};
  /// True with --shard (settings.shard): the checkpoint file is the only result.
  bool isShard = false;
  /// Slicer's return parameter file. If set, warnings go to standard output, since Slicer reports
  /// all text on standard error as an error.
  std::optional<std::filesystem::path> returnValues = {};
  ProgressMode progress = ProgressMode::automatic;
  bool quiet = false;                     ///< no progress and no result line
  bool verbose = false;                   ///< also facts about the scene
  std::optional<std::string> preset = {}; ///< the organ preset's name

  /// True if an `.exr` or `.nrrd` gets this layer, which the denoiser makes.
  bool hasFilterLayer(const std::string& layer) const {
    return denoise == Denoise::on && layers.contains(layer);
  }
  ExtraFiles extraFiles() const {
    return {.denoised = hasFilterLayer("denoised"), .depth50 = layers.contains("depth50")};
  }
};

inline constexpr double unlimited = 0x1p40; ///< upper limit of samples and bounces

extern const CommandSyntax renderSyntax;

/// A heading of render's options, and the word that selects it: `fenestra --help clip`.
struct OptionGroup {
  const char* name;
  const char* heading;
};
extern const std::span<const OptionGroup> renderGroups;

/// True if the image depends on the option, false for files and execution.
inline bool isImageOption(const Option& option) {
  return option.overrideGroup != OverrideGroup::process;
}

/// True for options of clipping, including label smoothing and context appearance.
bool isClipOption(const Option& option);
/// True for options of clipping, view or appearance, which an organ preset may set.
bool isAppearanceOption(const Option& option);

/// Stores each value where its table row says, without further checks. Throws Error (usage) for
/// values out of range.
RenderOptions readOptions(const OptionValues& values);
/// As readOptions, of the options that choose the volume.
VolumeChoice readVolumeChoice(const OptionValues& values);

/// Resolves progress for quiet commands. Throws Error (usage) for both quiet and verbose.
RenderOptions resolveProgress(RenderOptions options);

/// Resolves which volume the scene renders: as read, or smoothed. `isServer`: for fenestra serve.
void resolveSmoothing(RenderOptions& options, bool isServer = false);

inline constexpr const char* smoothingOption = "volume-smoothing";
/// A resolved request as a value of this option, exactly, and back. Throws Error (usage).
std::string formatSmoothing(const SmoothingRequest& smoothing);
SmoothingRequest parseSmoothing(const std::string& text);

/// Complete options from all values. Throws Error (usage) for values out of range and for
/// contradictory options.
RenderOptions makeRenderOptions(const OptionValues& values);

/// Throws Error (usage) if a scale bar is requested, but the projection has no uniform scale.
void requireScale(const RenderOptions& options, Projection projection);

/// options.settings with a background: the option's, else `scene` (from a Slicer scene; nullopt for
/// other inputs), else Background::standard. A limit of the denoised noise needs
/// ImageDenoiser::attach.
RenderSettings makeSettings(const RenderOptions& options, const std::optional<Background>& scene);

} // namespace fenestra::core
