// Files that cannot be read or written: one error line, exit status 3 or 4, no remaining file.

#include "CommandTesting.h"

#include <cstdlib>
#include <map>

namespace fenestra::core::FilesCommandTests {
namespace {

class FilesCommand : public SmallScene {};

TEST_F(FilesCommand, RejectsInputThatIsNotAVolume) {
  folder.write("text.nrrd", "These are\nonly words.\n");
  folder.write("text.txt", "words");
  folder.write(".nrrd", NrrdText().encode(makeRamp()));
  folder.write("a.seg.vtm", "<VTKFile/>");
  folder.write("empty.nrrd", "");
  folder.write("image.nrrd", "\x89PNG\r\n\x1a\n0000");
  folder.write("image.png", "\x89PNG\r\n\x1a\n0000");
  folder.write("flat.nrrd", NrrdText{"8 8"}.encode(makeRamp()));
  folder.write("frames.nrrd", NrrdText{"4 4 2 2"}.encode(makeRamp()));
  folder.write("none.nrrd", NrrdText{"0 4 4"}.encode(""));
  folder.write("negative.nrrd", NrrdText{"-4 4 4"}.encode(makeRamp()));
  expectErrors(
      {
          {"missing", {"missing.nrrd"}, 3, "missing.nrrd: "},
          {"a folder", {"."}, 3, ".: "},
          {"a device", {"/dev/zero"}, 3, "/dev/zero: "},
          {"an empty name", {""}, 2, "INPUT:"},
          {"a folder without a name", {"/"}, 2, "--output:"},
          {"only an extension", {".nrrd"}, 2, "--output:"},
          {"a segmentation", {"a.seg.vtm"}, 3, "a.seg.vtm:"},
          {"text", {"text.nrrd"}, 3, "text.nrrd:"},
          {"unknown extension", {"text.txt"}, 3, "text.txt: | .nrrd"},
          {"an empty file", {"empty.nrrd"}, 3, "empty.nrrd:"},
          {"a PNG called NRRD", {"image.nrrd", "--output", "p.png"}, 3, "image.nrrd:"},
          {"a PNG", {"image.png"}, 3, "image.png:"},
          {"two axes", {"flat.nrrd"}, 3, "flat.nrrd: | 2 axes"},
          {"no such frame", {"frames.nrrd", "--frame", "2"}, 3, "frames.nrrd: | 2"},
          {"no voxels", {"none.nrrd"}, 3, "none.nrrd: sizes: "},
          {"negative size", {"negative.nrrd"}, 3, "negative.nrrd: sizes: "},
      },
      folder.path());
}

TEST_F(FilesCommand, RejectsTruncatedVolumes) {
  const std::string deflated = compressGzip(makeRamp(), folder);
  NrrdText gzip{"4 4 4", "int16", "gzip"};
  folder.write("raw.nrrd", NrrdText().encode(makeRamp().substr(1)));
  folder.write("gzip.nrrd", gzip.encode(deflated.substr(0, deflated.size() - 12)));
  folder.write("larger.nrrd", NrrdText{"400 400 400"}.encode(makeRamp()));
  gzip.sizes = "400 400 400";
  folder.write("largergzip.nrrd", gzip.encode(deflated));
  folder.write("huge.nrrd", NrrdText{"100000 100000 100000"}.encode(makeRamp()));
  gzip.sizes = "100000 100000 100000";
  folder.write("hugegzip.nrrd", gzip.encode(deflated));
  expectErrors(
      {
          {"raw", {"raw.nrrd"}, 3, "raw.nrrd: | 128 bytes | 127"},
          {"gzip", {"gzip.nrrd"}, 3, "gzip.nrrd: "},
          {"larger than the file", {"larger.nrrd"}, 3, "larger.nrrd:"},
          {"larger than gzip holds", {"largergzip.nrrd"}, 3, "largergzip.nrrd:"},
          {"larger than memory", {"huge.nrrd"}, 3, "huge.nrrd:"},
          {"gzip larger than memory", {"hugegzip.nrrd"}, 3, "hugegzip.nrrd:"},
      },
      folder.path());
}

TEST_F(FilesCommand, RejectsMissingOrEmptyFocus) {
  std::string far = makeSegments();
  const std::string origin = "space origin: (0,0,0)";
  far.replace(far.find(origin), origin.size(), "space origin: (5000,0,0)");
  folder.write("far.seg.nrrd", far);
  const std::string id = "Segment0_ID:=A";
  std::string fractional = makeSegments();
  fractional.insert(fractional.find(id),
                    "Segmentation_MasterRepresentation:=Fractional labelmap\n");
  folder.write("fractional.seg.nrrd", fractional);
  folder.write("blank.seg.nrrd", NrrdText{"4 4 4", "uint8"}.encode(std::string(64, '\0')));
  const auto focusArguments = [](const std::string& file, const std::string& segment) {
    return Arguments{"volume.nrrd", "--segmentation", file, "--focus", segment};
  };
  expectErrors(
      {
          {"unknown", focusArguments("segments.seg.nrrd", "C"), 3,
           "segments.seg.nrrd: | \"C\" | A (Bone, left), B (Void)"},
          {"comma not escaped", focusArguments("segments.seg.nrrd", "Bone, left"), 3,
           "segments.seg.nrrd: | \"Bone\""},
          {"no segments", focusArguments("blank.seg.nrrd", "1"), 3, "blank.seg.nrrd: | \"1\""},
          {"no voxel", focusArguments("segments.seg.nrrd", "B"), 3,
           "segments.seg.nrrd: | B (Void)"},
          {"outside the volume", focusArguments("far.seg.nrrd", "A"), 3, "focus Bone, left:"},
          {"fractional", focusArguments("fractional.seg.nrrd", "A"), 3,
           "fractional.seg.nrrd: Segmentation_MasterRepresentation:"},
          {"missing file", focusArguments("missing.seg.nrrd", "A"), 3, "missing.seg.nrrd: "},
          {"empty name", focusArguments("segments.seg.nrrd", "A,,B"), 2, "--focus:"},
      },
      folder.path());
}

TEST_F(FilesCommand, RejectsMissingOrDamagedAppearance) {
  folder.write("cut.json", R"({"extinction": [[0,)");
  folder.write("word.json", R"({"extinction": [[0, "x"]], "albedo": [[0, 1, 1, 1]]})");
  folder.write("words.vp", "words");
  folder.write("none.vp.json", R"({"volumeProperties": []})");
  folder.write("spot.json", R"({"lights": [{"type": "spot"}]})");
  folder.write("dark.exr", "not an image");
  const std::string albedo = R"("albedo": [[0, 1, 1, 1]], "g": 0, "shading": )";
  folder.write("hybrid.json", R"({"extinction": [[0, 0], [9, 1]], )" + albedo + R"("hybrid"})");
  folder.write("thick.json", R"({"extinction": [[0, 0], [9, 1e20]], )" + albedo + R"("volume"})");
  folder.write("constant.nrrd", NrrdText().encode(std::string(128, '\1')));
  const auto makeArguments = [](const std::string& option, const std::string& value) {
    return Arguments{"volume.nrrd", option, value};
  };
  expectErrors(
      {
          {"transfer preset", makeArguments("--transfer", "ct-bones"), 3,
           "ct-bones: | ct-anatomy, ct-bone, ct-contrast"},
          {"transfer file", makeArguments("--transfer", "missing.vp"), 3, "missing.vp:"},
          {"truncated .json", makeArguments("--transfer", "cut.json"), 3, "cut.json:"},
          {"word for a number", makeArguments("--transfer", "word.json"), 3, "extinction[0][1]: "},
          {"damaged .vp", makeArguments("--transfer", "words.vp"), 3, "words.vp:"},
          {"empty .vp.json", makeArguments("--transfer", "none.vp.json"), 3,
           "none.vp.json: volumeProperties:"},
          {"a volume", makeArguments("--transfer", "volume.nrrd"), 3, "volume.nrrd:"},
          {"excessive extinction", makeArguments("--transfer", "thick.json"), 3,
           "thick.json: extinction: | 1e+20"},
          {"zero gradient", {"constant.nrrd", "--transfer", "hybrid.json"}, 3, "constant.nrrd:"},
          {"light preset", makeArguments("--lights", "sun"), 3,
           "sun: | amber, cinema, headlight, soft, studio"},
          {"light type", makeArguments("--lights", "spot.json"), 3, "spot.json: lights[0].type: "},
          {"truncated lights", makeArguments("--lights", "cut.json"), 3, "cut.json:"},
          {"truncated inline JSON", makeArguments("--lights", R"({"lights": [)"), 3,
           "lights: | byte 13"},
          {"no lights", makeArguments("--lights", "{}"), 3, "lights: | \"lights\""},
          {"light type in inline JSON",
           makeArguments("--lights", R"({"lights": [{"type": "spot"}]})"), 3,
           "lights: lights[0].type:"},
          {"key with a line break", makeArguments("--lights", R"({"a\nb": 1})"), 3, "lights:"},
          {"map in inline JSON",
           makeArguments("--lights",
                         R"({"lights": [{"type": "environment", "file": "missing.exr"}]})"),
           3, "missing.exr:"},
          {"inline transfer function", makeArguments("--transfer", R"({"extinction": []})"), 3,
           "transfer function: extinction:"},
          {"environment", makeArguments("--environment", "missing.exr"), 3, "missing.exr: "},
          {"damaged environment", makeArguments("--environment", "dark.exr"), 3, "dark.exr: "},
      },
      folder.path());
}

/// A loop of symbolic links is unreadable for every user, unlike missing permissions for root.
TEST_F(FilesCommand, ErrorNamesAnUnreadablePathAndTheCause) {
  std::filesystem::create_symlink("loop", folder / "loop");
  folder.write("s.mrml", R"(<MRML><Volume id="v" references="storage:s;"/>)"
                         R"(<VolumeArchetypeStorage id="s" fileName="loop/a.nrrd"/></MRML>)");
  const std::string reason = ": | Too many levels of symbolic links | its symbolic";
  const auto makeArguments = [](const std::string& option, const std::string& value) {
    return Arguments{"volume.nrrd", option, value};
  };
  expectErrors(
      {
          {"input", {"loop/a.nrrd"}, 3, "loop/a.nrrd" + reason},
          {"input of inspect", {"inspect", "loop/a.nrrd"}, 3, "loop/a.nrrd" + reason},
          {"series", {"loop/a", "--volume", "1"}, 3, "loop/a" + reason},
          {"series of inspect", {"inspect", "loop/a", "--volume", "1"}, 3, "loop/a" + reason},
          {"file of a scene", {"s.mrml"}, 3, "s.mrml: loop/a.nrrd: | Too many levels"},
          {"transfer", makeArguments("--transfer", "loop/t.vp"), 3, "loop/t.vp" + reason},
          {"lights", makeArguments("--lights", "loop/l.json"), 3, "loop/l.json" + reason},
          {"preset", makeArguments("--preset", "loop/p.json"), 3, "loop/p.json" + reason},
          {"output of a turntable",
           {"turntable", "volume.nrrd", "--output", "loop/t.png"},
           4,
           "loop/t.turntable.json: | Too many levels"},
      },
      folder.path());
  const Outcome inspected =
      run({"inspect", "s.mrml", "--segmentation", "loop/a.seg.nrrd"}, folder.path());
  expectStated(inspected.out, "loop/a.seg.nrrd: | Too many levels");
}

TEST_F(FilesCommand, AbsolutePathsWorkInADeletedFolder) {
  std::filesystem::create_directory(folder / "gone");
  const std::string folderPath = folder.path().string();
  const auto runInDeletedFolder = [&](const std::string& arguments) {
    return std::system(("cd " + folderPath + "/gone && rmdir " + folderPath + "/gone && " +
                        FENESTRA_EXECUTABLE + " " + arguments + " --samples 1 --size 8x8 2>" +
                        folderPath + "/stderr.txt >&2; status=$?; mkdir -p " + folderPath +
                        "/gone; exit $status")
                           .c_str()) >>
           8;
  };
  EXPECT_EQ(runInDeletedFolder(folderPath + "/volume.nrrd --output " + folderPath + "/a.png"), 0)
      << readBytes(folder / "stderr.txt");
  EXPECT_EQ(runInDeletedFolder(folderPath + "/volume.nrrd"), 4);
  expectErrorLine(readBytes(folder / "stderr.txt"), "volume.png: | No such file");
}

TEST_F(FilesCommand, RejectsUnwritableOutputs) {
  std::filesystem::create_directory(folder / "folder.png");
  std::filesystem::create_directory(folder / "depth-Z.nrrd");
  folder.write("a-Z.nrrd", NrrdText().encode(makeRamp()));
  const auto outputArguments = [](const std::string& file) {
    return Arguments{"volume.nrrd", "--output", file};
  };
  const std::string extensions = ": | .exr, .nrrd, .png or .tif";
  expectErrors(
      {
          {"missing folder", outputArguments("missing/a.png"), 4, "missing/a.png:"},
          {"a folder", outputArguments("folder.png"), 4, "folder.png:"},
          {"depth is a folder", outputArguments("depth.nrrd"), 4, "depth-Z.nrrd:"},
          {"no permission", outputArguments("/proc/a.png"), 4, "/proc/a.png:"},
          {"a device", outputArguments("/dev/full"), 2, "/dev/full" + extensions},
          {"unknown extension", outputArguments("a.gif"), 2, "a.gif" + extensions},
          {"no extension", outputArguments("a"), 2, "a" + extensions},
          {"second of two",
           {"volume.nrrd", "--output", "a.png", "--output", "b"},
           2,
           "b" + extensions},
          {"the input", outputArguments("./volume.nrrd"), 2, "./volume.nrrd:"},
          {"twice", {"volume.nrrd", "--output", "a.png", "--output", "./a.png"}, 2, "./a.png:"},
          {"stats over the image",
           {"volume.nrrd", "--output", "a.png", "--stats-json", "a.png"},
           2,
           "a.png:"},
          {"stats over the input",
           {"volume.nrrd", "--stats-json", "volume.nrrd"},
           2,
           "volume.nrrd:"},
          {"depth over the input", {"a-Z.nrrd", "--output", "a.nrrd"}, 2, "a-Z.nrrd:"},
          {"no color", {"volume.nrrd", "--layers", "depth"}, 2, "--layers:"},
          {"PNG without color",
           {"volume.nrrd", "--layers", "depth", "--output", "a.exr", "--output", "b.png"},
           2,
           "--layers:"},
          {"stats", {"volume.nrrd", "--stats-json", "missing/a.json"}, 4, "missing/a.json: "},
          {"stats on a device", {"volume.nrrd", "--stats-json", "/dev/full"}, 4, "/dev/full:"},
      },
      folder.path());
}

/// Uncompressed TIFF of one gray pixel, with the tags of TIFF 6.0; 274 is Orientation.
std::string makeTiff(std::uint16_t orientation) {
  const auto bytes = [](std::uint32_t value, int count) {
    std::string text;
    for (int i = 0; i < count; ++i)
      text += static_cast<char>(value >> (8 * i) & 0xffU);
    return text;
  };
  const std::map<std::uint16_t, std::uint32_t> tags = {
      {256, 1}, {257, 1},           {258, 8}, {259, 1}, {262, 1},
      {273, 8}, {274, orientation}, {277, 1}, {278, 1}, {279, 1}};
  constexpr int isShort = 3;
  std::string tiff =
      "II" + bytes(42, 2) + bytes(10, 4) + "xx" + bytes(static_cast<std::uint32_t>(tags.size()), 2);
  for (const auto& [tag, value] : tags)
    tiff += bytes(tag, 2) + bytes(isShort, 2) + bytes(1, 4) + bytes(value, 4);
  return tiff + bytes(0, 4);
}

TEST_F(FilesCommand, CompareRejectsARotatedTiff) {
  folder.write("upright.tif", makeTiff(1));
  folder.write("turned.tif", makeTiff(3));
  EXPECT_EQ(run({"compare", "upright.tif", "upright.tif"}, folder.path()).status, 0);
  expectErrors(
      {{"turned", {"compare", "upright.tif", "turned.tif"}, 3, "turned.tif: Orientation: | 3"}},
      folder.path());
}

TEST_F(FilesCommand, CompareRejectsDifferentSizesAndUnreadableImages) {
  ASSERT_EQ(renderVolume({"--output", "a.png"}).status, 0);
  ASSERT_EQ(renderVolume({"--size", "8x8", "--output", "b.png"}).status, 2) << "--size twice";
  ASSERT_EQ(
      run({"volume.nrrd", "--size", "8x8", "--samples", "1", "--output", "b.png"}, folder.path())
          .status,
      0);
  folder.write("text.txt", "words");
  folder.write("text.png", "words");
  expectErrors(
      {
          {"sizes", {"compare", "a.png", "b.png"}, 3, "a.png, b.png: "},
          {"missing", {"compare", "a.png", "missing.png"}, 3, "missing.png: "},
          {"text", {"compare", "a.png", "text.txt"}, 3, "text.txt:"},
          {"damaged", {"compare", "a.png", "text.png"}, 3, "text.png: "},
          {"one image", {"compare", "a.png"}, 2, "B:"},
          {"over an input", {"compare", "a.png", "a.png", "--output", "a.png"}, 2, "a.png:"},
          {"unwritable", {"compare", "a.png", "a.png", "--output", "no/a.png"}, 4, "no/a.png: "},
      },
      folder.path());
}

TEST_F(FilesCommand, PhantomRejectsBadKindSizeOrFolder) {
  const auto phantomArguments = [](const std::string& where) {
    return Arguments{"phantom", "knee", "--size", "16x16x16", "--output", where};
  };
  expectErrors(
      {
          {"kind", {"phantom", "elbow"}, 2, "KIND:"},
          {"no kind", {"phantom"}, 2, "KIND:"},
          {"one number", {"phantom", "knee", "--size", "64"}, 2, "--size:"},
          {"too small", {"phantom", "knee", "--size", "1x1x1"}, 2, "size: | 16 | 1024"},
          {"too large", {"phantom", "knee", "--size", "99999x16x16"}, 2, "size: | 16 | 1024"},
          {"no permission", phantomArguments("/proc/knee"), 4, "/proc/knee:"},
          {"a file", phantomArguments("volume.nrrd"), 4, "volume.nrrd:"},
          {"a device", phantomArguments("/dev/null"), 4, "/dev/null:"},
      },
      folder.path());
}

} // namespace
} // namespace fenestra::core::FilesCommandTests
