// Outputs of a render: images, statistics and messages.

#include "CommandTesting.h"
#include "files/images/ImageReader.h"

#include <nlohmann/json.hpp>

#include <array>

namespace fenestra::core::RenderCommandTests {
namespace {

class RenderCommand : public SmallScene {
protected:
  Image render(const Arguments& arguments) const {
    Arguments all = arguments;
    all.insert(all.end(), {"--output", "image.exr"});
    const Outcome outcome = renderVolume(all);
    EXPECT_EQ(outcome.status, 0);
    EXPECT_EQ(outcome.err, "");
    return readImage(folder / "image.exr");
  }

  nlohmann::json readStats(const std::string& name) const {
    return nlohmann::json::parse(readBytes(folder / name));
  }
};

TEST_F(RenderCommand, DefaultOutputIsTheInputNameInTheCurrentFolder) {
  std::filesystem::create_directory(folder / "data");
  std::filesystem::rename(folder / "volume.nrrd", folder / "data/volume.nrrd");
  const Outcome outcome =
      run({"render", "data/volume.nrrd", "--size", "16x8", "--samples", "1"}, folder.path());
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(outcome.out, "");
  EXPECT_TRUE(outcome.result.starts_with("volume.png: 16x8 pixels, 1 sample per pixel"))
      << outcome.result;
  const Image image = readImage(folder / "volume.png");
  EXPECT_EQ(image.width, 16);
  EXPECT_EQ(image.height, 8);
  EXPECT_EQ(listFiles(folder.path()),
            (std::set<std::string>{"data", "data/volume.nrrd", "segments.seg.nrrd", "volume.png"}));
}

TEST_F(RenderCommand, StatsNameTheTransferFunction) {
  const auto findTransfer = [&](const Arguments& options) {
    Arguments all = {"--output", "a.png", "--stats-json", "s.json"};
    all.insert(all.end(), options.begin(), options.end());
    EXPECT_EQ(renderVolume(all).status, 0);
    return nlohmann::json::parse(readBytes(folder / "s.json")).at("transferFunction");
  };
  EXPECT_EQ(findTransfer({}), "by the volume's range");
  EXPECT_EQ(findTransfer({"--transfer", "ct-bone"}), "ct-bone");
}

TEST_F(RenderCommand, WarnsOfATransferFunctionOfAnotherModality) {
  EXPECT_NE(renderVolume({"--output", "a.png", "--transfer", "ct-bone"}).err.find("ct-bone"),
            std::string::npos);
}

TEST_F(RenderCommand, BackgroundIsNearlyBlackUnlessNamed) {
  const Arguments nothing = {"--scale", "100", "--denoise", "off"}; // leaves the corners empty
  const auto renderChannels = [&](const Arguments& more) {
    Arguments arguments = nothing;
    arguments.insert(arguments.end(), more.begin(), more.end());
    return render(arguments).channels;
  };
  const auto standard = renderChannels({});
  EXPECT_NEAR(standard.at("B").front(), 0.005, 1e-6);
  EXPECT_EQ(renderChannels({"--background", "dark"}), standard);
  const auto gradient = renderChannels({"--background", "gradient"});
  EXPECT_NEAR(gradient.at("R").front(), 0.060, 0.004); // upper edge
  EXPECT_NEAR(gradient.at("B").back(), 0.016, 0.002);  // lower edge
  EXPECT_NEAR(renderChannels({"--background", "gray"}).at("G").front(), 0.18, 1e-6);
  EXPECT_EQ(renderChannels({"--background", "0,0,0"}).at("R").front(), 0.0f);
}

TEST_F(RenderCommand, OneNumberIsAGray) {
  renderVolume({"--output", "a.exr", "--environment", "0.5", "--background", "0.25"});
  renderVolume(
      {"--output", "b.exr", "--environment", "0.5,0.5,0.5", "--background", "0.25,0.25,0.25"});
  EXPECT_EQ(readImage(folder / "a.exr").channels, readImage(folder / "b.exr").channels);
}

TEST_F(RenderCommand, ExposureAndToneChangeOnlyDisplayImages) {
  const auto renderChannels = [&](const Arguments& more, const std::string& name) {
    Arguments arguments = {"--denoise", "on",           "--output",     name + ".exr",
                           "--output",  name + ".nrrd", "--output",     name + ".png",
                           "--output",  name + ".tif",  "--stats-json", name + ".json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_EQ(renderVolume(arguments).status, 0);
    return readImage(folder / (name + ".exr")).channels;
  };
  const auto file = [&](const std::string& name) { return readBytes(folder / name); };
  const auto raw = renderChannels({}, "a");
  for (const auto& [option, value, headerText] :
       {std::array{"--exposure", "2", "tone film, exposure 2 EV"},
        std::array{"--tone", "photographic", "tone photographic, exposure 0 EV"}}) {
    EXPECT_EQ(renderChannels({option, value}, "b"), raw) << option;
    for (const std::string part : {".nrrd", "-Z.nrrd", "-denoised.nrrd"})
      EXPECT_EQ(file("a" + part), file("b" + part)) << option << part;
    for (const std::string kind : {".png", ".tif"}) {
      EXPECT_NE(readImage(folder / ("a" + kind)).channels,
                readImage(folder / ("b" + kind)).channels)
          << option << kind;
      EXPECT_NE(file("b" + kind).find(headerText), std::string::npos) << kind;
    }
  }
  EXPECT_EQ(readStats("a.json")["display"], (nlohmann::json{{"tone", "film"}, {"exposure", 0.0}}));
  EXPECT_EQ(readStats("b.json")["display"]["tone"], "photographic");
  renderChannels({"--exposure", "-1.5", "--tone", "film"}, "c");
  EXPECT_EQ(readStats("c.json")["display"]["exposure"], -1.5);
}

TEST_F(RenderCommand, AnnotationsAreOnlyOnDisplayImages) {
  const auto renderAll = [&](const std::string& name, const Arguments& more) {
    Arguments arguments = {"--output", name + ".exr", "--output", name + ".nrrd",
                           "--output", name + ".png", "--output", name + ".tif"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_EQ(renderVolume(arguments).status, 0);
  };
  const auto channels = [&](const std::string& name) { return readImage(folder / name).channels; };
  renderAll("a", {});
  renderAll("none", {"--annotate", "none"});
  renderAll("scale", {"--annotate", "scale"});
  renderAll("both", {"--annotate", "scale,orientation"});
  for (const std::string name : {"scale", "both"}) {
    EXPECT_EQ(channels(name + ".exr"), channels("a.exr"));
    for (const std::string part : {".nrrd", "-Z.nrrd"})
      EXPECT_EQ(readBytes(folder / (name + part)), readBytes(folder / ("a" + part)));
  }
  for (const std::string kind : {".png", ".tif"}) {
    EXPECT_EQ(channels("none" + kind), channels("a" + kind));
    EXPECT_NE(channels("scale" + kind), channels("a" + kind));
    EXPECT_NE(channels("both" + kind), channels("scale" + kind));
  }
  const Arguments perspective = {"--projection", "perspective", "--output", "p.png"};
  Arguments annotated = perspective;
  annotated.insert(annotated.end(), {"--annotate", "orientation"});
  EXPECT_EQ(renderVolume(annotated).status, 0) << "letters need no scale";
}

TEST_F(RenderCommand, EveryFormatEqualsItselfInCompare) {
  const Arguments names = {"a.png", "a.tif", "A.EXR", "a.nrrd"};
  Arguments arguments;
  for (const std::string& name : names)
    arguments.insert(arguments.end(), {"--output", name});
  ASSERT_EQ(renderVolume(arguments).status, 0);
  EXPECT_TRUE(std::filesystem::exists(folder / "a-Z.nrrd"));
  for (const std::string& name : names) {
    const Outcome outcome = run({"compare", name, name}, folder.path());
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("\nlargest     0\n"), std::string::npos) << name << outcome.out;
    // relMSE subtracts the reference's variance if the image has error channels
    EXPECT_EQ(outcome.out.starts_with("relMSE      0\n"), name != "A.EXR") << outcome.out;
  }
  EXPECT_TRUE(readImage(folder / "A.EXR").find("normal.X"));
  const Image linear = readImage(folder / "A.EXR");
  EXPECT_EQ(*linear.find("R"), *readImage(folder / "a.nrrd").find("R"));
  EXPECT_EQ(*linear.find("Z"), *readImage(folder / "a-Z.nrrd").find("Z"));
}

TEST_F(RenderCommand, EnvironmentVariableSelectsTheInstructionSet) {
  ::setenv("FENESTRA_INSTRUCTIONS", "MMX", 1);
  const Outcome refused =
      run({"volume.nrrd", "--size", "16x16", "--samples", "2", "--output", "refused.exr"},
          folder.path());
  EXPECT_EQ(refused.status, 2) << refused.err;
  EXPECT_NE(refused.err.find("FENESTRA_INSTRUCTIONS: MMX"), std::string::npos) << refused.err;

  const std::string offered = refused.err.substr(0, refused.err.find_last_not_of('\n') + 1);
  const std::string last = offered.substr(offered.find_last_of(' ') + 1);
  ::setenv("FENESTRA_INSTRUCTIONS", last.c_str(), 1);
  const std::string target = render({}).header.at("target");
  ::unsetenv("FENESTRA_INSTRUCTIONS");
  EXPECT_TRUE(target.ends_with("-" + last)) << target;
}

TEST_F(RenderCommand, WritesRequestedLayersAndTheHeader) {
  const Image all = render({});
  for (const char* name : {"R", "A", "Z", "albedo.G", "normal.Y", "error.B", "samples.N"})
    EXPECT_TRUE(all.find(name)) << name;
  EXPECT_EQ(all.header.at("seed"), "0");
  EXPECT_EQ(all.header.at("sampling"), "stratified");
  EXPECT_EQ(all.header.at("samples"), "2");
  EXPECT_EQ(all.header.at("command"),
            "fenestra volume.nrrd --size 16x16 --samples 2 --output image.exr");
  for (const char* key : {"version", "target", "camera"})
    EXPECT_FALSE(all.header.at(key).empty()) << key;

  const Image some = render({"--layers", "color,depth", "--layers", "samples"});
  std::set<std::string> names;
  for (const auto& [name, plane] : some.channels)
    names.insert(name);
  EXPECT_EQ(names, (std::set<std::string>{"R", "G", "B", "A", "Z", "samples.N"}));
  for (const float samples : *some.find("samples.N"))
    EXPECT_EQ(samples, 2.0f);
}

TEST_F(RenderCommand, StatsCountOnlyRequiredFilesAndRays) {
  folder.write("sky.json", R"({"lights": [{"type": "environment", "radiance": [1, 1, 1]}]})");
  folder.write("haze.json",
               R"({"extinction": [[0, 0], [63, 0.5]], "albedo": [[0, 0.8, 0.8, 0.8]]})");
  const auto renderStats = [&](const Arguments& more) {
    Arguments arguments = {"--transfer", "haze.json", "--layers",     "color",
                           "--output",   "s.exr",     "--stats-json", "s.json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_EQ(renderVolume(arguments).status, 0);
    return readStats("s.json");
  };
  const nlohmann::json minimal = renderStats(
      {"--lights", "sky.json", "--background", "0,0,0", "--view", "anterior", "--scale", "40"});
  EXPECT_EQ(minimal["filesRead"], (nlohmann::json{"haze.json", "sky.json", "volume.nrrd"}));
  EXPECT_EQ(minimal["shadowRays"], 0);
  EXPECT_EQ(minimal["gradients"], 0);
  EXPECT_FALSE(minimal.contains("focusVoxels"));
  EXPECT_GT(minimal["emptyPixels"], 0);
  EXPECT_EQ(minimal["samplesPerPixel"]["min"], 2);
  EXPECT_EQ(minimal["paths"].get<int>(), 2 * 256 - minimal["emptyPixels"].get<int>());
  EXPECT_EQ(minimal["cells"]["empty"], 0);

  const nlohmann::json lit = renderStats({"--layers", "normal"});
  EXPECT_EQ(lit["filesRead"], (nlohmann::json{"haze.json", "volume.nrrd"}));
  EXPECT_GT(lit["shadowRays"], 0);
  EXPECT_GT(lit["gradients"], 0);
  EXPECT_LE(lit["gradients"], lit["collisions"]);

  const nlohmann::json focused = renderStats({"--segmentation", "segments.seg.nrrd", "--focus", "A",
                                              "--clip", "cutaway", "--label-smoothing", "0"});
  EXPECT_EQ(focused["focusVoxels"], 27) << "one voxel and its neighbors";
  EXPECT_EQ(focused["filesRead"],
            (nlohmann::json{"haze.json", "segments.seg.nrrd", "volume.nrrd"}));
}

TEST_F(RenderCommand, LightsAsFileOrInlineJsonGiveTheSameImage) {
  render({"--background", "1,2,3"});
  std::filesystem::create_directory(folder / "maps");
  std::filesystem::rename(folder / "image.exr", folder / "maps/sky.exr");
  const std::string text = R"({"lights": [{"type": "environment", "file": "maps/sky.exr"},
    {"type": "rectangle", "frame": "camera", "center": [-1.5, 1.7, 2.4], "normal": [1.5, -1.7, -2],
     "up": [0, 1, 0], "size": [1.4, 1.4], "radiance": [15, 10, 5]}]})";
  folder.write("lights.json", text);
  const Image file = render({"--lights", "lights.json"});
  EXPECT_EQ(file.channels, render({"--lights", text, "--stats-json", "s.json"}).channels);
  EXPECT_EQ(readStats("s.json")["filesRead"], nlohmann::json::array({"volume.nrrd"}));
  EXPECT_NE(file.channels, render({}).channels);
  const std::string longerThanPaths = text + std::string(5000, ' ');
  EXPECT_EQ(file.channels, render({"--lights=" + longerThanPaths}).channels);
}

TEST_F(RenderCommand, DefaultLightsSuitCutOrgansWithAFocus) {
  const auto renderLights = [&](Arguments options, const std::string& name) {
    if (!name.empty())
      options.insert(options.end(), {"--lights", name});
    return render(options).channels;
  };
  const Arguments focus = {"--segmentation", "segments.seg.nrrd", "--focus", "A"};
  EXPECT_EQ(renderLights({}, ""), renderLights({}, "theatre"));
  EXPECT_NE(renderLights({}, ""), renderLights({}, "theatre-wet"));
  EXPECT_EQ(renderLights(focus, ""), renderLights(focus, "theatre-wet"));
  EXPECT_NE(renderLights(focus, ""), renderLights(focus, "theatre"));
}

TEST_F(RenderCommand, SamplingIsSelectedAndReported) {
  const Image stratified = render({"--stats-json", "s.json"});
  EXPECT_EQ(readStats("s.json")["sampling"], "stratified");
  const Image plain = render({"--sampling", "independent", "--stats-json", "s.json"});
  EXPECT_EQ(readStats("s.json")["sampling"], "independent");
  EXPECT_EQ(plain.header.at("sampling"), "independent");
  EXPECT_NE(stratified.channels.at("R"), plain.channels.at("R"));
  for (const char* name : {"stratified", "strata"}) // also the old name
    EXPECT_EQ(stratified.channels, render({"--sampling", name}).channels) << name;
}

TEST_F(RenderCommand, ImageDependsOnTheSeedButNotOnTheThreads) {
  const Image one = render({"--threads", "1", "--seed", "7"});
  const Image two = render({"--threads", "2", "--seed", "7"});
  const Image many = render({"--threads", "64", "--seed", "7"});
  const Image other = render({"--seed", "8"});
  EXPECT_EQ(one.channels, two.channels);
  EXPECT_EQ(one.channels, many.channels);
  EXPECT_NE(one.channels.at("R"), other.channels.at("R"));
}

TEST_F(RenderCommand, StopsAtTimeLimitAndAtNoiseTarget) {
  Outcome outcome =
      run({"volume.nrrd", "--size", "32x32", "--seconds", "0.3", "--stats-json", "s.json"},
          folder.path());
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const double seconds = readStats("s.json")["seconds"]["transport"];
  EXPECT_GT(seconds, 0.1);
  EXPECT_LT(seconds, 2.0);
  outcome = run({"volume.nrrd", "--size", "32x32", "--noise", "0.1", "--stats-json", "n.json"},
                folder.path());
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_LE(readStats("n.json")["noiseDenoised"], 0.1); // of the display image
  outcome = run({"volume.nrrd", "--size", "32x32", "--noise", "0.1", "--noise-target", "raw",
                 "--stats-json", "r.json"},
                folder.path());
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_LE(readStats("r.json")["noise"], 0.1);
  EXPECT_GE(readStats("r.json")["samplesPerPixel"]["min"], 16);
}

TEST_F(RenderCommand, StatsHaveEveryDocumentedKey) {
  const Outcome outcome =
      run({"knee/knee.nrrd", "--segmentation", "knee/knee.seg.nrrd", "--focus", "FemoralCartilage",
           "--transfer", "knee/knee.vp.json", "--label-smoothing", "0", "--clip-boundary", "spline",
           "--size", "32x32", "--samples", "4", "--output", (folder / "knee.png").string(),
           "--stats-json", (folder / "knee.json").string()},
          kneeFolder().path());
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json json = readStats("knee.json");
  double stages = 0.0;
  for (const char* stage : {"load", "classify", "focus", "spline", "fill", "features", "transport",
                            "filter", "write"}) {
    EXPECT_GT(json["seconds"][stage], 0.0) << stage;
    stages += json["seconds"][stage].get<double>();
  }
  EXPECT_LE(stages, json["seconds"]["total"].get<double>() * 1.001);
  EXPECT_GT(json["cpuSeconds"], 0.0);
  EXPECT_EQ(json["paths"], 32 * 32 * 4);
  EXPECT_GT(json["collisions"], 0);
  EXPECT_GT(json["lookups"], json["collisions"]);
  EXPECT_GE(json["skippedFraction"], 0.0);
  EXPECT_LE(json["skippedFraction"], 1.0);
  EXPECT_EQ(json["samplesPerPixel"], (nlohmann::json{{"min", 4}, {"mean", 4.0}, {"max", 4}}));
  EXPECT_GT(json["noise"], 0.0);
  EXPECT_GT(json["noiseDenoised"], 0.0);
  EXPECT_LT(json["noiseDenoised"], json["noise"]);
  EXPECT_GT(json["peakBytes"], 1'000'000);
  EXPECT_GE(json["boundaryMismatchMm"]["mean"], 0.0);
  EXPECT_GE(json["boundaryMismatchMm"]["p95"], json["boundaryMismatchMm"]["mean"]);
  EXPECT_GE(json["boundaryMismatchMm"]["max"], json["boundaryMismatchMm"]["p95"]);
  EXPECT_GT(json["focusCoverage"], 0.5);
  EXPECT_LE(json["focusCoverage"], 1.0);
  for (const char* key : {"deltaE", "deltaEProtan", "deltaEDeutan", "deltaETritan", "deltaL"})
    EXPECT_GE(json["contrast"][key], 0.0) << key;
  EXPECT_GT(json["contrast"]["contextSaturation"], 0.0);
  EXPECT_TRUE(json["warnings"].is_array());
}

TEST_F(RenderCommand, NegativeNumbersAreValuesNotOptions) {
  const Image joined = render({"--position=-1,20,3", "--transfer-shift=-5"});
  const Image separate = render({"--position", "-1,20,3", "--transfer-shift", "-5"});
  const Image bare = render({"--position", "-1.0,20,3.", "--transfer-shift", "-.5e1"});
  EXPECT_EQ(joined.channels, separate.channels);
  EXPECT_EQ(joined.channels, bare.channels);
  EXPECT_NE(joined.header.at("camera").find("--position=-1,20,3 "), std::string::npos)
      << joined.header.at("camera");
}

TEST_F(RenderCommand, CameraOptionsOfTheHeaderReproduceTheImage) {
  const Image named = render({"--view", "left"});
  Arguments pose;
  std::istringstream words(named.header.at("camera"));
  for (std::string word; words >> word;)
    pose.push_back(word);
  EXPECT_EQ(named.channels, render(pose).channels);
}

TEST_F(RenderCommand, FindsTheFocusByIdNameAndLabelValue) {
  const auto renderFocus = [this](Arguments arguments) {
    arguments.insert(arguments.begin(), {"--segmentation", "segments.seg.nrrd"});
    return render(arguments).channels;
  };
  const auto byId = renderFocus({"--focus", "A"});
  EXPECT_EQ(byId.count("clip.Z"), 1u);
  EXPECT_EQ(byId, renderFocus({"--focus", "Bone\\, left"}));
  EXPECT_EQ(byId, renderFocus({"--focus", "1"}));
  for (const Arguments& both : {Arguments{"--focus", "A,B"}, {"--focus", "A", "--focus=B"}}) {
    Arguments arguments = {"--segmentation", "segments.seg.nrrd", "--output", "image.exr"};
    arguments.insert(arguments.end(), both.begin(), both.end());
    const Outcome outcome = renderVolume(arguments);
    EXPECT_EQ(outcome.status, 0);
    EXPECT_TRUE(outcome.err.starts_with("fenestra: warning: segments.seg.nrrd:")) << outcome.err;
    EXPECT_TRUE(outcome.err.ends_with(": B (Void)\n")) << "it has no voxel";
    EXPECT_EQ(byId, readImage(folder / "image.exr").channels);
  }
}

TEST_F(RenderCommand, FileNamesMayLookLikeOptionsOrCommands) {
  std::filesystem::copy(folder / "volume.nrrd", folder / "--volume.nrrd");
  std::filesystem::copy(folder / "volume.nrrd", folder / "rendr.nrrd");
  for (const char* input : {"./--volume.nrrd", "rendr.nrrd"}) {
    const Outcome outcome =
        run({input, "--size", "4x4", "--samples", "1", "--output=-a.png"}, folder.path());
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_TRUE(std::filesystem::remove(folder / "-a.png"));
  }
}

TEST_F(RenderCommand, DefaultOutputReplacesOnlyImagesOfFenestra) {
  const std::string volume = readBytes(folder / "volume.nrrd");
  folder.write("named.png", "another program's image");
  ASSERT_EQ(renderVolume({"--output", "named.png"}).status, 0);
  EXPECT_EQ(readImage(folder / "named.png").width, 16);
  ASSERT_EQ(renderVolume({}).status, 0); // volume.png, a default name
  ASSERT_EQ(renderVolume({}).status, 0);
  EXPECT_EQ(readImage(folder / "volume.png").width, 16);
  folder.write("volume.png", "another program's image");
  const Outcome refused = renderVolume({});
  EXPECT_EQ(refused.status, 2);
  expectErrorLine(refused.err, "volume.png:");
  EXPECT_EQ(readBytes(folder / "volume.png"), "another program's image");
  EXPECT_EQ(readBytes(folder / "volume.nrrd"), volume);
}

} // namespace
} // namespace fenestra::core::RenderCommandTests
