// The scenes of ../shared/reference against pictures that independent renderers converged, through
// the product's own command line.

#include "Support.h"

#include "cli/CommandLine.h"
#include "cli/RenderFlags.h"
#include "film/Compare.h"
#include "io/pictures/ImageReader.h"
#include "io/pictures/ImageWriter.h"
#include "scene/Scene.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace fenestra::testing {
namespace {

struct ReferenceCase {
  const char* name;
  std::uint64_t samples;
};

/// Renders NAME.arguments, one argument a line, as `fenestra` would from that folder.
Image renderReference(const ReferenceCase& c) {
  std::filesystem::current_path(FENESTRA_REFERENCE);
  std::vector<std::string> words = {"fenestra"};
  std::ifstream file(std::string(c.name) + ".arguments");
  for (std::string line; std::getline(file, line);)
    if (!line.empty())
      words.push_back(line);
  words.insert(words.end(), {"--samples", std::to_string(c.samples), "--seed", "42"});
  std::vector<char*> argv;
  for (std::string& word : words)
    argv.push_back(word.data());

  const auto flags = parseCommandLine(renderSyntax, static_cast<int>(argv.size()), argv.data(), 1);
  const RenderOptions options = renderOptions(*flags);
  const Scene scene(options.scene);
  RenderMonitor monitor;
  const RenderResult result =
      render(scene.forRender(), settingsFor(options, scene.background()), monitor);
  return picture(result.film, scene.camera(), scene.clip(), options.layers);
}

bool present() {
  return std::filesystem::exists(std::string(FENESTRA_REFERENCE) + "/S1.arguments");
}

/// FENESTRA_LONG=1 in the environment asks for the long version: as many samples as single pixels
/// need.
bool longVersion() {
  return std::getenv("FENESTRA_LONG") != nullptr;
}

class Reference : public ::testing::TestWithParam<ReferenceCase> {};

TEST_P(Reference, AgreesWithinStatistics) {
  if (!present())
    GTEST_SKIP() << "no reference pictures at " << FENESTRA_REFERENCE;
  const std::string name = GetParam().name;
  const int tile = longVersion() ? 1 : 4;
  Image image = renderReference(GetParam());
  Image reference = readImage(name + "_best.exr");
  attachError(reference, readImage(name + "_best_se.exr"));
  // Near the thin shells of S2 a pixel's samples are so skewed that its z has mean 0 only from
  // thousands of samples on; a tile's has it from hundreds.
  image = tileMeans(image, tile);
  reference = tileMeans(reference, tile);
  const Comparison comparison = compareImages(image, reference);
  ASSERT_TRUE(comparison.z);
  // 65536 pixels or 4096 tiles, of which S2 fills three quarters: four standard errors of each.
  EXPECT_NEAR(comparison.z->mean, 0.0, tile > 1 ? 0.07 : 0.02);
  EXPECT_NEAR(comparison.z->deviation, 1.0, tile > 1 ? 0.05 : 0.03);
  EXPECT_LT(comparison.z->imageMean.abs().maxCoeff(), 3.0);
  if (HasFailure())
    writeImage(differenceImage(image, reference), {},
               std::filesystem::temp_directory_path() / (name + "-difference.png"), "Standard");
}

INSTANTIATE_TEST_SUITE_P(Scenes, Reference,
                         ::testing::Values(ReferenceCase{"S1", longVersion() ? 1024U : 128U},
                                           ReferenceCase{"S2", longVersion() ? 4096U : 192U}),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(ReferenceFurnace, S3hetIsOneEverywhere) {
  if (!present())
    GTEST_SKIP() << "no reference scenes at " << FENESTRA_REFERENCE;
  const Image image = renderReference({"S3het", 32});
  double mean = 0.0;
  double variance = 0.0;
  for (const char* channel : {"R", "G", "B"}) {
    const std::vector<float>& values = *image.find(channel);
    const std::vector<float>& errors = *image.find(std::string("error.") + channel);
    for (std::size_t i = 0; i < values.size(); ++i) {
      mean += static_cast<double>(values[i]);
      variance += 3.0 * std::pow(static_cast<double>(errors[i]), 2.0); // grey: channels are equal
    }
  }
  const double n = 3.0 * image.width * image.height;
  EXPECT_NEAR(mean / n, 1.0, 4.0 * std::sqrt(variance) / n);
  EXPECT_LT(std::sqrt(variance) / n, 0.001);
}

} // namespace
} // namespace fenestra::testing
