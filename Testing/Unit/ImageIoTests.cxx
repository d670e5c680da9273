// Round trips of images through files: which values are preserved, and the effects of a failure.

#include "ImageTesting.h"
#include "io/EmbeddedResources.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfTiledOutputFile.h>
#include <gtest/gtest.h>

#include <bit>
#include <csignal>
#include <fstream>
#include <functional>
#include <sstream>

#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

namespace fenestra::core::ImageIoTests {
using namespace std::string_literals;
using namespace testing_images;

namespace {

constexpr float infinite = std::numeric_limits<float>::infinity();
constexpr float notANumber = std::numeric_limits<float>::quiet_NaN();

Image makePixel(float r, float g, float b, float a) {
  return {1, 1, {{"R", {r}}, {"G", {g}}, {"B", {b}}, {"A", {a}}}, {}};
}

/// Full disk: during the object's lifetime no file grows beyond `bytes`.
class FullDisk {
public:
  explicit FullDisk(rlim_t bytes) : m_handler(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &m_before);
    const rlimit limit{bytes, m_before.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FullDisk() {
    ::setrlimit(RLIMIT_FSIZE, &m_before);
    std::signal(SIGXFSZ, m_handler);
  }

private:
  rlimit m_before{};
  void (*m_handler)(int);
};

using ExrFiles = ImageFiles;
using NrrdFiles = ImageFiles;
using DisplayFiles = ImageFiles;

TEST(EmbeddedResources, ContainTheColorConfiguration) {
  EXPECT_TRUE(findResource("color/fenestra.ocio").starts_with("ocio_profile_version"));
  EXPECT_TRUE(findResource("color/other.ocio").empty());
  EXPECT_EQ(listResources("color/"), std::vector<std::string>{"color/fenestra.ocio"});
  EXPECT_TRUE(listResources("nothing/").empty());
}

TEST_F(ExrFiles, RoundTripPreservesChannelsBitForBitAndTheHeader) {
  Image image = makeTestImage();
  image.channels["Z"][3] = infinite;
  image.channels["R"][0] = notANumber;
  image.channels["G"][1] = -infinite;
  image.channels["B"][2] = -0.0f;
  image.channels["A"][2] = std::numeric_limits<float>::denorm_min();
  image.header["empty"] = "";
  image.header["a key of more than thirty-one characters"] = std::string(3000, 'v');
  const Image read = readImage(save(image, "a.exr"));
  EXPECT_EQ(read.width, image.width);
  EXPECT_EQ(read.height, image.height);
  EXPECT_EQ(read.header, image.header);
  ASSERT_EQ(read.channels.size(), image.channels.size());
  for (const auto& [name, plane] : image.channels)
    for (std::size_t i = 0; i < plane.size(); ++i)
      EXPECT_EQ(std::bit_cast<std::uint32_t>(read.channels.at(name)[i]),
                std::bit_cast<std::uint32_t>(plane[i]))
          << name << " " << i;
}

TEST_F(ExrFiles, TilesOfHalfFloatAndIntegerWithAnOffsetWindowAreRead) {
  const int width = 21, height = 10;
  std::vector<Imath::half> halves(static_cast<std::size_t>(width * height));
  std::vector<unsigned> integers(halves.size());
  for (std::size_t i = 0; i < halves.size(); ++i) {
    halves[i] = Imath::half(static_cast<float>(i) * 0.5f);
    integers[i] = static_cast<unsigned>(3 * i);
  }
  const Imath::Box2i window({-4, 5}, {-4 + width - 1, 5 + height - 1});
  Imf::Header header(window, window);
  header.setTileDescription(Imf::TileDescription(8, 8));
  header.channels().insert("Y", Imf::Channel(Imf::HALF));
  header.channels().insert("id", Imf::Channel(Imf::UINT));
  Imf::FrameBuffer frame;
  frame.insert("Y", Imf::Slice::Make(Imf::HALF, halves.data(), window));
  frame.insert("id", Imf::Slice::Make(Imf::UINT, integers.data(), window));
  {
    Imf::TiledOutputFile file(path("tiled.exr").c_str(), header);
    file.setFrameBuffer(frame);
    file.writeTiles(0, file.numXTiles() - 1, 0, file.numYTiles() - 1);
  }
  const Image read = readImage(path("tiled.exr"));
  EXPECT_EQ(read.width, width);
  EXPECT_EQ(read.height, height);
  for (std::size_t i = 0; i < halves.size(); ++i) {
    EXPECT_EQ(read.channels.at("Y")[i], static_cast<float>(i) * 0.5f);
    EXPECT_EQ(read.channels.at("id")[i], static_cast<float>(3 * i));
  }
}

TEST_F(ImageFiles, EqualImagesGiveEqualBytes) {
  for (const char* extension : {".exr", ".nrrd", ".png", ".tif"}) {
    const auto first = save(makeTestImage(), std::string("first") + extension);
    const auto second = save(makeTestImage(), std::string("second") + extension);
    EXPECT_EQ(readContent(first), readContent(second)) << extension;
    EXPECT_GT(readContent(first).size(), 100u) << extension;
  }
}

TEST_F(NrrdFiles, RoundTripPreservesColorAndDepth) {
  Image image = makeTestImage();
  image.channels["A"][5] = 0.25f;
  image.channels["Z"][3] = infinite;
  image.channels["R"][2] = -7.5f;
  const Image color = readImage(save(image, "view.nrrd"));
  EXPECT_EQ(color.channels.size(), 4u);
  for (const char* name : {"R", "G", "B", "A"})
    EXPECT_EQ(color.channels.at(name), image.channels.at(name)) << name;
  const Image depth = readImage(path("view-Z.nrrd"));
  EXPECT_EQ(depth.channels.size(), 1u);
  EXPECT_EQ(depth.channels.at("Z"), image.channels.at("Z"));
  EXPECT_EQ(fileCount(), 2u);
}

TEST_F(NrrdFiles, MissingAlphaIsOpaqueAndMissingDepthWritesOneFile) {
  Image image = makeTestImage();
  image.channels.erase("A");
  image.channels.erase("Z");
  const Image color = readImage(save(image, "view.nrrd"));
  EXPECT_EQ(color.channels.at("A"), std::vector<float>(image.channels["R"].size(), 1.0f));
  EXPECT_EQ(fileCount(), 1u);
}

TEST_F(NrrdFiles, ForeignDepthFileIsNotReplaced) {
  const Image image = makeTestImage();
  save(image, "view.nrrd"); // its depth file has the provenance tag
  save(image, "view.nrrd");
  std::string depth = readContent(path("view-Z.nrrd"));
  const std::size_t tag = depth.find("Software:=");
  writeContent(path("view-Z.nrrd"), depth.erase(tag, depth.find('\n', tag) + 1 - tag));
  save(image, "view.nrrd"); // same grid: accepted as a file of an earlier version
  writeContent(path("view-Z.nrrd"), "foreign content");
  catchError(ErrorKind::request, "foreign-output: view-Z.nrrd", [&] { save(image, "view.nrrd"); });
  EXPECT_EQ(readContent(path("view-Z.nrrd")), "foreign content");
}

TEST_F(DisplayFiles, DefaultNameReplacesOnlyFilesWrittenByFenestra) {
  for (const bool isOwn : {true, false}) {
    if (!isOwn)
      writeContent(path("a.png"), "foreign content");
    const auto declare = [&] {
      Outputs outputs;
      declareImage(path("a.png"), outputs, NameOrigin::standard);
    };
    if (isOwn) {
      declare();
      save(makeTestImage(), "a.png");
      declare();
    } else {
      catchError(ErrorKind::request, "foreign-output: a.png", declare);
    }
  }
}

TEST_F(NrrdFiles, HeaderContainsThePlaneInLps) {
  // View from anterior: the patient's right is on the left of the image, superior is up.
  const ImagePlane plane{{90.0, 100.0, 80.0}, {-0.5, 0.0, 0.0}, {0.0, 0.0, -0.25}};
  const std::string content = readContent(save(makeTestImage(), "view.nrrd", plane));
  const std::string header = content.substr(0, content.find("\n\n"));
  for (const char* line : {"space: left-posterior-superior", "sizes: 4 13 7 1", "type: float",
                           "space directions: none (0.5,0,0) (0,0,-0.25) (0,0.5,0)",
                           "space origin: (-90,-100,80)", "kinds: vector domain domain domain"})
    EXPECT_NE(header.find(line), std::string::npos) << line << "\nin\n" << header;
}

TEST_F(NrrdFiles, PlaneKeepsThePrecisionOfDoubles) {
  const ImagePlane plane{
      {1.0 / 3.0, 0.0, 0.0}, {0.6 / 7.0, 0.8 / 7.0, 0.0}, {0.0, 0.0, -1.0 / 7.0}};
  const std::string content = readContent(save(makeTestImage(), "view.nrrd", plane));
  const auto numberAfter = [&](const std::string& text) {
    return std::stod(content.substr(content.find(text) + text.size()));
  };
  EXPECT_NEAR(numberAfter("space origin: ("), -1.0 / 3.0, 1e-15);
  EXPECT_NEAR(numberAfter("space directions: none ("), -0.6 / 7.0, 1e-15);
}

TEST_F(DisplayFiles, KnownValuesHaveStraightAlpha) {
  // Middle gray is 0.4614 in sRGB: 117.6 of 255.
  const float gray = 0.18f;
  for (const auto& [name, tolerance] :
       {std::pair("a.png", 0.5f / 255.0f), std::pair("a.tif", 0.5f / 65535.0f)}) {
    const Image read = readImage(
        save(makePixel(gray / 2, gray / 2, gray / 2, 0.5f), name, {}, {DisplayView::standard}));
    EXPECT_NEAR(read.channels.at("R")[0], 0.46135f, tolerance + 2e-5f) << name;
    EXPECT_NEAR(read.channels.at("A")[0], 0.5f, tolerance + 2e-5f) << name;
  }
  EXPECT_EQ(readImage(path("a.png")).channels.at("G")[0], 118.0f / 255.0f);
  EXPECT_EQ(readImage(path("a.png")).channels.at("A")[0], 128.0f / 255.0f);
}

TEST_F(DisplayFiles, AlphaIsWrittenOnlyWithTransparency) {
  Image image = makeTestImage();
  EXPECT_EQ(readImage(save(image, "opaque.png")).channels.count("A"), 0u);
  EXPECT_EQ(readImage(save(image, "opaque.tiff")).channels.count("A"), 0u);
  image.channels["A"][3] = 0.75f;
  EXPECT_EQ(readImage(save(image, "clear.png")).channels.count("A"), 1u);
  EXPECT_EQ(readImage(save(image, "clear.TIF")).channels.count("A"), 1u);
}

TEST_F(DisplayFiles, TopRowStaysOnTop) {
  Image image{2, 2, {}, {}};
  for (const char* name : {"R", "G", "B"})
    image.channels[name] = {1.0f, 0.5f, 0.0f, 0.0f};
  for (const char* name : {"a.png", "a.tif", "a.exr", "a.nrrd"}) {
    const Image read = readImage(save(image, name));
    EXPECT_GT(read.channels.at("R")[0], read.channels.at("R")[1]) << name;
    EXPECT_GT(read.channels.at("R")[1], read.channels.at("R")[2]) << name;
    EXPECT_EQ(read.channels.at("R")[2], read.channels.at("R")[3]) << name;
  }
}

TEST_F(DisplayFiles, NanIsBlackAndInfinityIsWhite) {
  const Image read = readImage(save(makePixel(notANumber, infinite, -infinite, 1.0f), "a.png"));
  EXPECT_EQ(read.channels.at("R")[0], 0.0f);
  EXPECT_EQ(read.channels.at("G")[0], 1.0f);
  EXPECT_EQ(read.channels.at("B")[0], 0.0f);
}

TEST_F(ImageFiles, UnknownFormatAndMissingColorAreRejected) {
  const auto write = [](const Image& image, const fs::path& file) {
    return [=] { writeImage(image, {}, file); };
  };
  catchError(ErrorKind::request, "unsupported-file | .exr, .nrrd, .png or .tif",
             write(makeTestImage(), path("a.jpg")));
  Outputs outputs;
  catchError(ErrorKind::request, "unsupported-file | .exr, .nrrd, .png or .tif",
             [&] { declareImage(path("a"), outputs); });
  declareImage(path("a.png"), outputs);
  Image depth = makeTestImage();
  depth.channels.erase("G");
  catchError(ErrorKind::request, "unsupported-file: a.png", write(depth, path("a.png")));
  catchError(ErrorKind::request, "unsupported-file: a.nrrd", write(depth, path("a.nrrd")));
  EXPECT_EQ(fileCount(), 0u);
}

TEST_F(ImageFiles, FailedWriteKeepsThePreviousFile) {
  const Image image = makeTestImage(300, 200);
  for (const std::string name : {"a.exr", "a.nrrd", "a.png", "a.tif"}) {
    writeImage(image, {}, path(name));
    const std::string before = readContent(path(name));
    const std::size_t count = fileCount();
    // Limits at the start, in the middle, and within the last block, after which a buffered writer
    // makes no further checks.
    for (const std::size_t limit : {std::size_t{0}, before.size() / 2, before.size() - 1}) {
      const FullDisk full(limit);
      ::testing::internal::CaptureStderr();
      catchError(ErrorKind::output, "unwritable-file: " + name,
                 [&] { writeImage(image, {}, path(name)); });
      EXPECT_EQ(::testing::internal::GetCapturedStderr(), "") << name << " " << limit;
    }
    EXPECT_EQ(fileCount(), count) << name;
    EXPECT_EQ(readContent(path(name)), before) << name;
    catchError(ErrorKind::output, "unwritable-file: " + name,
               [&] { writeImage(image, {}, path("missing/" + name)); });
  }
}

TEST_F(ImageFiles, ReferenceImageIsRead) {
  const fs::path reference = fs::path(FENESTRA_REFERENCE) / "S1_best.exr";
  if (!fs::exists(reference))
    GTEST_SKIP() << "no reference images in " << FENESTRA_REFERENCE;
  const Image image = readImage(reference);
  EXPECT_GT(image.width, 0);
  for (const char* name : {"R", "G", "B"})
    for (const float value : image.channels.at(name))
      ASSERT_TRUE(std::isfinite(value));
}

} // namespace
} // namespace fenestra::core::ImageIoTests
