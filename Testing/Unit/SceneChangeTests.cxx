// A changed request gives the same scene as a new scene with that request, and updates only the
// dependent stages.
#include "scene/PreparedScene.h"

#include "MedicalFiles.h"
#include "Refusals.h"

#include <functional>

namespace fenestra::core::SceneChangeTests {
namespace {

struct Change {
  std::string name;
  std::function<void(RenderRequest&)> apply;
  UpdatedStages updated;
};

constexpr const char* focusLamp =
    R"({"lights": [{"type": "sphere", "center": [0, 20, 0], "diameter": 5, "radiance": [9, 9, 9],
                    "frame": "focus"}]})";

/// Ball in a box of 16^3 voxels, and two labels in the ball.
class SceneChange : public ::testing::TestWithParam<Change> {
protected:
  SceneChange() {
    std::vector<std::int16_t> voxels;
    std::vector<std::uint8_t> labels;
    for (int z = 0; z < edge; ++z)
      for (int y = 0; y < edge; ++y)
        for (int x = 0; x < edge; ++x) {
          const double radius = (Vec3(x, y, z) - Vec3::Constant(7.5)).norm();
          voxels.push_back(static_cast<std::int16_t>(radius < 6.0 ? 100.0 + 5.0 * x : 0.0));
          labels.push_back(radius < 2.0 ? 1 : radius < 3.0 && x > 7 ? 2 : 0);
        }
    FileGeometry geometry;
    geometry.size = {edge, edge, edge};
    writeFile(folder / "volume.nrrd", voxels, geometry);
    writeFile(folder / "labels.nrrd", labels, geometry);
    folder.write("lamp.json", R"({"lights": [{"type": "environment", "radiance": [1, 1, 1]}]})");
    folder.write("ramp.json",
                 R"({"extinction": [[0, 0], [200, 0.2]], "albedo": [[0, 0.8, 0.6, 0.4]]})");

    request.input = folder / "volume.nrrd";
    request.segmentation = folder / "labels.nrrd";
    request.focus = {"1"};
    request.materials = noMaterials;
    request.transfer = folder / "ramp.json";
    request.width = request.height = 16;
  }

  static Film renderFilm(const PreparedScene& scene) {
    RenderSettings settings;
    settings.samples = 2;
    RenderMonitor monitor;
    return render(scene.view(), settings, monitor).film;
  }

  static constexpr int edge = 16;
  TemporaryFolder folder;
  RenderRequest request;
};

TEST_P(SceneChange, UpdatesOnlyDependentStages) {
  const PreparedScene before(request);
  GetParam().apply(request);
  if (request.lights == "lamp.json")
    request.lights = folder / "lamp.json";
  const PreparedScene changed = before.withRequest(request);
  EXPECT_EQ(changed.updatedStages(), GetParam().updated);

  const PreparedScene fresh(request);
  const bool isTinted = request.materials != noMaterials; // updates the tint and the label weights
  EXPECT_EQ(fresh.updatedStages(),
            (UpdatedStages{true, true, true, true, true, true, true, true, isTinted, isTinted}));
  EXPECT_EQ(changed.files(), fresh.files());
  EXPECT_EQ(changed.warnings(), fresh.warnings());
  EXPECT_EQ(changed.transferName(), fresh.transferName());
  EXPECT_EQ(changed.clipResult().focusDepth, fresh.clipResult().focusDepth);
  const Film expected = renderFilm(fresh);
  const Film film = renderFilm(changed);
  for (std::size_t i = 0; i < film.pixelCount(); ++i)
    ASSERT_TRUE(film.pixels()[i].mean == expected.pixels()[i].mean) << "pixel " << i;
}

INSTANTIATE_TEST_SUITE_P(
    All, SceneChange,
    ::testing::Values(
        Change{"Nothing", [](RenderRequest&) {}, {}},
        Change{"Camera",
               [](RenderRequest& r) { r.view.name = "left"; },
               {.camera = true, .lights = true, .clip = true, .majorants = true}},
        Change{"AutomaticView",
               [](RenderRequest& r) { r.view.name = "auto"; },
               {.camera = true, .lights = true, .clip = true, .majorants = true}},
        Change{"Steadiness",
               [](RenderRequest& r) { r.steadyDegrees = 5.0; },
               {.clip = true, .majorants = true}},
        Change{"Size",
               [](RenderRequest& r) { r.width = 24; },
               {.camera = true, .lights = true, .clip = true, .majorants = true}},
        Change{"Focus",
               [](RenderRequest& r) { r.focus = {"2"}; },
               {.focus = true, .camera = true, .lights = true, .clip = true, .majorants = true}},
        Change{"NoFocus",
               [](RenderRequest& r) { r.focus.clear(); },
               {.focus = true, .camera = true, .lights = true, .clip = true, .majorants = true}},
        Change{"Transfer",
               [](RenderRequest& r) { r.density = 2.0; },
               {.transfer = true, .majorants = true}},
        Change{"Gradient",
               [](RenderRequest& r) {
                 r.gradient = r.gradient == GradientKind::sobel ? GradientKind::central
                                                                : GradientKind::sobel;
               },
               {.transfer = true, .majorants = true}},
        Change{"TransferByTheVolume",
               [](RenderRequest& r) { r.transfer.reset(); },
               {.transfer = true, .majorants = true}},
        Change{"Lights", [](RenderRequest& r) { r.lights = "lamp.json"; }, {.lights = true}},
        Change{"LightsAsText",
               [](RenderRequest& r) {
                 r.lights = R"({"lights": [{"type": "environment", "radiance": [1, 2, 1]}]})";
               },
               {.lights = true}},
        Change{
            "LightsAtTheFocus", [](RenderRequest& r) { r.lights = focusLamp; }, {.lights = true}},
        Change{"Environment",
               [](RenderRequest& r) { r.environment = Rgb(1.0, 0.5, 0.2); },
               {.lights = true}},
        Change{"Clip",
               [](RenderRequest& r) { r.clip.mode = ClipMode::cutaway; },
               {.clip = true, .majorants = true}},
        Change{
            "Materials",
            [](RenderRequest& r) { r.materials = "library"; },
            {.majorants = true, .tint = true, .labelWeights = true}}, // the context keeps its color
        Change{"VolumeSmoothing",
               [](RenderRequest& r) {
                 r.smoothing = {SmoothingRequest::Kind::given, 20.0};
               },
               {.volume = true, .minMaxGrid = true, .majorants = true}},
        Change{"Frame",
               [](RenderRequest& r) { r.volume.frame = 0; },
               {.volume = true,
                .transfer = true,
                .camera = true,
                .lights = true,
                .clip = true,
                .minMaxGrid = true,
                .majorants = true}},
        Change{"Volume",
               [](RenderRequest& r) { r.input = *r.segmentation; },
               {true, true, true, true, true, true, true, true}}),
    [](const auto& info) { return info.param.name; });

TEST_F(SceneChange, LampInFocusFrameFollowsTheFocus) {
  request.lights = focusLamp;
  request.view.position = Vec3(0, -100, 0); // keeps the camera fixed
  request.view.target = Vec3::Zero();
  const PreparedScene before(request);
  const auto findLamp = [](const PreparedScene& scene) {
    return scene.view().lights.tables().spheres.at(0).center;
  };
  const Vec3 center = before.volume().grid.indexToWorld * Vec3::Constant(7.5);
  EXPECT_LT((findLamp(before) - center - Vec3(0, 20, 0)).norm(), 1e-9);
  RenderRequest other = request;
  other.focus = {"2"};
  const PreparedScene moved = before.withRequest(other);
  EXPECT_TRUE(moved.updatedStages().lights);
  EXPECT_GT((findLamp(moved) - findLamp(before)).norm(), 1.0);
  request.focus.clear();
  expectRefused("lights", "focus-required: lights[0].frame", [&] { PreparedScene{request}; });
}

TEST_F(SceneChange, StopEndsThePreparation) {
  const PreparedScene before(request);
  const StopFlag isStopped = true;
  catchError(ErrorKind::request, "stopped: render",
             [&] { PreparedScene(request, Input(request.input), isStopped); });
  catchError(ErrorKind::request, "stopped: render",
             [&] { before.withRequest(request, isStopped); });
}

TEST_F(SceneChange, AutomaticViewFollowsFocusAndTransferFunction) {
  request.view.name = "auto";
  const PreparedScene before(request);
  const auto expectSameAsFresh = [&](const PreparedScene& changed) {
    EXPECT_EQ(changed.camera().pose().position, PreparedScene(request).camera().pose().position);
  };
  request.density = 3.0;
  const PreparedScene denser = before.withRequest(request);
  EXPECT_TRUE(denser.updatedStages().camera);
  expectSameAsFresh(denser);
  request.width = 40;
  const PreparedScene wider = denser.withRequest(request);
  EXPECT_LT((wider.camera().forward() - denser.camera().forward()).norm(), 1e-12);
  expectSameAsFresh(wider);
  request.focus = {"2"};
  expectSameAsFresh(wider.withRequest(request));
}

TEST_F(SceneChange, AutomaticScaleFramesTheVisibleMedium) {
  request.focus.clear();
  const PreparedScene ball(request); // radius 6 in 16 voxels
  const auto makeTransfer = [](double from) {
    return R"({"extinction": [[)" + std::to_string(from) +
           R"(, 0], [300, 0.2]], "albedo": [[0, 1, 1, 1]]})";
  };
  request.transfer = makeTransfer(149.0);
  const PreparedScene partial = ball.withRequest(request); // x > 9; |y - 7.5| and |z - 7.5| < 6
  EXPECT_TRUE(partial.updatedStages().camera);
  const auto [position, scale] =
      std::pair(partial.camera().pose().target, partial.camera().pose().scale);
  EXPECT_LT(scale, 0.95 * ball.camera().pose().scale);
  EXPECT_GT((partial.volume().grid.worldToIndex * position).x(), 10.0);
  request.transfer = makeTransfer(299.0);
  const PreparedScene empty = ball.withRequest(request);
  EXPECT_EQ(empty.camera().pose().scale, 1.05 * 8.0) << "the complete volume";
}

TEST_F(SceneChange, WarnsIfTheTransferFunctionHidesTheFocus) {
  EXPECT_EQ(PreparedScene(request).warnings(), std::vector<Message>());
  request.transfer = R"({"extinction": [[149, 0], [300, 0.2]], "albedo": [[0, 1, 1, 1]]})";
  const std::vector<Message> warnings = PreparedScene(request).warnings();
  ASSERT_EQ(warnings.size(), 1U);
  expectMessage(warnings[0], "transparent-focus | 100 %");
}

/// By default, a lung is a solid body; a given transfer function is respected.
TEST_F(SceneChange, DefaultTransferShowsALungAsASolidBody) {
  std::vector<std::int16_t> voxels;
  std::vector<std::uint8_t> labels;
  for (int i = 0; i < edge * edge * edge; ++i) {
    labels.push_back(i / edge % edge < edge / 2 ? 1 : 0);
    voxels.push_back(labels.back() ? -850 : i % edge == 0 ? 300 : 40);
  }
  FileGeometry geometry;
  geometry.size = {edge, edge, edge};
  writeFile(folder / "ct.nrrd", voxels, geometry);
  writeFile(folder / "lung.nrrd", labels, geometry); // one value: named by its file
  request.input = folder / "ct.nrrd";
  request.segmentation = folder / "lung.nrrd";
  request.focus = {"lung"};
  request.materials.reset();
  request.transfer.reset();
  const PreparedScene solid(request);
  ASSERT_TRUE(solid.mixture());
  EXPECT_GT(solid.mixture()->components.back().transfer.extinction(-850.0).value(), 1.0);
  EXPECT_EQ(solid.warnings(), std::vector<Message>());
  request.transfer = "ct-lung";
  const PreparedScene vessels = solid.withRequest(request);
  EXPECT_FALSE(vessels.mixture());
  ASSERT_EQ(vessels.warnings().size(), 1U);
  expectMessage(vessels.warnings()[0], "transparent-focus | 100 %");
}

TEST_F(SceneChange, SmoothedVolumeIsReused) {
  request.smoothing = {SmoothingRequest::Kind::given, 20.0};
  const PreparedScene before(request);
  request.view.name = "left"; // as the frames of a turntable
  request.focus = {"2"};
  request.density = 2.0;
  const PreparedScene changed = before.withRequest(request);
  EXPECT_FALSE(changed.updatedStages().volume);
  EXPECT_EQ(&changed.volume(), &before.volume());
  request.smoothing = {};
  const PreparedScene raw = changed.withRequest(request);
  request.smoothing = {SmoothingRequest::Kind::given, 20.0};
  EXPECT_EQ(&raw.withRequest(request).volume(), &before.volume()) << "kept while off";
}

TEST_F(SceneChange, DraftsUseOnlyWhatEarlierScenesHaveSmoothed) {
  request.smoothing = {SmoothingRequest::Kind::given, 20.0};
  request.focusStyle.shaping.smoothing = 0.5;
  request.materials = "library";
  RenderRequest draft = request;
  draft.isDraft = true;
  const PreparedScene first(draft);
  EXPECT_FALSE(first.smoothing());
  const PreparedScene full = first.withRequest(request);
  EXPECT_TRUE(full.smoothing());
  EXPECT_NE(full.tint()->weights, first.tint()->weights);
  const Film expected = renderFilm(PreparedScene(request)), film = renderFilm(full);
  for (std::size_t i = 0; i < film.pixelCount(); ++i)
    ASSERT_TRUE(film.pixels()[i].mean == expected.pixels()[i].mean) << "pixel " << i;
  draft.view.name = "left";
  const PreparedScene second = full.withRequest(draft);
  EXPECT_EQ(&second.volume(), &full.volume());
  EXPECT_EQ(second.tint()->weights, full.tint()->weights);
}

TEST_F(SceneChange, ColorChangesReuseTheLabels) {
  request.materials = "library";
  const PreparedScene before(request);
  std::filesystem::remove(*request.segmentation); // reading it again would fail
  request.materialChanges = {"1: color=#00ff00"};
  const PreparedScene green = before.withRequest(request);
  EXPECT_TRUE(green.updatedStages().tint);
  EXPECT_EQ(green.tint()->weights, before.tint()->weights);
  EXPECT_FALSE(green.updatedStages().labelWeights);
  EXPECT_FALSE(green.updatedStages().majorants);
  request.focus = {"2"};
  EXPECT_TRUE(green.withRequest(request).updatedStages().focus);
  EXPECT_TRUE(green.withRequest(request).updatedStages().tint) << "muted around the focus";
  request.focusStyle.shaping.smoothing = 0.5;
  EXPECT_NE(green.withRequest(request).tint()->weights, green.tint()->weights);
  request.materials = noMaterials;
  EXPECT_FALSE(green.withRequest(request).tint());
}

TEST_F(SceneChange, MaterialsAdjustTheSaturationOfTheContext) {
  ASSERT_LT(PreparedScene(request).contrast().saturation, 1.0);
  request.materials = "library";
  const PreparedScene library(request);
  EXPECT_EQ(library.contrast().saturation, 1.0) << "not twice";
  EXPECT_FALSE(library.contrast().contrast) << "it would be computed for other colors";
  EXPECT_EQ(library.tintContrast()->adjustment.contextSaturation, defaultContextSaturation);
  request.focusStyle.contextSaturation = 0.4;
  const PreparedScene muted = library.withRequest(request);
  EXPECT_EQ(muted.contrast().saturation, 1.0) << "not twice";
  EXPECT_EQ(muted.tintContrast()->adjustment.contextSaturation, 0.4);
  EXPECT_FALSE(muted.updatedStages().labelWeights);
}

TEST_F(SceneChange, NewCameraDoesNotUpdateLightsInWorldFrame) {
  request.lights = folder / "lamp.json";
  const PreparedScene before(request);
  request.view.name = "left";
  EXPECT_FALSE(before.withRequest(request).updatedStages().lights);
}

TEST_F(SceneChange, InlineLightsEqualLightsFromFile) {
  request.lights = folder / "lamp.json";
  const PreparedScene file(request);
  request.lights = readBytes(*request.lights);
  const PreparedScene text(request);
  const Film expected = renderFilm(file), film = renderFilm(text);
  for (std::size_t i = 0; i < film.pixelCount(); ++i)
    ASSERT_TRUE(film.pixels()[i].mean == expected.pixels()[i].mean) << "pixel " << i;
  std::vector<std::string> files = file.files();
  std::erase(files, (folder / "lamp.json").string());
  EXPECT_EQ(text.files(), files);
}

TEST_F(SceneChange, InvalidRequestLeavesTheSceneUnchanged) {
  const PreparedScene before(request);
  const Film expected = renderFilm(before);
  RenderRequest invalid = request;
  invalid.focus = {"9"};
  EXPECT_THROW(before.withRequest(invalid), Error);
  EXPECT_EQ(renderFilm(before).at(8, 8).mean.sum(), expected.at(8, 8).mean.sum());
  EXPECT_EQ(before.withRequest(request).updatedStages(), UpdatedStages());
}

} // namespace
} // namespace fenestra::core::SceneChangeTests
