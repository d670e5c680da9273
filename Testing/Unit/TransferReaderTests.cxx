// Transfer functions in Fenestra's format and Slicer's .vp and .vp.json; invalid files.

#include "files/appearance/TransferReader.h"

#include "Approx.h"
#include "Curves.h"
#include "Refusals.h"
#include "model/medium/Reflectance.h"

namespace fenestra::core::TransferReaderTests {
namespace {

TransferFunction parse(const std::string& json) {
  return parseTransferJson(json, "test").function;
}

TEST(TransferReader, ReadsFenestraJson) {
  const TransferFunction f = parse(
      R"({"extinction": [[100, 4], [0, 0]], "albedo": [[0, 0.1, 0.2, 0.3], [10, 0.5, 0.6, 1]],
          "g": -0.5, "shading": "hybrid"})");
  EXPECT_DOUBLE_EQ(f.extinction(25)[0], 1.0);
  EXPECT_DOUBLE_EQ(f.extinction(1000)[0], 4.0);
  EXPECT_TRUE(isApprox(f.albedo(5), Rgb(0.3, 0.4, 0.65)));
  EXPECT_EQ(f.g, -0.5);
  ASSERT_TRUE(f.shading);
  EXPECT_EQ(f.shading->gamma, 0.5);
  EXPECT_FALSE(f.gradientOpacity);
  const TransferFunction minimal = parse(R"({"extinction": [[0, 1]], "albedo": [[0, 1, 1, 1]]})");
  EXPECT_EQ(minimal.g, 0.0);
  EXPECT_FALSE(minimal.shading);
}

TEST(TransferReader, IslandsAreAVolume) {
  const std::string rest = R"("extinction": [[0, 1]], "albedo": [[0, 1, 1, 1]]})";
  EXPECT_EQ(parseTransferJson(R"({"islands": 400, )" + rest, "test").islands, 400.0);
  EXPECT_FALSE(parseTransferJson("{" + rest, "test").islands);
}

TEST(TransferReader, RelativeScalarsAreFractionsOfAScalarRange) {
  const std::string rest =
      R"("extinction": [[0.5, 0], [1, 4]], "albedo": [[0, 0, 0, 0], [1, 1, 1, 1]]})";
  const TransferFile relative = parseTransferJson(R"({"scalars": "relative", )" + rest, "test");
  ASSERT_EQ(relative.scalars, TransferFile::Scalars::relative);
  const TransferFunction f = relative.mapScalars(std::array{-100.0, 300.0});
  EXPECT_DOUBLE_EQ(f.extinction(100)[0], 0.0);
  EXPECT_DOUBLE_EQ(f.extinction(200)[0], 2.0);
  EXPECT_DOUBLE_EQ(f.extinction(300)[0], 4.0);
  EXPECT_NEAR(f.albedo(0)[1], 0.25, 1e-12);
  for (const std::string& start : {std::string(R"({"scalars": "absolute", )"), std::string("{")}) {
    const TransferFile absolute = parseTransferJson(start + rest, "test");
    EXPECT_EQ(absolute.scalars, TransferFile::Scalars::absolute);
  }
  const TemporaryFolder folder;
  const auto file = folder.write("relative.json", R"({"scalars": "relative", )" + rest);
  expectRefused(file, "invalid-field: scalars", [&] { readTransferFunction(file); });
  expectRefused("test", "invalid-field: scalars",
                [&] { parseTransferJson(R"({"scalars": "percent", )" + rest, "test"); });
}

TEST(TransferReader, ScalarsOfTissuesAreMappedPiecewiseLinearly) {
  const TransferFile file =
      parseTransferJson(R"({"scalars": "tissues", "extinction": [[-1, 0], [1, 1], [2.5, 2], [4, 3]],
                            "albedo": [[0, 1, 1, 1]]})",
                        "test");
  ASSERT_EQ(file.scalars, TransferFile::Scalars::tissues);
  const TransferFunction f = file.mapScalars(std::array{0.0, 40.0, 100.0, 140.0});
  const std::pair<double, double> knots[] = {{-40.0, 0.0}, {40.0, 1.0}, {120.0, 2.0}, {180.0, 3.0}};
  for (const auto& [scalar, extinction] : knots)
    EXPECT_DOUBLE_EQ(f.extinction(scalar)[0], extinction) << scalar;
}

TEST(TransferReader, ColorIsTheReflectedColor) {
  const std::string e = R"("extinction": [[0, 0], [100, 4]], "shading": "hybrid")";
  const TransferFunction f =
      parse("{" + e + R"(, "color": [[100, "#bcbcbc"], [0, "#000000"]], "g": 0.5})");
  const double gray = std::pow((188.0 / 255.0 + 0.055) / 1.055, 2.4);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(toReflectance(f.albedo(100)[c], 0.5), gray, 1e-6);
    EXPECT_NEAR(toReflectance(f.albedo(50)[c], 0.5), 0.5 * gray, 0.01);
    EXPECT_EQ(f.albedo(0)[c], 0.0);
  }
  ASSERT_TRUE(f.shading && f.shading->coated);
  EXPECT_EQ(f.shading->diffuse, 1.0);
  EXPECT_EQ(f.shading->specular, 0.2);
  EXPECT_NEAR(f.shading->power, 2.0 / 0.16 - 2.0, 1e-12);
  EXPECT_NEAR(f.shading->oddsFactor, 0.235, 1e-12);
  const TransferFunction glossy = parse("{" + e + R"(, "albedo": [[0, 0.5, 0.5, 0.5]],
      "specular": 0.5, "roughness": 0.1})");
  EXPECT_EQ(glossy.albedo(0)[0], 0.5) << "an albedo is used unchanged";
  ASSERT_TRUE(glossy.shading && glossy.shading->coated);
  EXPECT_EQ(glossy.shading->specular, 0.5);
  EXPECT_NEAR(glossy.shading->power, 198.0, 1e-9);
  const TransferFunction uncoated = parse("{" + e + R"(, "albedo": [[0, 0.5, 0.5, 0.5]]})");
  EXPECT_FALSE(uncoated.shading->coated);
  EXPECT_EQ(uncoated.shading->oddsFactor, 1.0);
}

void expectRefusal(const std::string& json, const std::string& text) {
  expectRefused("test", text, [&] { parseTransferJson(json, "test"); });
}

TEST(TransferReader, ErrorNamesTheInvalidField) {
  const std::string e = R"("extinction": [[0, 1], [5, 2]])", a = R"("albedo": [[0, 1, 1, 1]])";
  expectRefusal("{" + e + "}", "invalid-file | albedo | color");
  expectRefusal("{" + a + "}", "invalid-file | extinction");
  expectRefusal("{" + e + "," + a + R"(, "opacity": 1})", "invalid-file | opacity");
  expectRefusal("{" + e + "," + a + R"(, "new\nline": 1})", "invalid-file");
  expectRefusal("{" + e + "," + a + R"(, "g": 1})", "invalid-field: g");
  expectRefusal("{" + e + "," + a + R"(, "g": "x"})", "invalid-field: g");
  expectRefusal("{" + e + "," + a + R"(, "shading": "phong"})", "invalid-field: shading");
  expectRefusal("{" + a + R"(, "extinction": [[0, 1], [1, -2]]})", "invalid-field: extinction[1]");
  expectRefusal("{" + a + R"(, "extinction": [[0, 1], [1]]})", "invalid-field: extinction[1]");
  expectRefusal("{" + a + R"(, "extinction": []})", "invalid-field: extinction");
  expectRefusal("{" + a + R"(, "extinction": 3})", "invalid-field: extinction");
  expectRefusal("{" + a + R"(, "extinction": [[0, 1e40]]})", "invalid-field: extinction[0][1]");
  expectRefusal("{" + e + R"(, "albedo": [[0, 1, 1.5, 1]]})", "invalid-field: albedo[0]");
  expectRefusal("{" + e + "," + a + R"(, "color": [[0, "#ffffff"]]})", "invalid-field: color");
  for (const char* color :
       {"white", "#fff", "#12345", "#1234567", "#12345g", "# 12345", "12345678"})
    expectRefusal("{" + e + R"(, "color": [[0, ")" + color + R"("]]})",
                  "invalid-field: color[0][1]");
  expectRefusal("{" + e + R"(, "color": [[0, 1, 1, 1]]})", "invalid-field: color[0]");
  expectRefusal("{" + e + R"(, "color": []})", "invalid-field: color");
  expectRefusal("{" + e + "," + a + R"(, "specular": 0.2})", "invalid-field: specular");
  expectRefusal("{" + e + "," + a + R"(, "shading": "hybrid", "roughness": 0})",
                "invalid-field: roughness");
  expectRefusal("{" + e + "," + a + R"(, "shading": "hybrid", "specular": 1.5})",
                "invalid-field: specular");
  expectRefusal("{" + e + "," + a + R"(, "islands": -1})", "invalid-field: islands");
  expectRefusal("[]", "invalid-file");
  expectRefusal("", "damaged-file");
  expectRefusal("{\"extinction\": [[0,", "damaged-file");
  expectRefusal("{\"extinction\": 1e999}", "");
  expectRefusal("{\"extinction\": \"\xff\"}", "damaged-file");
  expectRefusal(std::string(1'000'000, '['), "limit-exceeded | 64");
  std::string many = "{\"extinction\": [0";
  for (int i = 0; i < 200'000; ++i)
    many += ",0";
  expectRefusal(many + "]}", "limit-exceeded | 200000");
  const TemporaryFolder folder;
  const auto large = folder.write("large.json", std::string((4 << 20) + 1, ' '));
  expectRefused(large, "limit-exceeded | 4 MB", [&large] { readTransferFile(large); });
}

/// Text of a .vp.json with additional members in its volume property and its component.
std::string makeSlicerJson(const std::string& property, const std::string& component) {
  return R"({"@schema": "x", "volumeProperties": [{"effectiveRange": [0, "bad"], )" + property +
         R"("components": [{)" + component + R"(
    "scalarOpacity": {"type": "piecewiseLinearFunction", "points": [
      {"x": 200, "y": 0.5, "midpoint": 0.5, "sharpness": 0},
      {"x": 0, "y": 0, "midpoint": 0.25, "sharpness": 0.5}]},
    "rgbTransferFunction": {"type": "colorTransferFunction", "points": [
      {"x": 0, "color": [1, 0.5, 0], "midpoint": 0.5, "sharpness": 0}]}}]}]})";
}

TEST(TransferReader, ReadsSlicerJson) {
  const TransferFunction f = parse(makeSlicerJson(R"("scatteringAnisotropy": 0.3, )",
                                                  R"("scalarOpacityUnitDistance": 2, "shade": true,
                "lighting": {"ambient": 0.1, "diffuse": 0.6, "specular": 0.3, "specularPower": 20},
                "gradientOpacity": {"points": [{"x": 0, "y": 0}, {"x": 10, "y": 1}]}, )"));
  const std::vector<OpacityNode> nodes = {{0, 0, 0.25, 0.5}, {200, 0.5}};
  for (const double x : {-10.0, 20.0, 50.0, 111.0, 199.0, 300.0}) {
    const double expected = -std::log1p(-interpolateCurve(nodes, x)) / 2.0;
    EXPECT_NEAR(f.extinction(x)[0], expected, 1e-4 * expected) << x;
  }
  EXPECT_TRUE(f.albedo(0) == decodeSrgb({1, 0.5, 0}));
  EXPECT_EQ(f.g, 0.3);
  ASSERT_TRUE(f.shading);
  EXPECT_EQ(f.shading->diffuse, 0.6);
  EXPECT_EQ(f.shading->specular, 0.3);
  EXPECT_EQ(f.shading->power, 20);
  ASSERT_TRUE(f.gradientOpacity);
  EXPECT_DOUBLE_EQ((*f.gradientOpacity)(5)[0], 0.5);
}

TEST(TransferReader, OmitsGradientOpacityWithoutEffect) {
  for (const char* component :
       {"", R"("gradientOpacity": {"points": [{"x": 0, "y": 1}, {"x": 9, "y": 1}]}, )",
        R"("disableGradientOpacity": true, "gradientOpacity": {"points": [{"x": 0, "y": 0}]}, )"})
    EXPECT_FALSE(parse(makeSlicerJson("", component)).gradientOpacity);
}

TEST(TransferReader, ClampsAnisotropyBelowOne) {
  EXPECT_EQ(parse(makeSlicerJson(R"("scatteringAnisotropy": 1, )", "")).g, 0.999);
  EXPECT_EQ(parse(makeSlicerJson(R"("scatteringAnisotropy": -1, )", "")).g, -0.999);
  expectRefusal(makeSlicerJson(R"("scatteringAnisotropy": 1.01, )", ""),
                "invalid-field: volumeProperties[0].scatteringAnisotropy");
}

TEST(TransferReader, RefusesDamagedSlicerJson) {
  expectRefusal(R"({"volumeProperties": []})", "invalid-field: volumeProperties");
  expectRefusal(R"({"volumeProperties": [{"components": [{}]}]})",
                "invalid-field: volumeProperties[0].components[0]");
  expectRefusal(makeSlicerJson("", R"("scalarOpacityUnitDistance": 0, )"),
                "invalid-field: scalarOpacityUnitDistance");
  expectRefusal(makeSlicerJson("", R"("shade": 1, )"), "invalid-field: shade");
  expectRefusal(makeSlicerJson("", R"("gradientOpacity": {"points": [{"x": 0, "y": 2}]}, )"),
                "invalid-field: gradientOpacity.points[0].y");
  expectRefusal(
      makeSlicerJson("", R"("gradientOpacity": {"points": [{"x": 0, "y": 1, "sharpness": 3}]}, )"),
      "invalid-field: gradient opacity, point 1");
}

const std::string propertyText = "1\r\n1\n0.42\n0.44\n0.46\n38.5\n"
                                 "8 -17 0 13 0.2 13 0.6 235 1\n"
                                 "4 -17 1 235 1\n"
                                 "8 -17 1 0 0.5 235 1 1 1\n";

TEST(TransferReader, ReadsSlicerText) {
  const TemporaryFolder folder;
  const TransferFunction f = readTransferFunction(folder.write("a.vp", propertyText));
  EXPECT_NEAR(f.extinction(-2)[0], -std::log1p(-0.1), 1e-4 * 0.1);
  EXPECT_DOUBLE_EQ(f.extinction(13)[0], -std::log1p(-0.6)); // two nodes at one position: a step
  EXPECT_NEAR(f.extinction(13 - 1e-9)[0], -std::log1p(-0.2), 1e-6);
  EXPECT_TRUE(isApprox(f.albedo(235), Rgb(1, 1, 1)));
  EXPECT_FALSE(f.gradientOpacity);
  ASSERT_TRUE(f.shading);
  EXPECT_EQ(f.shading->diffuse, 0.42);
  EXPECT_EQ(f.shading->specular, 0.46);
  EXPECT_EQ(f.shading->power, 38.5);
}

TEST(TransferReader, RefusesDamagedSlicerText) {
  const TemporaryFolder folder;
  const auto refuse = [&folder](const std::string& from, const std::string& to,
                                const std::string& text) {
    std::string content = propertyText;
    content.replace(content.find(from), from.size(), to);
    const auto path = folder.write("a.vp", content);
    expectRefused(path, text, [&path] { readTransferFunction(path); });
  };
  refuse("8 -17 0", "6 -17 0", "invalid-field: line 7 (scalarOpacity)");
  refuse("8 -17 0", "1e9 -17 0", "invalid-field: line 7 (scalarOpacity)");
  refuse("8 -17 0", "8 -17 nan", "invalid-field: line 7 (scalarOpacity)");
  refuse("8 -17 0", "8 -17 O", "invalid-field: line 7 (scalarOpacity)");
  refuse("8 -17 0 13", "8 -17 7 13", "invalid-field: scalar opacity, point 1");
  refuse("0.44\n", "\n", "invalid-field: line 4 (ambient)");
  refuse("8 -17 1 0 0.5 235 1 1 1\n", "", "invalid-field: line 9 (colorTransfer)");
  refuse("8 -17 1 0 0.5 235 1 1 1\n", "0\n", "invalid-field: color");
}

TEST(TransferReader, RefusesUnknownAndMissingFilesAndFolders) {
  const TemporaryFolder folder;
  expectRefused(folder / "x.txt", "unsupported-file",
                [&] { readTransferFunction(folder / "x.txt"); });
  expectRefused(folder / "x.vp", "missing-file", [&] { readTransferFunction(folder / "x.vp"); });
  std::filesystem::create_directory(folder / "d.json");
  expectRefused(folder / "d.json", "not-a-file", [&] { readTransferFunction(folder / "d.json"); });
}

TEST(TransferReader, ReadsRealVolumeProperties) {
  const std::filesystem::path root = std::filesystem::path(FENESTRA_DATA) / "slicer_scenes";
  if (!std::filesystem::exists(root))
    GTEST_SKIP() << "no test data at " << FENESTRA_DATA;
  int read = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root)) {
    const std::string name = entry.path().filename().string();
    if (!name.ends_with(".vp") && !name.ends_with(".vp.json"))
      continue;
    EXPECT_NO_THROW(readTransferFunction(entry.path())) << name;
    ++read;
  }
  EXPECT_GE(read, 4);
}

TEST(TransferReader, ReadsTransferFunctionsOfTheReferenceImages) {
  const std::filesystem::path root(FENESTRA_REFERENCE);
  if (!std::filesystem::exists(root / "S1.transfer.json"))
    GTEST_SKIP() << "no reference images at " << FENESTRA_REFERENCE;
  for (const char* name : {"S1", "S2", "S2hi", "S3het"})
    EXPECT_NO_THROW(readTransferFunction(root / (std::string(name) + ".transfer.json"))) << name;
}

} // namespace
} // namespace fenestra::core::TransferReaderTests
