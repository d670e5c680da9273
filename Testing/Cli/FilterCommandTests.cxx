// Denoising on the command line: which images and channels are denoised, and how outputs report it.

#include "CommandTesting.h"

#include "files/images/ImageReader.h"

#include <nlohmann/json.hpp>

namespace fenestra::core::FilterCommandTests {
namespace {

/// Renders of the knee with 48x48 pixels.
class FilterCommand : public ::testing::Test {
protected:
  Outcome runKnee(const Arguments& arguments) const {
    const std::string input = (kneeFolder() / "knee" / "knee").string();
    Arguments all = {input + ".nrrd",    "--segmentation",   input + ".seg.nrrd",
                     "--focus",          "FemoralCartilage", "--transfer",
                     input + ".vp.json", "--size",           "48x48"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    return run(all, folder.path());
  }
  void render(const Arguments& arguments) const {
    const Outcome outcome = runKnee(arguments);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
  }
  nlohmann::json readStats() const { return nlohmann::json::parse(readBytes(folder / "s.json")); }

  TemporaryFolder folder;
};

std::set<std::string> channelNames(const Image& image) {
  std::set<std::string> names;
  for (const auto& [name, plane] : image.channels)
    names.insert(name);
  return names;
}

TEST_F(FilterCommand, RawChannelsKeepTheirBits) {
  const auto renderImage = [&](const std::string& denoise, const std::string& name) {
    render({"--samples", "4", "--denoise", denoise, "--output", name});
    return readImage(folder / name);
  };
  const Image off = renderImage("off", "off.exr"), on = renderImage("on", "on.exr");
  for (const auto& [name, plane] : off.channels)
    EXPECT_EQ(on.channels.at(name), plane) << name;
  EXPECT_GT(on.channels.size(), off.channels.size());
}

TEST_F(FilterCommand, OnAddsChannelsToTheRawOnes) {
  render({"--samples", "4", "--denoise", "on", "--output", "a.exr", "--output", "a.nrrd"});
  const Image image = readImage(folder / "a.exr");
  for (const char* name :
       {"R", "A", "Z", "denoised.R", "denoised.G", "denoised.B", "denoised.A", "denoised.error.R",
        "expected.albedo.R", "expected.normal.X", "expected.Z", "depth50"})
    EXPECT_TRUE(image.find(name)) << name;
  EXPECT_NE(image.header.at("filter").find("R, G, B and A are not denoised"), std::string::npos);
  EXPECT_EQ(listFiles(folder.path()), (std::set<std::string>{"a.exr", "a.nrrd", "a-Z.nrrd",
                                                             "a-denoised.nrrd", "a-depth50.nrrd"}));
  EXPECT_EQ(*readImage(folder / "a-denoised.nrrd").find("R"), *image.find("denoised.R"));
  EXPECT_EQ(*readImage(folder / "a.nrrd").find("R"), *image.find("R"));
}

TEST_F(FilterCommand, AutoDenoisesDisplayImagesAndRecordsIt) {
  const Arguments all = {"--samples", "2",        "--output", "a.png",        "--output",
                         "a.tif",     "--output", "a.exr",    "--stats-json", "s.json"};
  render(all);
  const std::string png = readBytes(folder / "a.png"), tiff = readBytes(folder / "a.tif");
  EXPECT_NE(png.find("denoised by local linear regression"), std::string::npos);
  EXPECT_NE(tiff.find("denoised by local linear regression"), std::string::npos);
  const Image exr = readImage(folder / "a.exr");
  EXPECT_FALSE(channelNames(exr).contains("denoised.R"));
  EXPECT_FALSE(exr.header.contains("filter"));
  EXPECT_GT(readStats()["noiseDenoised"], 0.0);
  EXPECT_LT(readStats()["noiseDenoised"], readStats()["noise"]);

  Arguments off = all;
  off.insert(off.end(), {"--denoise", "off"});
  render(off);
  EXPECT_EQ(readBytes(folder / "a.png").find("denoised by local linear regression"),
            std::string::npos);
  EXPECT_NE(readBytes(folder / "a.png"), png);
  EXPECT_FALSE(readStats().contains("noiseDenoised"));
  EXPECT_EQ(readStats()["seconds"]["features"], 0.0);
}

TEST_F(FilterCommand, OneSampleIsDenoisedWithoutAnErrorEstimate) {
  render({"--samples", "1", "--denoise", "on", "--output", "a.exr", "--stats-json", "s.json"});
  const Image image = readImage(folder / "a.exr");
  EXPECT_TRUE(image.find("denoised.R"));
  EXPECT_FALSE(image.find("denoised.error.R"));
  EXPECT_TRUE(readStats()["noiseDenoised"].is_null());
}

TEST_F(FilterCommand, NoiseLimitsTheDenoisedNoiseIfAllOutputsAreDisplayImages) {
  const Arguments noise = {"--noise", "0.15", "--stats-json", "s.json", "--output", "a.png"};
  render(noise);
  const std::uint64_t few = readStats()["samplesPerPixel"]["max"];
  EXPECT_EQ(readStats()["samplesPerPixel"]["min"], few);
  EXPECT_TRUE(few == 4 || few == 8 || few == 16) << few;
  EXPECT_LE(readStats()["noiseDenoised"], 0.15);
  EXPECT_GT(readStats()["noise"], 0.15);

  Arguments raw = noise;
  raw.insert(raw.end(), {"--output", "a.exr"});
  render(raw);
  EXPECT_LE(readStats()["noise"], 0.15);
  Arguments filtered = raw;
  filtered.insert(filtered.end(), {"--noise-target", "denoised"});
  render(filtered);
  EXPECT_EQ(readStats()["samplesPerPixel"]["max"], few);
}

TEST_F(FilterCommand, ResultDoesNotDependOnTheThreads) {
  std::set<std::string> images;
  for (const char* threads : {"1", "2", "7"}) {
    render({"--samples", "2", "--denoise", "on", "--output", "a.exr", "--threads", threads});
    Image image = readImage(folder / "a.exr");
    std::string bytes;
    for (const auto& [name, plane] : image.channels)
      bytes.append(reinterpret_cast<const char*>(plane.data()), plane.size() * sizeof(float));
    images.insert(bytes);
  }
  EXPECT_EQ(images.size(), 1U);
}

TEST_F(FilterCommand, ContradictionsAreRejected) {
  const auto expectUsageError = [&](const Arguments& arguments, const std::string& hint) {
    const Outcome outcome = runKnee(arguments);
    EXPECT_EQ(outcome.status, 2);
    EXPECT_NE(outcome.err.find(hint), std::string::npos) << outcome.err;
  };
  expectUsageError({"--noise", "0.1", "--noise-target", "denoised", "--denoise", "off"},
                   "--denoise on");
  expectUsageError({"--noise", "0.1", "--noise-target", "filtered", "--output", "a.exr"},
                   "--denoise on");
  expectUsageError({"--noise-target", "raw"}, "--noise E");
  expectUsageError({"--layers", "denoised,color", "--output", "a.exr"}, "--denoise on");
  expectUsageError({"--layers", "color", "--denoise", "on", "--output", "a.exr"}, "--layers");
}

} // namespace
} // namespace fenestra::core::FilterCommandTests
