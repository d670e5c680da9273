// Names of options: canonical names, the one-word names of version 0.1 and of Slicer, short forms,
// and --quality, which stands for other options.

#include "CommandTesting.h"
#include "ImageTesting.h"

#include <nlohmann/json.hpp>

#include <map>

namespace fenestra::core::NamesCommandTests {
namespace {

/// One-word names of render's options that are not just the canonical ones without "-".
const std::map<std::string, std::string> renamed = {
    {"clip-boundary", "boundary"}, {"clip-offset", "offset"},         {"clip-softness", "soft"},
    {"density-scale", "density"},  {"spline-smoothing", "smoothing"}, {"stats-json", "stats"},
    {"transfer-shift", "shift"},
};

const std::vector<std::pair<std::string, std::string>> clipValues = {
    {"label-smoothing", "0.1"}, {"control-points", "9"},       {"spline-smoothing", "0.4"},
    {"clip-offset", "0.2"},     {"clip-softness", "0.7"},      {"context-density", "0.9"},
    {"density-scale", "1.5"},   {"context-saturation", "0.5"}, {"clip-boundary", "spline"},
    {"transfer-shift", "3"}};

std::string removeDashes(std::string name) {
  std::erase(name, '-');
  return name;
}

std::string findOneWord(const std::string& name) {
  const auto found = renamed.find(name);
  return found == renamed.end() ? removeDashes(name) : found->second;
}

class NamesCommand : public SmallScene {
protected:
  Image renderImage(const Arguments& options, const std::string& input = "volume.nrrd") const {
    Arguments all = {input, "--size", "8x8", "--output", "a.exr"};
    all.insert(all.end(), options.begin(), options.end());
    const Outcome outcome = run(all, folder.path());
    EXPECT_EQ(outcome.status, 0) << outcome.messages;
    return readImage(folder / "a.exr");
  }

  Arguments addFocus(const Arguments& options) const {
    Arguments all = {"--segmentation", "segments.seg.nrrd", "--focus", "A", "--samples", "2"};
    all.insert(all.end(), options.begin(), options.end());
    return all;
  }

  /// The clip options above, with names made of the canonical ones.
  template <typename Rename>
  Arguments makeClipArguments(Rename&& rename) const {
    Arguments all = addFocus({});
    for (const auto& [name, value] : clipValues)
      all.push_back("--" + rename(name) + "=" + value);
    return all;
  }
};

TEST_F(NamesCommand, AllSpellingsGiveTheSameImage) {
  const auto keep = [](const std::string& name) { return name; };
  const Image canonical = renderImage(makeClipArguments(keep));
  EXPECT_NE(canonical.channels, renderImage(addFocus({})).channels);
  EXPECT_EQ(renderImage(makeClipArguments(findOneWord)).channels, canonical.channels);
  EXPECT_EQ(renderImage(makeClipArguments(removeDashes)).channels, canonical.channels);
}

TEST_F(NamesCommand, BothSpellingsAreTheSameOptionTwice) {
  std::vector<ExpectedError> errors;
  for (const auto& [name, oneWord] : renamed)
    errors.push_back(
        {name, {"volume.nrrd", "--" + name, "1", "--" + oneWord, "1"}, 2, "--" + name + ": "});
  expectErrors(errors, folder.path());
}

TEST_F(NamesCommand, ErrorsUseTheCanonicalName) {
  std::vector<ExpectedError> errors;
  for (const std::string name : {"spline-smoothing", "clip-softness", "clip-offset",
                                 "transfer-shift", "density-scale", "control-points"})
    errors.push_back({name, {"volume.nrrd", "--" + findOneWord(name), "x"}, 2, "--" + name + ": "});
  expectErrors(errors, folder.path());
}

TEST_F(NamesCommand, SlicersXmlHasOneWordNames) {
  const std::string xml = run({"--xml"}, folder.path()).out;
  for (const auto& [name, oneWord] : renamed) {
    EXPECT_NE(xml.find("<longflag>" + oneWord + "</longflag>"), std::string::npos) << oneWord;
    EXPECT_EQ(xml.find("<longflag>" + name), std::string::npos) << name;
  }
}

TEST_F(NamesCommand, PresetsAcceptBothSpellings) {
  const auto renderPreset = [&](auto rename) {
    nlohmann::json flags;
    for (const auto& [name, value] : clipValues)
      flags[rename(name)] = value;
    const nlohmann::json preset = {
        {"title", "t"}, {"modality", "CT"}, {"focus", {{"names", {"bone*"}}}}, {"flags", flags}};
    folder.write("p.json", preset.dump());
    return renderImage(addFocus({"--preset", "p.json"})).channels;
  };
  const auto keep = [](const std::string& name) { return name; };
  const auto canonical = renderPreset(keep);
  EXPECT_EQ(renderPreset(findOneWord), canonical);
  EXPECT_NE(renderImage(addFocus({})).channels, canonical);
}

TEST_F(NamesCommand, ScenesAcceptBothSpellings) {
  const auto renderScene = [&](auto rename) {
    std::string attributes;
    for (const auto& [name, value] : clipValues)
      attributes += " " + rename(name) + "=\"" + value + "\"";
    folder.write("s.mrml", R"(<MRML version="Slicer 5.2.2">
 <Volume id="v" name="volume" references="storage:vs;"/>
 <VolumeArchetypeStorage id="vs" fileName="volume.nrrd"/>
 <Segmentation id="s" name="segments" references="storage:ss;"/>
 <SegmentationStorage id="ss" fileName="segments.seg.nrrd"/>
 <FenestraRender id="f" references="volume:v;segmentation:s;" focus="A" samples="2")" +
                               attributes + "/>\n</MRML>\n");
    return renderImage({}, "s.mrml").channels;
  };
  const auto keep = [](const std::string& name) { return name; };
  const auto canonical = renderScene(keep);
  EXPECT_EQ(renderScene(findOneWord), canonical);
  EXPECT_EQ(renderImage(makeClipArguments(keep), "s.mrml").channels, canonical);
}

TEST_F(NamesCommand, BatchColumnsAcceptBothSpellings) {
  folder.write("t.csv", "name,input,density-scale,transfershift\na,volume.nrrd,2,1\n");
  folder.write("u.csv", "name,input,density,shift\na,volume.nrrd,2,1\n");
  for (const std::string table : {"t", "u"})
    ASSERT_EQ(run({"batch", table + ".csv", "--size", "8x8", "--samples", "1", "--formats", "exr",
                   "--layers", "color", "--density", "9"},
                  folder.path())
                  .status,
              0);
  expectSameImage(folder / "t/a/a.exr", folder / "u/a/a.exr");
  folder.write("twice.csv", "name,input,density,density-scale\na,volume.nrrd,2,1\n");
  expectErrors({{"twice", {"batch", "twice.csv"}, 3, "density-scale"}}, folder.path());
}

TEST_F(NamesCommand, StoredRequestsAcceptBothSpellings) {
  const Arguments turntable = {"turntable",       "volume.nrrd", "--frames",  "2",
                               "--size",          "8x8",         "--samples", "1",
                               "--density-scale", "2",           "--output",  "t.png"};
  ASSERT_EQ(run(turntable, folder.path()).status, 0);
  std::string manifest = readBytes(folder / "t.turntable.json");
  const std::size_t place = manifest.find("--density-scale=2");
  ASSERT_NE(place, std::string::npos) << manifest;
  folder.write("t.turntable.json", manifest.replace(place, 17, "--density=2"));
  expectCounts(run(turntable, folder.path()).result, {2, 2, 0});
}

TEST_F(NamesCommand, ServeAcceptsBothSpellings) {
  Process process({"serve", "volume.nrrd", "--size", "8x8", "--samples", "1", "--output", "a.exr"},
                  folder.path());
  process.write("{\"id\": 1, \"density\": 2, \"density-scale\": 3}\n"
                "{\"id\": 2, \"transfershift\": 1, \"density-scale\": 2}\n");
  ASSERT_TRUE(process.waitForOutput("\"error\",\"id\":1,"));
  ASSERT_TRUE(process.waitForOutput("\"picture\",\"id\":2,[^\n]*\"done\":true"));
  const auto changed = readImage(folder / "a.exr").channels;
  process.write("{\"id\": 3, \"shift\": null, \"density\": null}\n");
  ASSERT_TRUE(process.waitForOutput("\"picture\",\"id\":3,[^\n]*\"done\":true"));
  const auto restored = readImage(folder / "a.exr").channels;
  EXPECT_EQ(
      renderImage({"--samples", "1", "--transfer-shift", "1", "--density-scale", "2"}).channels,
      changed);
  EXPECT_EQ(renderImage({"--samples", "1"}).channels, restored);
}

TEST_F(NamesCommand, ShortFormsEqualTheirOptions) {
  EXPECT_EQ(run({"volume.nrrd", "-s", "segments.seg.nrrd", "--focus", "A", "-o", "a.exr", "-j1",
                 "--size", "8x8", "--samples", "2", "-v", "--transfer-shift", "-3"},
                folder.path())
                .status,
            0);
  EXPECT_EQ(run({"volume.nrrd", "--segmentation", "segments.seg.nrrd", "--focus", "A", "--output",
                 "b.exr", "--threads", "1", "--size", "8x8", "--samples", "2", "--shift=-3"},
                folder.path())
                .status,
            0);
  expectSameImage(folder / "a.exr", folder / "b.exr");
  // File names in the header are relative to the image, after short forms, too.
  std::filesystem::create_directory(folder / "sub");
  ASSERT_EQ(run({"volume.nrrd", "-s", "segments.seg.nrrd", "--focus", "A", "-o", "sub/a.exr",
                 "--size", "8x8", "--samples", "1", "-j", "1"},
                folder.path())
                .status,
            0);
  EXPECT_EQ(readImage(folder / "sub/a.exr").header.at("command"),
            "fenestra ../volume.nrrd -s ../segments.seg.nrrd --focus A -o a.exr --size 8x8 "
            "--samples 1 -j 1");
  ASSERT_EQ(run({"phantom", "cube", "--size", "16", "-q", "-o", "cube"}, folder.path()).messages,
            "");
  EXPECT_TRUE(std::filesystem::exists(folder / "cube/cube.nrrd"));
}

TEST_F(NamesCommand, RejectsWrongShortForms) {
  const auto refusal = [](const Arguments& options, const std::string& text) {
    Arguments all = {"volume.nrrd"};
    all.insert(all.end(), options.begin(), options.end());
    return ExpectedError{options.front(), all, 2, text};
  };
  expectErrors(
      {
          refusal({"-o", "-s", "x"}, "--output: "),
          refusal({"-o", "-j4"}, "--output: "),
          refusal({"-o"}, "--output: "),
          refusal({"-o", ""}, "--output: "),
          refusal({"-o=x.png"}, "-o FILE"),
          refusal({"-ox.png"}, "-o FILE"),
          refusal({"-qv"}, "-q"),
          refusal({"-jx"}, "-j K"),
          refusal({"-j4000"}, "--threads: "),
          refusal({"-x"}, "-o"),
          refusal({"-V"}, "-V: "),
          refusal({"-i", "x.nrrd"}, "-i: "),
          refusal({"-o", "a.png", "--output", "a.png", "-q", "-v"}, "--quiet"),
          refusal({"out.png"}, "add -o"),
          refusal({"-focus", "A"}, "did you mean --focus?"),
          refusal({"--labelsmothing", "1"}, "did you mean --label-smoothing?"),
          refusal({"--label_smoothing", "1"}, "did you mean --label-smoothing?"),
          {"inspect", {"inspect", "volume.nrrd", "-o", "x"}, 2, "-o: "},
      },
      folder.path());
}

TEST_F(NamesCommand, QualityEqualsItsOptionsBitForBit) {
  const auto renderColor = [&](const Arguments& options) {
    Arguments all = {"--denoise", "off", "--density", "0.5"};
    all.insert(all.end(), options.begin(), options.end());
    return renderImage(all);
  };
  const std::vector<std::pair<std::string, Arguments>> levels = {
      {"draft", {"--samples", "16"}},
      {"normal", {"--samples", "256", "--noise", "0.05"}},
      {"high", {"--samples", "1024", "--noise", "0.025"}},
      {"final", {"--samples", "4096", "--noise", "0.015"}}};
  std::set<std::string> samples;
  for (const auto& [level, options] : levels) {
    const Image image = renderColor({"--quality", level}), expected = renderColor(options);
    EXPECT_EQ(image.channels, expected.channels) << level;
    EXPECT_EQ(image.header.at("samples"), expected.header.at("samples")) << level;
    samples.insert(image.header.at("samples"));
  }
  EXPECT_EQ(samples.size(), levels.size());
  // The help states the same options.
  const std::string help = run({"--help", "quality"}, folder.path()).out;
  for (const auto& [level, options] : levels)
    for (std::size_t i = 1; i < options.size(); i += 2)
      EXPECT_NE(help.find(options[i]), std::string::npos) << level << options[i];
  // An option that stops the render replaces all that the level sets.
  for (const Arguments& stop : {Arguments{"--samples", "3"}, {"--noise", "0.3"}}) {
    Arguments all = {"--quality", "final"};
    all.insert(all.end(), stop.begin(), stop.end());
    EXPECT_EQ(renderColor(all).channels, renderColor(stop).channels);
  }
  EXPECT_EQ(renderColor({}).header.at("samples"), "64");
}

TEST_F(NamesCommand, QualityInTablesAndServe) {
  folder.write("t.csv", "name,input,quality\na,volume.nrrd,draft\nb,volume.nrrd,\n");
  ASSERT_EQ(
      run({"batch", "t.csv", "--size", "8x8", "--samples", "3", "--formats", "exr"}, folder.path())
          .status,
      0);
  EXPECT_EQ(readImage(folder / "t/a/a.exr").header.at("samples"), "16");
  EXPECT_EQ(readImage(folder / "t/b/b.exr").header.at("samples"), "3");
  Process process({"serve", "volume.nrrd", "--size", "8x8", "--samples", "1", "--output", "a.exr"},
                  folder.path());
  process.write("{\"id\": 1, \"quality\": \"draft\"}\n");
  ASSERT_TRUE(process.waitForOutput("\"id\":1,\"samples\":16,[^\n]*\"done\":true"));
  expectErrors({{"unknown", {"volume.nrrd", "--quality", "best"}, 2, "--quality: "},
                {"shard",
                 {"volume.nrrd", "--quality", "high", "--shard", "1/2", "--checkpoint", "c.film"},
                 2,
                 "--quality: "}},
               folder.path());
}

TEST_F(NamesCommand, RangesInErrorsArePlainNumbers) {
  for (const char* option : {"--samples", "--bounces", "--seed", "--seconds"}) {
    const Outcome outcome = run({"volume.nrrd", option, "x"}, folder.path());
    EXPECT_EQ(outcome.status, 2);
    EXPECT_EQ(outcome.err.find("e+"), std::string::npos) << outcome.err;
    EXPECT_EQ(outcome.err.find(" to "), std::string::npos) << outcome.err; // no absurd bound
  }
}

} // namespace
} // namespace fenestra::core::NamesCommandTests
