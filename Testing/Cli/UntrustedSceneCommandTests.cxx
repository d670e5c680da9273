// Scenes from untrusted sources must not make the program read or write arbitrary files, or use
// excessive resources.

#include "CommandTesting.h"
#include "files/images/ImageReader.h"

#include <zip.h>

namespace fenestra::core::UntrustedSceneCommandTests {
namespace {

const std::string scene = R"(<MRML version="Slicer 5.6.2 32448">
  <VolumeArchetypeStorage id="file" fileName="volume.nrrd"/>
  <Volume id="v" name="ramp" references="storage:file;"/>
  <SegmentationStorage id="labels" fileName="segments.seg.nrrd"/>
  <Segmentation id="s" name="parts" references="storage:labels;"/>)";

class UntrustedSceneCommand : public SmallScene {
protected:
  /// Writes a scene with these attributes in its FenestraRender node.
  void writeScene(const std::string& attributes) const {
    folder.write("scene.mrml",
                 scene + "<FenestraRender id=\"f\" name=\"now\" " + attributes + "/></MRML>");
  }

  /// Runs `fenestra scene.mrml … --output NAME`.
  Outcome render(const std::string& name, const Arguments& options = {}) const {
    Arguments all = {"scene.mrml", "--output", name};
    all.insert(all.end(), options.begin(), options.end());
    return run(all, folder.path());
  }

  /// Image of the scene without stored options.
  std::map<std::string, std::vector<float>> renderPlain(const Arguments& options) const {
    writeScene("");
    EXPECT_EQ(render("plain.exr", options).status, 0);
    return readImage(folder / "plain.exr").channels;
  }
};

TEST_F(UntrustedSceneCommand, StoredOptionsWriteNoFilesAndRunNoPrograms) {
  folder.write("program", "#!/bin/sh\ntouch ran\n");
  std::filesystem::permissions(folder / "program", std::filesystem::perms::all);
  writeScene(R"(size="8x8" samples="1" output="a.png" stats="b.json" surface="c.vtp" focus="A"
    references="segmentation:s;" returnparameterfile="d.txt" threads="-1" progress="xml" echo="1"
    xml="1" processinformationaddress="0" INPUT="other.nrrd" frames="3" restart="1" degrees="9"
    json="1" help="1" version="1" program="./program" executable="./program" errora="e.exr" quiet="1"
    verbose="1" stats="s.json" stats-json="s.json")");
  const std::set<std::string> before = listFiles(folder.path());
  const Outcome outcome = render("image.exr", {"--progress", "none"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(outcome.out, "");
  EXPECT_NE(outcome.result, "");
  std::set<std::string> after = listFiles(folder.path());
  EXPECT_EQ(after.erase("image.exr"), 1u);
  EXPECT_EQ(after, before);
  EXPECT_EQ(readImage(folder / "image.exr").width, 8);
}

/// The files are invalid, so that reading one would fail the render.
TEST_F(UntrustedSceneCommand, StoredOptionsThatNameFilesAreIgnored) {
  const Arguments small = {"--size", "8x8", "--samples", "1", "--progress", "none"};
  const auto expected = renderPlain(small);
  const std::string secret = folder.write("secret.exr", "confidential").string();
  for (const auto& [attribute, name] : std::vector<std::pair<std::string, std::string>>{
           {"transfer=\"" + secret + "\"", "transfer"},
           {"transfer=\"secret.exr\"", "transfer"},
           {"lights=\"" + secret + "\"", "lights"},
           {"lights=\"{&quot;lights&quot;: [{&quot;type&quot;: &quot;environment&quot;, "
            "&quot;f\\u0069le&quot;: &quot;secret.exr&quot;}]}\"",
            "lights"},
           {"environment=\"" + secret + "\"", "environment"},
           {"preset=\"" + secret + "\"", "preset"},
           {"focus=\"A\" clip=\"none\" references=\"segmentation:" + secret + ";\"",
            "segmentation"}}) {
    writeScene(attribute);
    const Outcome outcome = render("image.exr", small);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    expectStated(outcome.err, "FenestraRender now (f): | (f): " + name + " | --" + name);
    EXPECT_EQ(outcome.err.find("confidential"), std::string::npos) << outcome.err;
    if (name != "segmentation") { // replaced by the scene's segmentation
      EXPECT_EQ(readImage(folder / "image.exr").channels, expected) << attribute;
    }
  }
}

TEST_F(UntrustedSceneCommand, StoredNamesAndValuesApply) {
  writeScene(R"(transfer="mr-knee" lights="headlight" environment="1,2,3" size="8x8" samples="1")");
  const Outcome named = render("named.exr", {"--echo"});
  EXPECT_EQ(named.status, 0);
  EXPECT_EQ(named.err, "");
  for (const char* option : {"transfer: mr-knee", "lights: headlight", "environment: 1,2,3"})
    EXPECT_NE(named.out.find(option), std::string::npos) << named.out;
}

TEST_F(UntrustedSceneCommand, StoredSizeAndSamplesAreLimited) {
  writeScene(R"(size="9000x9000" samples="100000000")");
  const Outcome outcome =
      render("image.exr", {"--progress", "none", "--seconds", "0.01", "--bounces", "0"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  expectStated(outcome.err, "FenestraRender now (f): | --size 9000x9000");
  EXPECT_EQ(readImage(folder / "image.exr").width, 512);
  writeScene(R"(size="8x8" samples="100000000")");
  const Outcome fewer = render("image.exr", {"--progress", "none"});
  EXPECT_EQ(fewer.status, 0) << fewer.err;
  expectStated(fewer.err, "FenestraRender now (f): | --samples 100000000");
}

/// A header in an archive must name only files in that archive.
TEST_F(UntrustedSceneCommand, ArchiveReferencesOnlyItsOwnFiles) {
  const std::string outside = folder.write("outside.raw", std::string(64, 'x')).string();
  const auto archive = [&](const std::string& header, bool asMeta) {
    const std::string name = asMeta ? "volume.mhd" : "volume.nhdr";
    int failure = 0;
    zip_t* zip = zip_open((folder / "scene.mrb").c_str(), ZIP_CREATE | ZIP_TRUNCATE, &failure);
    const std::string text = R"(<MRML><VolumeArchetypeStorage id="file" fileName=")" + name +
                             R"(" fileListMember0=")" + name + R"(" fileListMember1="inside.raw"/>
      <Volume id="v" references="storage:file;"/></MRML>)";
    const std::string inside(64, 'y');
    for (const auto& [member, content] : std::map<std::string, const std::string*>{
             {"s/s.mrml", &text}, {"s/" + name, &header}, {"s/inside.raw", &inside}})
      zip_file_add(zip, member.c_str(), zip_source_buffer(zip, content->data(), content->size(), 0),
                   0);
    zip_close(zip);
  };
  const auto render = [&] {
    return run({"scene.mrb", "--size", "8x8", "--samples", "1", "--output", "a.png"},
               folder.path());
  };
  for (const bool asMeta : {false, true}) {
    const auto header = [&](const std::string& data) {
      return asMeta ? "ObjectType = Image\nNDims = 3\nDimSize = 4 4 4\nElementType = MET_UCHAR\n"
                      "ElementDataFile = " +
                          data + "\n"
                    : "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 4 4 4\nencoding: raw\n"
                      "data file: " +
                          data + "\n";
    };
    archive(header("inside.raw"), asMeta);
    EXPECT_EQ(render().status, 0) << render().err;
    const std::string up = "../../../../../../../../../../../../.." + outside;
    for (const std::string& name : {outside, up}) {
      archive(header(name), asMeta);
      const Outcome outcome = render();
      EXPECT_EQ(outcome.status, 3) << outcome.err;
      expectErrorLine(outcome.err, " | outside.raw");
    }
  }
}

} // namespace
} // namespace fenestra::core::UntrustedSceneCommandTests
