// Compares every case with its baseline, and checks that the comparison detects mutations.
#include "Cases.h"
#include "RunSettings.h"
#include "TemporaryFolder.h"
#include "WriteResults.h"
#include "files/images/ImageReader.h"
#include "image/Compare.h"

#include <gtest/gtest.h>

#include <functional>
#include <iostream>

namespace fenestra::core::testing {
namespace {

std::string describe(const Agreement& a) {
  std::ostringstream text;
  text << "probability " << a.probability() << " (pixels " << a.pixels << ", tiles " << a.tiles
       << ", mean " << a.mean << ")";
  return text.str();
}

std::filesystem::path makeResultFolder(const RegressionCase& c) {
  return std::filesystem::path(FENESTRA_REGRESSION_RESULTS) / c.name;
}

/// Writes images that show the differences; returns a text that names their folder.
std::string writeErrorImages(const Image& image, const Image& baseline,
                             const std::filesystem::path& folder) {
  const Image z = differenceImage(image, baseline);
  writeImage(image, {}, folder / "render.png");
  writeImage(baseline, {}, folder / "baseline.png");
  writeImage(z, {}, folder / "z.png", {DisplayView::standard});
  writeImage(z, {}, folder / "z.exr");
  return "see render.png, baseline.png, z.png and z.exr in " + folder.string();
}

class Regression : public ::testing::TestWithParam<RegressionCase> {};

TEST_P(Regression, AgreesWithItsBaseline) {
  const RegressionCase& c = GetParam();
  const std::filesystem::path folder = makeResultFolder(c);
  const Image image =
      renderCase(c, seedBase(), reduceSamples(c.samples), dataFolder(), folder / "render.exr");
  const Image baseline = readImage(baselinePath(c));
  const Agreement result = compareWithBaseline(image, baseline);
  std::cout << c.name << ": " << describe(result) << std::endl;
  EXPECT_TRUE(result.canBeNoise())
      << describe(result) << "; " << writeErrorImages(image, baseline, folder);
}

INSTANTIATE_TEST_SUITE_P(Cases, Regression, ::testing::ValuesIn(readCases()),
                         [](const auto& info) { return info.param.name; });

// ---- mutations

/// Replaces the first occurrence of a text in a file.
void replaceIn(const std::filesystem::path& path, const std::string& from, const std::string& to) {
  std::string bytes = readBytes(path);
  const std::size_t at = bytes.find(from);
  ASSERT_NE(at, std::string::npos) << from;
  bytes.replace(at, from.size(), to);
  std::ofstream(path, std::ios::binary) << bytes;
}

struct Mutation {
  std::string name;
  std::string caseName;
  /// Modifies a copy of Testing/Data, or the arguments.
  std::function<void(const std::filesystem::path& data, RegressionCase& c)> apply;
};

/// plain.nrrd and fog.nrrd have voxels of 1.6 mm, with centers from 19.2 mm to -19.2 mm along x and
/// y in LPS.
const std::vector<Mutation> mutations = {
    {"HalfVoxelShift", "plain",
     [](const auto& data, RegressionCase&) {
       replaceIn(data / "traps/plain.nrrd", "space origin: (19.200000000000003,",
                 "space origin: (18.400000000000002,");
     }},
    {"FlippedAxis", "plain",
     [](const auto& data, RegressionCase&) {
       replaceIn(data / "traps/plain.nrrd", "space directions: (-1.6000000000000001,",
                 "space directions: (1.6000000000000001,");
       replaceIn(data / "traps/plain.nrrd", "space origin: (19.200000000000003,",
                 "space origin: (-19.200000000000003,");
     }},
    {"SwappedChannels", "plain",
     [](const auto& data, RegressionCase&) {
       replaceIn(data / "traps/thin.json", "[140, 0.9, 0.2, 0.1]", "[140, 0.2, 0.9, 0.1]");
     }},
    {"ExtinctionPlus2Percent", "fog",
     [](const auto&, RegressionCase& c) {
       c.arguments.insert(c.arguments.end(), {"--density-scale", "1.02"});
     }},
    {"ExtinctionMinus2Percent", "fog",
     [](const auto&, RegressionCase& c) {
       c.arguments.insert(c.arguments.end(), {"--density-scale", "0.98"});
     }},
};

void PrintTo(const Mutation& mutation, std::ostream* out) {
  *out << "in " << mutation.caseName;
}

class RegressionMutation : public ::testing::TestWithParam<Mutation> {};

TEST_P(RegressionMutation, DiffersFromTheBaseline) {
  if (slowdownFactor() > 1)
    GTEST_SKIP() << "FENESTRA_BRIEF leaves too few samples";
  const std::vector<RegressionCase> cases = readCases();
  const auto it = std::find_if(cases.begin(), cases.end(), [](const RegressionCase& c) {
    return c.name == GetParam().caseName;
  });
  ASSERT_NE(it, cases.end());
  RegressionCase mutated = *it;
  const TemporaryFolder data;
  std::filesystem::copy(dataFolder() / "traps", data / "traps");
  GetParam().apply(data.path(), mutated);
  const Image image =
      renderCase(mutated, seedBase(), mutated.samples, data.path(), data / "results/render.exr");
  const Agreement result = compareWithBaseline(image, readImage(baselinePath(mutated)));
  std::cout << GetParam().name << ": " << describe(result) << std::endl;
  EXPECT_FALSE(result.canBeNoise()) << describe(result);
}

INSTANTIATE_TEST_SUITE_P(Mutations, RegressionMutation, ::testing::ValuesIn(mutations),
                         [](const auto& info) { return info.param.name; });

} // namespace
} // namespace fenestra::core::testing
