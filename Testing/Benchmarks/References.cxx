#include "References.h"

#include "Modes.h"

#include "Oracle/Oracle.h"
#include "Statistical/EstimateImages.h"

#include "WriteResults.h"
#include "base/Error.h"
#include "base/Stopwatch.h"
#include "files/appearance/LightReader.h"
#include "files/images/ImageReader.h"
#include "image/Compare.h"
#include "io/EmbeddedResources.h"

#include <algorithm>
#include <optional>

namespace fenestra::core::benchmarks {
namespace {

/// First seed of references, above those of measured renders.
constexpr std::uint64_t firstReferenceSeed = std::uint64_t{1} << 40;

constexpr const char* colors[] = {"R", "G", "B"};

std::vector<float>& channel(Image& image, const std::string& name) {
  return image.channels.at(name);
}

/// Updates `mean`, of `parts` images with equal sample counts, by one more image.
void addPart(Image& mean, const Image& part, double parts) {
  for (const char* name : colors) {
    std::vector<float>& color = channel(mean, name);
    std::vector<float>& error = channel(mean, std::string("error.") + name);
    const std::vector<float>& other = *part.find(name);
    const std::vector<float>& otherError = *part.find(std::string("error.") + name);
    for (std::size_t i = 0; i < color.size(); ++i) {
      const auto mix = [&](double a, double b) { return (parts * a + b) / (parts + 1.0); };
      color[i] = static_cast<float>(mix(color[i], other[i]));
      error[i] = static_cast<float>(std::hypot(parts * error[i], otherError[i]) / (parts + 1.0));
    }
  }
}

/// Mean of independent images with equal sample counts and different seeds. Stops at the sample
/// count of `wanted`, or else at its noise target or time limit.
template <typename RenderPart>
Image accumulate(const ReferenceSettings& wanted, std::uint64_t samples, RenderPart&& renderPart) {
  const Stopwatch watch;
  Image mean = renderPart(firstReferenceSeed);
  mean.channels.erase("samples.N");
  const auto isEnough = [&](std::uint64_t parts) {
    if (wanted.samples > 0)
      return parts * samples >= wanted.samples;
    const bool isLate = watch.seconds() >= wanted.seconds;
    return isLate || Reference(mean, "").relMse <= wanted.noise * wanted.noise;
  };
  for (std::uint64_t parts = 1; !isEnough(parts); ++parts) {
    addPart(mean, renderPart(firstReferenceSeed + parts), static_cast<double>(parts));
  }
  return mean;
}

Image renderByFenestra(const PreparedScene& scene, RenderSettings settings,
                       const ReferenceSettings& wanted) {
  settings.samples = 16;
  return accumulate(wanted, settings.samples, [&](std::uint64_t seed) {
    settings.seed = seed;
    return toImage(findMode("product").render(scene.view(), settings), scene);
  });
}

/// Lights of a file or a built-in preset.
std::vector<Light> readPresetLights(const std::string& name) {
  const std::string_view preset = findResource("lights/" + name + ".json");
  return preset.empty() ? readLights(name) : parseLights(preset, name);
}

Image renderByOracle(const RenderOptions& options, const PreparedScene& scene,
                     const RenderSettings& settings, const ReferenceSettings& wanted) {
  const SceneView view = scene.view();
  if (!std::holds_alternative<ClipNone>(view.clip))
    throw inputError("scenes.txt", "requests an oracle reference for a clip; use product");
  const oracle::OracleScene subject{.volume = view.volume,
                                    .transfer = view.transfer,
                                    .lights = readPresetLights(options.scene.lightsName()),
                                    .pose = view.camera.pose(),
                                    .width = view.camera.width(),
                                    .height = view.camera.height(),
                                    .crop = view.crop ? std::optional(view.crop->boxToWorld)
                                                      : std::nullopt,
                                    .background = settings.path.background};
  constexpr std::uint64_t samples = 4;
  return accumulate(wanted, samples, [&](std::uint64_t seed) {
    return testing::toImage(oracle::render(subject, samples, seed));
  });
}

std::optional<Image> readIfExists(const std::filesystem::path& path) {
  if (path.empty() || !std::filesystem::exists(path))
    return std::nullopt;
  return readImage(path);
}

/// Reference of another renderer; empty if missing or of another size.
std::optional<Reference> findExternal(const SceneCase& sceneCase, const PreparedScene& scene) {
  if (sceneCase.source != ReferenceSource::external)
    return std::nullopt;
  const std::string file = sceneCase.external.string();
  std::optional<Image> image = readIfExists(file + "_best.exr");
  const std::optional<Image> errors = readIfExists(file + "_best_se.exr"); // standard errors
  if (!image || !errors || image->width != scene.camera().width() ||
      image->height != scene.camera().height())
    return std::nullopt;
  attachError(*image, *errors);
  return Reference(*std::move(image), "independent");
}

/// Identifies the request of a cached reference.
std::string makeCacheKey(const SceneCase& sceneCase, const PreparedScene& scene,
                         const ReferenceSettings& wanted) {
  std::string text = std::to_string(scene.camera().width()) + "x" +
                     std::to_string(scene.camera().height()) + " noise " +
                     std::to_string(wanted.noise);
  if (wanted.samples > 0)
    text += " samples " + std::to_string(wanted.samples);
  for (const std::string& argument : sceneCase.arguments)
    text += " " + argument;
  return text;
}

} // namespace

Reference::Reference(Image imageIn, std::string sourceIn)
    : image(std::move(imageIn)), source(std::move(sourceIn)) {
  constexpr double relMseEpsilon = 0.01; // as in Comparison::relMse
  double sum = 0.0;
  std::size_t count = 0;
  for (const char* name : colors) {
    const std::vector<float>& means = *image.find(name);
    const std::vector<float>& errors = *image.find(std::string("error.") + name);
    for (std::size_t i = 0; i < means.size(); ++i)
      sum += std::pow(errors[i], 2.0) / (std::pow(means[i], 2.0) + relMseEpsilon);
    count += means.size();
  }
  relMse = sum / static_cast<double>(count);
}

Reference getOrRenderReference(const SceneCase& sceneCase, const PreparedScene& scene,
                               const RenderSettings& settings, const ReferenceSettings& wanted) {
  if (std::optional<Reference> external = findExternal(sceneCase, scene))
    return *std::move(external);
  const std::string source = sceneCase.source == ReferenceSource::oracle ? "oracle" : "product";
  const std::filesystem::path path = wanted.folder / (sceneCase.name + ".exr");
  const std::string cacheKey = makeCacheKey(sceneCase, scene, wanted);
  if (std::optional<Image> cached = readIfExists(path))
    if (cached->header["command"] == cacheKey && cached->header["maker"] == source)
      return Reference(*std::move(cached), source);
  Image image = sceneCase.source == ReferenceSource::oracle
                    ? renderByOracle(sceneCase.options(), scene, settings, wanted)
                    : renderByFenestra(scene, settings, wanted);
  image.header["command"] = cacheKey;
  image.header["maker"] = source; // the renderer
  std::filesystem::create_directories(wanted.folder);
  writeImage(image, makeImagePlane(scene.camera()), path);
  return Reference(std::move(image), source);
}

Image toImage(const Film& film, const PreparedScene& scene) {
  return makeImage(film, scene.camera(), scene.clip(), {"color", "error", "samples"});
}

} // namespace fenestra::core::benchmarks
