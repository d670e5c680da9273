// Compares scenes of ../shared/reference with converged images of independent renderers. Options
// are parsed like those of `fenestra render`.

#include "EstimateImages.h"
#include "Gpu/DeviceTesting.h"
#include "Gpu/Twin.h"
#include "Oracle/Oracle.h"
#include "RunSettings.h"
#include "Support.h"

#include "Agreement.h"
#include "WriteResults.h"
#include "files/appearance/LightReader.h"
#include "files/images/ImageReader.h"
#include "image/Compare.h"
#include "program/CommandLine.h"
#include "program/RenderOptions.h"
#include "scene/PreparedScene.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace fenestra::core::testing {
namespace {

struct ReferenceCase {
  const char* name;
  std::uint64_t samples;
  double noise = 0.0; ///< noise target; 0: none
};

/// Options of `fenestra` from NAME.arguments in the reference folder, one argument per line.
RenderOptions readArguments(const ReferenceCase& c) {
  std::filesystem::current_path(FENESTRA_REFERENCE);
  std::vector<std::string> arguments = {"fenestra"};
  std::ifstream file(std::string(c.name) + ".arguments");
  for (std::string line; std::getline(file, line);)
    if (!line.empty())
      arguments.push_back(line);
  arguments.insert(arguments.end(), {"--samples", std::to_string(c.samples), "--seed", "42",
                                     "--volume-smoothing", "off"});
  if (c.noise > 0.0)
    arguments.insert(arguments.end(),
                     {"--noise", std::to_string(c.noise), "--noise-target", "raw"});
  std::vector<char*> argv;
  for (std::string& argument : arguments)
    argv.push_back(argument.data());
  return makeRenderOptions(
      *parseCommandLine(renderSyntax, static_cast<int>(argv.size()), argv.data(), 1));
}

Image renderReference(const ReferenceCase& c) {
  const RenderOptions options = readArguments(c);
  const PreparedScene scene(options.scene);
  RenderMonitor monitor;
  const RenderResult result =
      render(scene.view(), makeSettings(options, scene.background()), monitor);
  return makeImage(result.film, scene.camera(), scene.clip(), options.layers);
}

oracle::Estimates renderOracle(const ReferenceCase& c) {
  const RenderOptions options = readArguments(c);
  const PreparedScene scene(options.scene);
  return oracle::render({.volume = scene.volume(),
                         .transfer = scene.transfer(),
                         .lights = readLights(options.scene.lightsName()),
                         .pose = scene.camera().pose(),
                         .width = scene.camera().width(),
                         .height = scene.camera().height(),
                         .background = *options.background},
                        c.samples, 43);
}

bool hasReferences() {
  return std::filesystem::exists(std::string(FENESTRA_REFERENCE) + "/S1.arguments");
}

/// Bounds on the distribution of z over tiles: four standard errors of each value, for S2, which
/// fills three quarters of its image.
struct Bounds {
  int tileSize; ///< side in pixels
  double mean, deviation;
};

void expectAgreement(const Image& image, const ReferenceCase& c, const Bounds& bounds) {
  const std::string name = c.name;
  Image reference = readImage(name + "_best.exr");
  attachError(reference, readImage(name + "_best_se.exr"));
  const Image tiles = computeTileMeans(image, bounds.tileSize);
  reference = computeTileMeans(reference, bounds.tileSize);
  const Comparison comparison = compareImages(tiles, reference);
  ASSERT_TRUE(comparison.z);
  EXPECT_NEAR(comparison.z->mean, 0.0, bounds.mean);
  EXPECT_NEAR(comparison.z->deviation, 1.0, bounds.deviation);
  EXPECT_LT(comparison.z->imageMean.abs().maxCoeff(), 3.0);
  if (::testing::Test::HasFailure())
    writeImage(differenceImage(tiles, reference), {},
               std::filesystem::temp_directory_path() / (name + "-difference.png"),
               {DisplayView::standard});
}

class Reference : public ::testing::TestWithParam<ReferenceCase> {};

TEST_P(Reference, ImageAgreesWithinErrors) {
  if (!hasReferences())
    GTEST_SKIP() << "no reference images at " << FENESTRA_REFERENCE;
  // Near the thin shells of S2, samples are very skewed: the mean of z reaches 0 after thousands of
  // samples for a pixel, and after hundreds for a tile.
  const Bounds bounds = slowdownFactor() > 1 ? Bounds{16, 0.3, 0.2}
                        : isLongRun()        ? Bounds{1, 0.02, 0.03}
                                             : Bounds{4, 0.07, 0.05};
  expectAgreement(renderReference(GetParam()), GetParam(), bounds);
}

std::uint64_t chooseSamples(std::uint64_t few, std::uint64_t many) {
  return slowdownFactor() > 1 ? 8 : isLongRun() ? many : few;
}

INSTANTIATE_TEST_SUITE_P(Scenes, Reference,
                         ::testing::Values(ReferenceCase{"S1", chooseSamples(128, 1024)},
                                           ReferenceCase{"S2", chooseSamples(192, 4096)}),
                         [](const auto& info) { return std::string(info.param.name); });

class NoiseTarget : public ::testing::TestWithParam<ReferenceCase> {};

TEST_P(NoiseTarget, TrueErrorIsWithinAFifthOfTheTarget) {
  if (!hasReferences())
    GTEST_SKIP() << "no reference images at " << FENESTRA_REFERENCE;
  const ReferenceCase& c = GetParam();
  Image reference = readImage(std::string(FENESTRA_REFERENCE) + "/" + c.name + "_best.exr");
  const Image image = renderReference(c);
  attachError(reference, readImage(std::string(c.name) + "_best_se.exr"));
  EXPECT_NEAR(std::sqrt(compareImages(image, reference).relMse), c.noise, 0.2 * c.noise);
}

INSTANTIATE_TEST_SUITE_P(Scenes, NoiseTarget,
                         ::testing::Values(ReferenceCase{"S1", 1U << 20, relaxError(0.1)},
                                           ReferenceCase{"S1", 1U << 20, relaxError(0.07)},
                                           ReferenceCase{"S2", 1U << 20, relaxError(0.05)}));

class OracleReference : public ::testing::TestWithParam<ReferenceCase> {};

TEST_P(OracleReference, ImageAgreesWithinErrors) {
  if (!hasReferences())
    GTEST_SKIP() << "no reference images at " << FENESTRA_REFERENCE;
  const Bounds bounds = isLongRun() ? Bounds{4, 0.07, 0.05} : Bounds{16, 0.3, 0.2};
  expectAgreement(toImage(renderOracle(GetParam())), GetParam(), bounds);
}

INSTANTIATE_TEST_SUITE_P(Scenes, OracleReference,
                         ::testing::Values(ReferenceCase{"S1", isLongRun() ? 128U : 4U},
                                           ReferenceCase{"S2", isLongRun() ? 128U : 4U}),
                         [](const auto& info) { return std::string(info.param.name); });

class TwinReference : public ::testing::TestWithParam<ReferenceCase> {};

TEST_P(TwinReference, ImageAgreesWithinErrors) {
  if (!hasReferences())
    GTEST_SKIP() << "no reference images at " << FENESTRA_REFERENCE;
  const ReferenceCase& c = GetParam();
  const RenderOptions options = readArguments(c);
  const PreparedScene scene(options.scene);
  RenderSettings settings = makeSettings(options, scene.background());
  settings.seed = 44;
  const Film film = twin::render(scene.view(), settings).film;
  expectAgreement(makeImage(film, scene.camera(), scene.clip(), options.layers), c,
                  isLongRun() ? Bounds{4, 0.07, 0.05} : Bounds{16, 0.3, 0.2});
}

INSTANTIATE_TEST_SUITE_P(Scenes, TwinReference,
                         ::testing::Values(ReferenceCase{"S1", isLongRun() ? 128U : 8U},
                                           ReferenceCase{"S2", isLongRun() ? 128U : 8U}));

class GpuReference : public ::testing::TestWithParam<ReferenceCase> {};

TEST_P(GpuReference, ImageAgreesWithinErrors) {
  if (!hasReferences())
    GTEST_SKIP() << "no reference images at " << FENESTRA_REFERENCE;
  if (const std::string obstacle = findDeviceObstacle(); !obstacle.empty())
    GTEST_SKIP() << obstacle;
  const ReferenceCase& c = GetParam();
  const RenderOptions options = readArguments(c);
  const PreparedScene scene(options.scene);
  RenderSettings settings = makeSettings(options, scene.background());
  settings.seed = 45;
  settings.integrator = Integrator::gpu;
  RenderMonitor monitor;
  const RenderResult result = render(scene.view(), settings, monitor);
  EXPECT_EQ(result.target, findDeviceTarget());
  expectAgreement(makeImage(result.film, scene.camera(), scene.clip(), options.layers), c,
                  isLongRun() ? Bounds{4, 0.07, 0.05} : Bounds{16, 0.3, 0.2});
}

INSTANTIATE_TEST_SUITE_P(Scenes, GpuReference,
                         ::testing::Values(ReferenceCase{"S1", isLongRun() ? 128U : 2U},
                                           ReferenceCase{"S2", isLongRun() ? 128U : 2U}));

/// Albedo 1 in an environment of 1: every path of the oracle returns 1.
TEST(OracleReferenceFurnace, EveryPixelOfS3hetIsOne) {
  if (!hasReferences())
    GTEST_SKIP() << "no reference scenes at " << FENESTRA_REFERENCE;
  for (const oracle::PixelEstimate& pixel : renderOracle({"S3het", 1}).pixels)
    ASSERT_NEAR(pixel.mean[1], 1.0, 1e-9);
}

TEST(ReferenceFurnace, MeanOfS3hetIsOne) {
  if (!hasReferences())
    GTEST_SKIP() << "no reference scenes at " << FENESTRA_REFERENCE;
  const Image image = renderReference({"S3het", scaleSamples(32U)});
  double mean = 0.0;
  double variance = 0.0;
  for (const char* channel : {"R", "G", "B"}) {
    const std::vector<float>& values = *image.find(channel);
    const std::vector<float>& errors = *image.find(std::string("error.") + channel);
    for (std::size_t i = 0; i < values.size(); ++i) {
      mean += static_cast<double>(values[i]);
      variance += 3.0 * std::pow(static_cast<double>(errors[i]), 2.0); // gray: channels are equal
    }
  }
  const double n = 3.0 * image.width * image.height;
  EXPECT_NEAR(mean / n, 1.0, 4.0 * std::sqrt(variance) / n);
  EXPECT_LT(std::sqrt(variance) / n, relaxError(0.001));
}

} // namespace
} // namespace fenestra::core::testing
