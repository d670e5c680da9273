// Lights from JSON, environment maps from EXR, and invalid input.

#include "Approx.h"
#include "WriteResults.h"
#include "files/appearance/LightReader.h"
#include "io/EmbeddedResources.h"
#include "model/lights/LightSet.h"
#include "model/medium/ContextStyle.h"

#include "Refusals.h"

namespace fenestra::core::LightReaderTests {
namespace {

TEST(LightReader, ReadsEveryKind) {
  const auto lights = parseLights(R"({"lights": [
    {"type": "environment", "radiance": [1, 2, 3]},
    {"type": "directional", "direction": [0, 0, -4], "irradiance": [3, 2, 1]},
    {"type": "rectangle", "center": [1, 2, 3], "normal": [0, 3, 0], "up": [0, 0, 2],
     "size": [4, 5], "radiance": [6, 7, 8], "frame": "camera"},
    {"type": "disk", "center": [1, 2, 3], "normal": [3, 0, 4], "size": 9, "radiance": [1, 1, 1]},
    {"type": "disk", "center": [0, 0, 0], "normal": [0, 0, 1], "size": [2, 2],
     "radiance": [0, 0, 0], "frame": "world"}]})",
                                  "test");
  ASSERT_EQ(lights.size(), 5u);
  EXPECT_TRUE(std::get<EnvironmentLight>(lights[0]).radiance == Rgb(1, 2, 3));
  EXPECT_EQ(std::get<DirectionalLight>(lights[1]).direction, Vec3(0, 0, -1));
  EXPECT_TRUE(std::get<DirectionalLight>(lights[1]).irradiance == Rgb(3, 2, 1));
  const auto& rectangle = std::get<AreaLight>(lights[2]);
  EXPECT_EQ(rectangle.shape, AreaLight::Shape::rectangle);
  EXPECT_EQ(rectangle.center, Vec3(1, 2, 3));
  EXPECT_EQ(rectangle.normal, Vec3(0, 1, 0));
  EXPECT_EQ(rectangle.up, Vec3(0, 0, 1));
  EXPECT_EQ(rectangle.size, Vec2(4, 5));
  EXPECT_EQ(rectangle.frame, LightFrame::camera);
  const auto& disk = std::get<AreaLight>(lights[3]);
  EXPECT_EQ(disk.shape, AreaLight::Shape::disk);
  EXPECT_TRUE(isApprox(disk.normal, Vec3(0.6, 0, 0.8)));
  EXPECT_EQ(disk.size, Vec2(9, 9));
  EXPECT_EQ(disk.frame, LightFrame::world);
}

TEST(LightReader, ReadsASky) {
  const auto lights = parseLights(R"({"lights": [
    {"type": "sky", "top": [1, 2, 3], "middle": [4, 5, 6], "bottom": [0, 0, 0]},
    {"type": "sky", "top": [1, 2, 3], "middle": [4, 5, 6], "bottom": [0, 0, 0], "frame": "world"},
    {"type": "sky", "top": [1, 2, 3], "middle": [4, 5, 6], "bottom": [0, 0, 0], "up": [0, 0, 9]}
    ]})",
                                  "test");
  ASSERT_EQ(lights.size(), 3u);
  const auto sky = [&](std::size_t i) { return std::get<SkyLight>(lights[i]); };
  EXPECT_TRUE(sky(0).top == Rgb(1, 2, 3));
  EXPECT_TRUE(sky(0).middle == Rgb(4, 5, 6));
  EXPECT_TRUE(sky(0).bottom == Rgb(0, 0, 0));
  EXPECT_EQ(sky(0).frame, LightFrame::camera);
  EXPECT_EQ(sky(0).up, Vec3(0, 1, 0));
  EXPECT_EQ(sky(1).frame, LightFrame::world);
  EXPECT_EQ(sky(1).up, Vec3(0, 0, 1)) << "superior";
  EXPECT_EQ(sky(2).up, Vec3(0, 0, 1));
}

TEST(LightReader, ReadsASphere) {
  const auto lights = parseLights(R"({"lights": [
    {"type": "sphere", "center": [1, 2, 3], "diameter": 4, "radiance": [5, 6, 7]},
    {"type": "sphere", "center": [1, 2, 3], "diameter": 4, "radiance": [5, 6, 7],
     "frame": "focus"},
    {"type": "disk", "center": [0, 0, 0], "normal": [0, 0, 1], "size": 2, "radiance": [0, 0, 0],
     "frame": "focus"}]})",
                                  "test");
  const auto& sphere = std::get<SphereLight>(lights.at(0));
  EXPECT_EQ(sphere.center, Vec3(1, 2, 3));
  EXPECT_EQ(sphere.diameter, 4.0);
  EXPECT_TRUE(sphere.radiance == Rgb(5, 6, 7));
  EXPECT_EQ(sphere.frame, LightFrame::world);
  EXPECT_EQ(std::get<SphereLight>(lights.at(1)).frame, LightFrame::focus);
  EXPECT_EQ(std::get<AreaLight>(lights.at(2)).frame, LightFrame::focus);
}

TEST(LightReader, ColorIsThatOfAWhiteSurfaceInTheLight) {
  const auto lights = parseLights(R"({"lights": [
    {"type": "environment", "color": "#808080", "radiance": 0.5},
    {"type": "directional", "direction": [0, 0, 1], "color": "#FF0000", "irradiance": 3},
    {"type": "disk", "center": [0, 0, 0], "normal": [0, 0, 1], "size": 2, "color": "#d8a090",
     "radiance": 2},
    {"type": "rectangle", "center": [0, 0, 0], "normal": [0, 0, 1], "size": [2, 1],
     "color": "#d8a090", "radiance": 2},
    {"type": "sphere", "center": [0, 0, 0], "diameter": 2, "color": "#6c5048", "radiance": 2}]})",
                                  "test");
  const Rgb gray = std::get<EnvironmentLight>(lights.at(0)).radiance;
  EXPECT_LT((gray - 0.5).abs().maxCoeff(), 1e-15) << "luminance 0.5";
  const Rgb red = std::get<DirectionalLight>(lights.at(1)).irradiance;
  EXPECT_LT((red - Rgb(3.0 / 0.2126, 0.0, 0.0)).abs().maxCoeff(), 1e-12);
  const Rgb linear(0.686685312, 0.351532600, 0.278894261); // of 216, 160, 144 by IEC 61966-2-1
  const Rgb disk = std::get<AreaLight>(lights.at(2)).radiance;
  EXPECT_NEAR(luminance(disk), 2.0, 1e-12);
  EXPECT_LT((disk / disk[0] - linear / linear[0]).abs().maxCoeff(), 1e-8);
  EXPECT_TRUE(std::get<AreaLight>(lights.at(3)).radiance == disk);
  EXPECT_NEAR(luminance(std::get<SphereLight>(lights.at(4)).radiance), 2.0, 1e-12);
}

TEST(LightReader, RejectsInvalidColors) {
  const auto refuse = [](const std::string& color, const std::string& radiance,
                         const std::string& text) {
    const std::string json = R"({"lights": [{"type": "environment", "color": )" + color +
                             R"(, "radiance": )" + radiance + "}]}";
    expectRefused("test", "invalid-field: lights[0]." + text, [&] { parseLights(json, "test"); });
  };
  for (const char* color : {"1", "null", "\"\"", "\"d8a090\"", "\"#d8a09\"", "\"#d8a0900\"",
                            "\"#d8a09g\"", "\"# d8a09\"", "\"#-8a090\"", "\"red\"", "[1, 1, 1]"})
    refuse(color, "1", "color");
  refuse("\"#000000\"", "1", "color");
  refuse("\"#d8a090\"", "[1, 1, 1]", "radiance");
  refuse("\"#d8a090\"", "-1", "radiance");
  expectRefused("test", "invalid-field: lights[0] | radiance", [] {
    parseLights(R"({"lights": [{"type": "environment", "color": "#ffffff"}]})", "test");
  });
}

TEST(LightReader, ErrorNamesTheField) {
  const auto refuse = [](const std::string& light, const std::string& text) {
    const std::string json =
        R"({"lights": [{"type": "environment", "radiance": [1, 1, 1]}, )" + light + "]}";
    expectRefused("test", text, [&] { parseLights(json, "test"); });
  };
  refuse(R"({"type": "spot"})", "invalid-field: lights[1].type");
  refuse(R"({"radiance": [1, 1, 1]})", "invalid-field: lights[1] | type");
  refuse("3", "invalid-field: lights[1]");
  refuse(R"({"type": "environment"})", "invalid-field: lights[1] | radiance");
  refuse(R"({"type": "environment", "radiance": [1, 1]})", "invalid-field: lights[1].radiance");
  refuse(R"({"type": "environment", "radiance": [1, -1, 1]})",
         "invalid-field: lights[1].radiance[1]");
  refuse(R"({"type": "environment", "radiance": [1, 1, 1e35]})",
         "invalid-field: lights[1].radiance[2]");
  refuse(R"({"type": "environment", "radiance": 1})", "invalid-field: lights[1].radiance");
  refuse(R"({"type": "environment", "colors": 1})", "invalid-field: lights[1] | colors");
  refuse(R"({"type": "directional", "direction": [0, 0, 0], "irradiance": [1, 1, 1]})",
         "invalid-field: lights[1].direction");
  const std::string area = R"("center": [0, 0, 0], "radiance": [1, 1, 1], )";
  refuse(R"({"type": "disk", )" + area + R"("normal": [0, 0, 0], "size": 1})",
         "invalid-field: lights[1].normal");
  refuse(R"({"type": "disk", )" + area + R"("normal": [0, 0, 1], "size": 0})",
         "invalid-field: lights[1].size");
  refuse(R"({"type": "disk", )" + area + R"("normal": [0, 0, 1], "size": [1, 2]})",
         "invalid-field: lights[1].size");
  refuse(R"({"type": "rectangle", )" + area + R"("normal": [0, 0, 1], "size": 1})",
         "invalid-field: lights[1].size");
  refuse(R"({"type": "rectangle", )" + area +
             R"("normal": [0, 0, 1], "size": [1, 1], "frame": "eye"})",
         "invalid-field: lights[1].frame");
  refuse(R"({"type": "sky", "top": [1, 1, 1], "middle": [1, 1, 1]})",
         "invalid-field: lights[1] | bottom");
  refuse(R"({"type": "sky", "top": [1, 1, 1], "middle": [1, 1, 1], "bottom": [1, 1, 1],
             "up": [0, 0, 0]})",
         "invalid-field: lights[1].up");
  refuse(R"({"type": "sky", "top": [1, 1, 1], "middle": [1, 1, 1], "bottom": [1, 1, 1],
             "frame": "focus"})",
         "invalid-field: lights[1].frame");
  refuse(R"({"type": "sphere", "center": [0, 0, 0], "diameter": 0, "radiance": [1, 1, 1]})",
         "invalid-field: lights[1].diameter");
  refuse(R"({"type": "sphere", "center": [0, 0, 0], "radiance": [1, 1, 1]})",
         "invalid-field: lights[1] | diameter");
  refuse(R"({"type": "environment", "file": "a\nb.exr"})", "invalid-field: lights[1].file");
  expectRefused("test", "invalid-file | lights", [] { parseLights("{}", "test"); });
  expectRefused("test", "invalid-file | \"light\"",
                [] { parseLights(R"({"lights": [], "light": 1})", "test"); });
}

Image makeSky(float value = 0.5f) {
  Image image{.width = 4, .height = 2, .channels = {}, .header = {}};
  for (const char* name : {"R", "G", "B"})
    image.channels[name].assign(8, 0.25f);
  image.channels["G"][6] = value;
  return image;
}

TEST(LightReader, ReadsEnvironmentMapRelativeToItsFile) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "maps");
  writeImage(makeSky(), {}, folder / "maps/sky.exr");
  const auto path = folder.write(
      "lights.json",
      R"({"lights": [{"type": "environment", "file": "maps/sky.exr", "radiance": [2, 2, 2]}]})");
  const auto lights = readLights(path);
  const auto& light = std::get<EnvironmentLight>(lights.at(0));
  EXPECT_EQ(light.map.width, 4);
  EXPECT_EQ(light.map.height, 2);
  ASSERT_EQ(light.map.rgb.size(), 24u);
  EXPECT_EQ(light.map.rgb[3 * 6 + 0], 0.25f);
  EXPECT_EQ(light.map.rgb[3 * 6 + 1], 0.5f);
  EXPECT_EQ(light.radiance[0], 2.0);
}

TEST(LightReader, RejectsInvalidEnvironmentMaps) {
  const TemporaryFolder folder;
  const auto path = folder / "sky.exr";
  const auto refuse = [&path](const std::string& text) {
    expectRefused(path, text, [&path] { readEnvironmentMap(path); });
  };
  refuse("missing-file");
  for (const float value : {-0.1f, std::nanf(""), std::numeric_limits<float>::infinity(), 3e38f}) {
    writeImage(makeSky(value), {}, path);
    refuse("invalid-file | G | 2, 1");
  }
  folder.write("sky.exr", "v/1\x01 nothing");
  refuse("damaged-file");
  expectRefused(folder / "sky.png", "unsupported-file",
                [&] { readEnvironmentMap(folder / "sky.png"); });
}

TEST(LightReader, ReadsEveryPreset) {
  const auto names = listResources("lights/");
  EXPECT_FALSE(names.empty());
  for (const std::string& name : names)
    EXPECT_NO_THROW(parseLights(findResource(name), name)) << name;
}

/// Irradiance over pi of an area light on a plane that faces it, at the center of the volume.
double measureIrradiance(const Light& light) {
  const Grid grid({10, 10, 10}, Affine::Identity());
  const LightSet set({light}, grid, Camera({}, 8, 8));
  double sum = 0.0;
  constexpr int n = 64; // n x n points on the light
  for (int k = 0; k < n * n; ++k) {
    const Vec2 u((k % n + 0.5) / n, (k / n + 0.5) / n);
    const auto sample = set.sample(grid.worldCenter(), 0.0, u);
    const double cosine = -set.tables().areas.at(0).normal.dot(sample->direction);
    sum += luminance(sample->radiance) * cosine / (sample->pdf * pi * n * n);
  }
  return sum;
}

TEST(LightReader, KeyLightOfCinemaIsAboutFourTimesItsFillAndSkyTogether) {
  const auto lights = parseLights(findResource("lights/cinema.json"), "cinema");
  ASSERT_EQ(lights.size(), 4u);
  EXPECT_NEAR(measureIrradiance(lights[0]), 1.48, 0.01);
  EXPECT_NEAR(measureIrradiance(lights[1]), 0.17, 0.003);
  const auto& sky = std::get<SkyLight>(lights[3]);
  EXPECT_NEAR(luminance((sky.top + 2.0 * sky.middle + sky.bottom) / 4.0), 0.17, 0.003) << "mean";
}

/// With more light from the small lamps, highlights cover over 4 % of smooth organs (A6).
TEST(LightReader, HighlightLampsOfTheatreWetAreWeakerThanItsKeyLight) {
  const auto lights = parseLights(findResource("lights/theatre-wet.json"), "theatre-wet");
  ASSERT_EQ(lights.size(), 6u);
  const double key = measureIrradiance(lights[0]);
  const double lamps = measureIrradiance(lights[2]) + measureIrradiance(lights[3]);
  EXPECT_GT(lamps, 0.8 * key);
  EXPECT_LT(lamps, 0.9 * key);
}

TEST(LightReader, ReadsLightsOfTheReference) {
  const std::filesystem::path root(FENESTRA_REFERENCE);
  if (!std::filesystem::exists(root / "S2.lights.json"))
    GTEST_SKIP() << "no references at " << FENESTRA_REFERENCE;
  EXPECT_EQ(readLights(root / "S1.lights.json").size(), 1u);
  EXPECT_EQ(readLights(root / "S2.lights.json").size(), 2u);
}

} // namespace
} // namespace fenestra::core::LightReaderTests
