// Slicer scenes on the command line. The image of a solid box must match the outline that this file
// computes independently: from the scene's numbers, by VTK's camera conventions.

#include "CommandTesting.h"
#include "files/images/ImageReader.h"

#include <Eigen/Geometry>
#include <zip.h>

#include <cmath>
#include <numbers>
#include <sstream>

namespace fenestra::core::ScenesCommandTests {
namespace {

using Vector = Eigen::Vector3d;
using Map = Eigen::Affine3d;

struct ViewNumbers {
  Vector position, focalPoint, viewUp;
  bool parallel;
  double parallelScale, viewAngle;
};

/// Boxes as maps from [-1, 1]^3 to world space; their intersection is visible.
using Boxes = std::vector<Map>;

bool intersects(const Vector& origin, const Vector& direction, const Boxes& boxes) {
  double from = 0.0;
  double to = 1e9;
  for (const Map& box : boxes) {
    const Vector o = box.inverse() * origin;
    const Vector d = box.inverse().linear() * direction;
    for (int axis = 0; axis < 3; ++axis) {
      const double a = (-1.0 - o[axis]) / d[axis];
      const double b = (1.0 - o[axis]) / d[axis];
      from = std::max(from, std::min(a, b));
      to = std::min(to, std::max(a, b));
    }
  }
  return from < to;
}

/// True if the ray through a raster position (pixels from the upper left) hits the boxes.
bool isCovered(const ViewNumbers& view, const Boxes& boxes, int size, double column, double row) {
  const Vector forward = (view.focalPoint - view.position).normalized();
  const Vector right = forward.cross(view.viewUp).normalized();
  const Vector up = right.cross(forward);
  const double half =
      view.parallel ? view.parallelScale : std::tan(view.viewAngle * std::numbers::pi / 360.0);
  const Vector offset =
      half * ((2.0 * column / size - 1.0) * right + (1.0 - 2.0 * row / size) * up);
  return view.parallel ? intersects(view.position + offset, forward, boxes)
                       : intersects(view.position, forward + offset, boxes);
}

constexpr int size = 96;

/// Renders the scene with an opaque transfer function. Expects alpha 0 or 1 as in the outline of
/// the boxes, except in pixels that an edge crosses.
void expectOutline(const TemporaryFolder& folder, const std::string& scene,
                   const Arguments& arguments, const ViewNumbers& view, const Boxes& boxes) {
  folder.write("solid.json", R"({"extinction": [[0, 1000]], "albedo": [[0, 0.5, 0.5, 0.5]]})");
  Arguments all = {scene,
                   "--transfer",
                   "solid.json",
                   "--background",
                   "transparent",
                   "--size",
                   std::to_string(size) + "x" + std::to_string(size),
                   "--samples",
                   "4",
                   "--bounces",
                   "0",
                   "--output",
                   "solid.exr"};
  all.insert(all.end(), arguments.begin(), arguments.end());
  const Outcome outcome = run(all, folder.path());
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const Image image = readImage(folder / "solid.exr");
  const std::vector<float>& alpha = *image.find("A");
  int inside = 0;
  int edges = 0;
  int wrong = 0;
  for (int row = 0; row < size; ++row)
    for (int column = 0; column < size; ++column) {
      const bool covered = isCovered(view, boxes, size, column + 0.5, row + 0.5);
      bool uniform = true;
      for (const double x : {0.0, 0.5, 1.0})
        for (const double y : {0.0, 0.5, 1.0})
          uniform = uniform && isCovered(view, boxes, size, column + x, row + y) == covered;
      inside += covered;
      edges += !uniform;
      const auto pixel = static_cast<std::size_t>(row * size + column);
      wrong += uniform && alpha[pixel] != (covered ? 1.0F : 0.0F);
    }
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(inside, size * size / 20); // the boxes are visible, and their outline is in view
  EXPECT_GT(edges, 10);
}

// ---- a scene with all kinds of nodes

Map makeMap(std::initializer_list<double> rows) {
  Map map;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column)
      map(row, column) = std::data(rows)[4 * row + column];
  return map;
}

/// The 16 matrix elements in row-major order.
std::string formatMatrix(const Map& map) {
  std::ostringstream text;
  text.precision(17);
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      text << map.matrix()(row, column) << ' ';
  return text.str();
}

/// Map from [-1, 1]^3 onto the 4x4x4 volume of NrrdText, in RAS.
Map makeVolumeCube() {
  return makeMap({-2, 0, 0, -1.5, 0, -2, 0, -1.5, 0, 0, 2, 1.5});
}

class ScenesCommand : public SmallScene {
protected:
  ScenesCommand() {
    outer = Eigen::Translation3d(3, -2, 1) * Eigen::AngleAxisd(0.5, Vector(1, 2, 3).normalized());
    inner = Eigen::AngleAxisd(-0.8, Vector::UnitY()) * Eigen::Scaling(1.5, 1.0, 0.75);
    roi = Eigen::Translation3d(2.5, -3.0, 2.0) * Eigen::AngleAxisd(0.4, Vector::UnitX()) *
          Eigen::Scaling(1.8, 1.1, 1.3);
    std::ostringstream json;
    json.precision(17);
    const Eigen::Matrix3d axes = roi.linear() * Vector(1 / 1.8, 1 / 1.1, 1 / 1.3).asDiagonal();
    json << R"({"markups": [{"type": "ROI", "coordinateSystem": "RAS", "center": [2.5, -3, 2],)"
         << R"("size": [3.6, 2.2, 2.6], "orientation": [)";
    for (int i = 0; i < 9; ++i)
      json << (i > 0 ? ", " : "") << axes(i / 3, i % 3);
    json << "]}]}";
    folder.write("R O I.mrk.json", json.str());
  }

  std::string makeScene(const std::string& camera, bool cropping) const {
    return R"(<?xml version="1.0" encoding="UTF-8"?><MRML version="Slicer 5.6.2 32448">
      <LinearTransform id="outer" matrixTransformToParent=")" +
           formatMatrix(outer) + R"("/>
      <LinearTransform id="inner" references="transform:outer;" matrixTransformToParent=")" +
           formatMatrix(inner) + R"("/>
      <Volume id="v" name="ramp" references="display:d;storage:vs;transform:inner;"/>
      <VolumeArchetypeStorage id="vs" fileName="volume.nrrd"/>
      <GPURayCastVolumeRendering id="d" croppingEnabled=")" +
           (cropping ? "1" : "0") +
           R"(" references="roi:r;volumeProperty:p;"/>
      <VolumeProperty id="p" name="warm and cold" scalarOpacity="4 0 0 20 0.9" colorTransfer="8 0 1 0 0 20 0 0 1"/>
      <MarkupsROI id="r" references="storage:rs;"/>
      <MarkupsROIJsonStorage id="rs" fileName="R%20O%20I.mrk.json"/>
      <Segmentation id="s" name="parts" references="storage:ss;transform:inner;"/>
      <SegmentationStorage id="ss" fileName="segments.seg.nrrd"/>
      <View id="w" layoutName="1" singletonTag="1" backgroundColor="0.2 0.4 0.6"
        backgroundColor2="0.2 0.4 0.6"/>
      <Camera id="c" singletonTag="1" position="3 -30 6" focalPoint="2 -2 1" viewUp="0.1 0 1" )" +
           camera + "/></MRML>\n";
  }

  ViewNumbers view{{3, -30, 6}, {2, -2, 1}, {0.1, 0, 1}, true, 4.0, 16.0};
  Map outer, inner, roi;
};

TEST_F(ScenesCommand, ParallelCameraOfTheSceneIsUsed) {
  folder.write("s.mrml", makeScene(R"(parallelProjection="true" parallelScale="4")", false));
  expectOutline(folder, "s.mrml", {}, view, {outer * inner * makeVolumeCube()});
}

TEST_F(ScenesCommand, PerspectiveViewIsCroppedByTheRotatedRegion) {
  folder.write("s.mrml", makeScene(R"(parallelProjection="false" viewAngle="16")", true));
  view.parallel = false;
  expectOutline(folder, "s.mrml", {}, view, {outer * inner * makeVolumeCube(), roi});
}

TEST_F(ScenesCommand, OptionsOverrideTheCameraOfTheScene) {
  folder.write("s.mrml", makeScene(R"(viewAngle="16" parallelScale="4")", true));
  const Boxes boxes = {outer * inner * makeVolumeCube(), roi};
  expectOutline(folder, "s.mrml", {"--projection", "orthographic"}, view, boxes);
  view.parallelScale = 3.0;
  view.focalPoint = {2, -2.5, 0.5};
  expectOutline(folder, "s.mrml",
                {"--projection", "orthographic", "--scale", "3", "--target", "2,-2.5,0.5"}, view,
                boxes);
}

TEST_F(ScenesCommand, TransferFunctionAndBackgroundDefaultToTheScene) {
  folder.write("s.mrml", makeScene(R"(parallelProjection="true" parallelScale="4")", false));
  const auto render = [&](const Arguments& more) {
    Arguments all = {"s.mrml", "--size", "16x16", "--samples", "64", "--output", "look.exr"};
    all.insert(all.end(), more.begin(), more.end());
    const Outcome outcome = run(all, folder.path());
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    return readImage(folder / "look.exr");
  };
  const Image own = render({});
  EXPECT_EQ(own.header.at("look"), "warm and cold");
  const double green = std::pow((0.4 + 0.055) / 1.055, 2.4);
  EXPECT_NEAR(own.find("G")->front(), green, 1e-6); // the view's background as linear color
  const std::size_t middle = 16 * 8 + 8;
  EXPECT_GT(own.find("albedo.B")->at(middle), 0.9); // high values are blue
  EXPECT_LT(own.find("albedo.R")->at(middle), 0.1);

  folder.write("green.json", R"({"extinction": [[0, 9]], "albedo": [[0, 0.1, 0.8, 0.1]]})");
  const Image changed = render({"--transfer", "green.json", "--background", "0,0,0"});
  EXPECT_EQ(changed.header.at("look"), "green.json");
  EXPECT_EQ(changed.find("G")->front(), 0.0F);
  EXPECT_NEAR(changed.find("albedo.G")->at(middle), 0.8, 0.05);
}

TEST_F(ScenesCommand, FocusIsFoundInTheSceneOrInAFile) {
  folder.write("s.mrml", makeScene(R"(parallelProjection="true" parallelScale="4")", false));
  const Arguments common = {"s.mrml", "--size",  "64x64",    "--samples", "1",
                            "--clip", "cutaway", "--layers", "color,clip"};
  const auto with = [&](const Arguments& more) {
    Arguments all = common;
    all.insert(all.end(), more.begin(), more.end());
    return run(all, folder.path());
  };
  const Outcome own = with({"--focus", "Bone\\, left", "--output", "own.exr"});
  ASSERT_EQ(own.status, 0) << own.err;
  EXPECT_TRUE(readImage(folder / "own.exr").find("clip.Z"));
  EXPECT_EQ(with({"--focus", "A", "--segmentation", "parts", "--output", "named.exr"}).status, 0);
  EXPECT_EQ(*readImage(folder / "own.exr").find("clip.Z"),
            *readImage(folder / "named.exr").find("clip.Z"));
  // A segmentation file has no transform, so its voxel lies outside the transformed volume.
  const Outcome file =
      with({"--focus", "A", "--segmentation", "segments.seg.nrrd", "--output", "file.exr"});
  EXPECT_EQ(file.status, 3);
  expectErrorLine(file.err, "focus Bone, left:");
}

/// Stored options reproduce an image. An option on the command line overrides all stored options of
/// its group.
TEST_F(ScenesCommand, StoredOptionsReproduceTheImage) {
  const std::string plain = makeScene(R"(parallelProjection="true" parallelScale="4")", false);
  std::string stored = plain;
  stored.insert(stored.find("</MRML>"), R"(
      <FenestraRender id="f1" name="earlier" view="left" size="8x8"/>
      <FenestraRender id="f2" name="now" references="volume:v;segmentation:s;" focus="A"
        clip="cutaway" position="3,-30,6" target="2,-2,1" up="0.1,0,1" scale="3" size="16x16"
        noise="0.5" samples="40" seed="9" density="2"
        lights="{&quot;lights&quot;: [{&quot;type&quot;: &quot;environment&quot;,
          &quot;radiance&quot;: [1, 2, 1]}]}"
        output="elsewhere.png" threads="one"/>)");
  folder.write("plain.mrml", plain);
  folder.write("stored.mrml", stored);
  const auto renderChannels = [&](const std::string& input, const Arguments& options) {
    Arguments all = {input, "--output", "a.exr"};
    all.insert(all.end(), options.begin(), options.end());
    const Outcome outcome = run(all, folder.path());
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return readImage(folder / "a.exr").channels;
  };
  const Arguments appearance = {
      "--size",          "16x16",
      "--seed",          "9",
      "--density-scale", "2",
      "--lights",        R"({"lights": [{"type": "environment", "radiance": [1, 2, 1]}]})"};
  const auto with = [&](Arguments options) {
    options.insert(options.end(), appearance.begin(), appearance.end());
    return options;
  };
  const Arguments focus = {"--segmentation", "s", "--focus", "A", "--clip", "cutaway"};
  const Arguments camera = {"--position", "3,-30,6", "--target", "2,-2,1",
                            "--up",       "0.1,0,1", "--scale",  "3"};
  Arguments everything = with({"--noise", "0.5", "--samples", "40"});
  everything.insert(everything.end(), focus.begin(), focus.end());
  Arguments viewed = everything;
  everything.insert(everything.end(), camera.begin(), camera.end());
  EXPECT_EQ(renderChannels("stored.mrml", {}), renderChannels("plain.mrml", everything));
  viewed.insert(viewed.end(), {"--view", "left"});
  EXPECT_EQ(renderChannels("stored.mrml", {"--view", "left"}),
            renderChannels("plain.mrml", viewed));
  Arguments fewer = with({"--samples", "3", "--clip", "none"});
  fewer.insert(fewer.end(), camera.begin(), camera.end());
  fewer.insert(fewer.end(), {"--segmentation", "s", "--focus", "A"});
  EXPECT_EQ(renderChannels("stored.mrml", {"--samples", "3", "--clip", "none"}),
            renderChannels("plain.mrml", fewer));
  EXPECT_FALSE(std::filesystem::exists(folder / "elsewhere.png"));

  const Outcome inspected = run({"inspect", "stored.mrml"}, folder.path());
  EXPECT_NE(inspected.out.find("as rendered   --clip=cutaway --density-scale=2 --focus=A"),
            std::string::npos)
      << inspected.out;
}

TEST_F(ScenesCommand, RejectsDamagedScenesAndMissingNodes) {
  folder.write("s.mrml", makeScene(R"(parallelProjection="true" parallelScale="4")", false));
  folder.write("perspective.mrml", makeScene(R"(viewAngle="16")", false));
  folder.write("none.mrml", "<MRML/>");
  folder.write("entities.mrml", "<!DOCTYPE a [<!ENTITY b 'c'>]><MRML>&b;</MRML>");
  folder.write("half.mrml", "<MRML><Volume");
  folder.write("words.mrb", "words");
  std::string mip = makeScene("", false);
  mip.replace(mip.find("<View "), 6, "<View raycastTechnique=\"MaximumIntensityProjection\" ");
  folder.write("mip.mrml", mip);
  const auto with = [](const std::string& file, const Arguments& more) {
    Arguments all = {file};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  };
  expectErrors(
      {
          {"no volume", with("none.mrml", {}), 3, "none.mrml:"},
          {"entities", with("entities.mrml", {}), 3, "entities.mrml:"},
          {"half", with("half.mrml", {}), 3, "half.mrml:"},
          {"not an archive", with("words.mrb", {}), 3, "words.mrb:"},
          {"missing", with("missing.mrml", {}), 3, "missing.mrml:"},
          {"MIP", with("mip.mrml", {}), 3, "mip.mrml: View | maximum intensity"},
          {"volume", with("s.mrml", {"--volume", "x"}), 3, "s.mrml: | \"x\" | ramp"},
          {"segmentation", with("s.mrml", {"--segmentation", "x", "--focus", "A"}), 3,
           "s.mrml: | \"x\""},
          {"segment", with("s.mrml", {"--focus", "x"}), 3, "segments.seg.nrrd: | \"x\""},
          {"volume of a file", with("volume.nrrd", {"--volume", "x"}), 2, "--volume:"},
          {"angle", with("s.mrml", {"--angle", "9"}), 2, "angle:"},
          {"scale", with("perspective.mrml", {"--scale", "9"}), 2, "scale:"},
          {"scale bar", with("perspective.mrml", {"--annotate", "scale"}), 2, "--annotate:"},
          {"server with a scale bar",
           {"serve", "perspective.mrml", "--annotate", "scale", "--output", "f.png"},
           2,
           "--annotate:"},
          {"turntable with a scale bar",
           {"turntable", "perspective.mrml", "--annotate", "scale", "--frames", "2", "--size",
            "8x8", "--output", "f.png"},
           2,
           "--annotate:"},
      },
      folder.path());
}

TEST_F(ScenesCommand, ErrorNamesTheFileInTheArchive) {
  folder.write("s.mrml", makeScene(R"(parallelProjection="true" parallelScale="4")", false));
  int failure = 0;
  zip_t* zip = zip_open((folder / "s.mrb").c_str(), ZIP_CREATE, &failure);
  for (const std::string name : {"s.mrml", "volume.nrrd", "segments.seg.nrrd"})
    zip_file_add(zip, name.c_str(), zip_source_file(zip, (folder / name).c_str(), 0, -1), 0);
  ASSERT_EQ(zip_close(zip), 0);
  expectErrors({{"segment", {"s.mrb", "--focus", "x"}, 3, "s.mrb/segments.seg.nrrd: | \"x\""}},
               folder.path());
}

// ---- scenes written by Slicer
// --------------------------------------------------------------------

/// The .mrml in an archive written by Slicer.
std::string readScene(const std::filesystem::path& archive) {
  int failure = 0;
  zip_t* zip = zip_open(archive.c_str(), ZIP_RDONLY, &failure);
  const std::string name = archive.stem().string() + "/" + archive.stem().string() + ".mrml";
  zip_file_t* file = zip_fopen(zip, name.c_str(), 0);
  std::string text(1 << 20, '\0');
  text.resize(static_cast<std::size_t>(zip_fread(file, text.data(), text.size())));
  zip_fclose(file);
  zip_discard(zip);
  return text;
}

std::string findAttribute(const std::string& scene, const std::string& tag,
                          const std::string& name) {
  const std::size_t start = scene.find("<" + tag + "\n");
  const std::size_t value = scene.find(" " + name + "=\"", start) + name.size() + 3;
  return scene.substr(value, scene.find('"', value) - value);
}

std::vector<double> readNumbers(const std::string& text) {
  std::istringstream in(text);
  std::vector<double> numbers;
  for (double x = 0.0; in >> x;)
    numbers.push_back(x);
  return numbers;
}

class SlicerScenes : public ::testing::TestWithParam<const char*> {
protected:
  void SetUp() override {
    archive =
        std::filesystem::path(FENESTRA_DATA) / "slicer_scenes/slicer_5_2_written" / GetParam();
    if (!std::filesystem::exists(archive))
      GTEST_SKIP() << archive << " does not exist";
    const std::string scene = readScene(archive);
    const auto vector = [&](const std::string& name) {
      const auto n = readNumbers(findAttribute(scene, "Camera", name));
      return Vector(n.at(0), n.at(1), n.at(2));
    };
    view = {vector("position"),
            vector("focalPoint"),
            vector("viewUp"),
            findAttribute(scene, "Camera", "parallelProjection") == "true",
            readNumbers(findAttribute(scene, "Camera", "parallelScale")).at(0),
            readNumbers(findAttribute(scene, "Camera", "viewAngle")).at(0)};
    // The volume has 128 x 128 x 34 voxels; the scene repeats its spacing and origin.
    const auto spacing = readNumbers(findAttribute(scene, "Volume", "spacing"));
    const auto origin = readNumbers(findAttribute(scene, "Volume", "origin"));
    const Vector half(64 * spacing[0], 64 * spacing[1], 17 * spacing[2]);
    const Vector first(origin[0], origin[1], origin[2]);
    const Vector center = first + half - 0.5 * Vector(spacing[0], spacing[1], spacing[2]);
    boxes = {Eigen::Translation3d(center) * Eigen::Scaling(half)};
    if (archive.stem() == "chest")
      return;
    const auto m = readNumbers(findAttribute(scene, "LinearTransform", "matrixTransformToParent"));
    boxes[0] = makeMap({m[0], m[1], m[2], m[3], m[4], m[5], m[6], m[7], m[8], m[9], m[10], m[11]}) *
               boxes[0];
    // Data/Volume rendering ROI.mrk.json: center 0 20 -170 in LPS, sizes 300 260 220
    boxes.push_back(Eigen::Translation3d(0, -20, -170) * Eigen::Scaling(150.0, 130.0, 110.0));
  }

  std::filesystem::path archive;
  TemporaryFolder folder;
  ViewNumbers view;
  Boxes boxes;
};

TEST_P(SlicerScenes, CameraMatchesStoredValues) {
  expectOutline(folder, archive.string(), {}, view, boxes);
  view.parallel = true;
  expectOutline(folder, archive.string(), {"--projection", "orthographic"}, view, boxes);
}

INSTANTIATE_TEST_SUITE_P(Real, SlicerScenes,
                         ::testing::Values("chest.mrb", "chest_transformed_cropped.mrb"));

} // namespace
} // namespace fenestra::core::ScenesCommandTests
