// `fenestra serve --mapped-image`: the mapped image, its layers and its sizes.

#include "ServeTesting.h"
#include "files/images/DisplayTransform.h"
#include "files/images/FrameFile.h"
#include "files/images/ImageReader.h"

#include <cmath>

namespace fenestra::core::ServeFrameTests {
namespace {

/// A frame file, read when nothing writes it.
class FrameContent {
public:
  explicit FrameContent(const std::filesystem::path& path) : m_bytes(readBytes(path)) {}

  std::uint64_t word(std::size_t i) const { return read<std::uint64_t>(8 * i); }
  double number(std::size_t i) const { return read<double>(8 * i); }
  /// Empty: there is no such layer.
  template <typename Value>
  std::vector<Value> layer(const std::string& name) const {
    const std::size_t pixels = word(5) * word(6);
    std::vector<Value> values;
    for (std::size_t entry = 14; entry < 14 + 4 * word(13); entry += 4)
      if (m_bytes.substr(8 * entry, 8).c_str() == name) {
        EXPECT_EQ(word(entry + 3), sizeof(Value));
        for (std::size_t i = 0; i < pixels * word(entry + 2); ++i)
          values.push_back(read<Value>(word(entry + 1) + i * sizeof(Value)));
      }
    return values;
  }

private:
  template <typename Value>
  Value read(std::size_t offset) const {
    Value value{};
    std::memcpy(&value, m_bytes.substr(offset, sizeof value).data(), sizeof value);
    return value;
  }

  std::string m_bytes;
};

class ServeFrame : public ServeTest {
protected:
  static Arguments makeArguments(const Arguments& more) {
    Arguments all = {"serve", "volume.nrrd", "--mapped-image", "view.frame", "--samples", "2"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  /// Scales of the images of a change, in order.
  static std::vector<int> listScales(const Process& process, const json& id) {
    std::vector<int> scales;
    for (const json& event : readEvents(process))
      if (event["id"] == id)
        scales.push_back(event["scale"]);
    return scales;
  }
};

TEST_F(ServeFrame, ImageEqualsThePng) {
  Process process(makeArguments({"--size", "24x20", "--background", "transparent", "--output",
                                 "a.png", "--output", "a.exr"}),
                  folder.path());
  ASSERT_TRUE(waitForImage(process, "null")) << process.output();
  const FrameContent frame(folder / "view.frame");
  EXPECT_EQ(frame.word(2) % 2, 0u);
  EXPECT_EQ(frame.word(4), ~std::uint64_t{0}); // no id
  EXPECT_EQ(frame.word(5), 24u);
  EXPECT_EQ(frame.word(6), 20u);
  EXPECT_EQ(frame.word(9), 2u);
  EXPECT_EQ(frame.word(12), 1u);
  const Image png = readImage(folder / "a.png");
  const std::vector<float> color = frame.layer<float>("color");
  const auto display = frame.layer<std::uint8_t>("display");
  const std::vector<float> shown = toDisplay(color, Display());
  ASSERT_EQ(display.size(), 4u * 24 * 20);
  ASSERT_EQ(shown.size(), display.size());
  for (std::size_t i = 0; i < display.size(); ++i) {
    const float stored = 255.0F * png.channels.at(std::string(1, "RGBA"[i % 4]))[i / 4];
    ASSERT_EQ(display[i], std::lround(stored)) << i;
    ASSERT_EQ(display[i], std::lround(255.0F * shown[i])) << i;
  }
}

TEST_F(ServeFrame, FirstImagesAreCoarse) {
  Process process(makeArguments({"--size", "420x400"}), folder.path());
  ASSERT_TRUE(waitForImage(process, "null")) << process.output();
  const std::vector<int> scales = listScales(process, nullptr);
  ASSERT_GE(scales.size(), 3u);
  EXPECT_EQ(scales[0], 4);
  EXPECT_EQ(scales[1], 2);
  EXPECT_EQ(scales.back(), 1);
  EXPECT_EQ(listFiles(folder.path()).size(), 3u); // two inputs and the frame
  process.write(R"({"id": 7, "size": "230x210"})"
                "\n");
  ASSERT_TRUE(waitForImage(process, "7")) << process.output();
  EXPECT_EQ(listScales(process, 7).front(), 2);
  const FrameContent frame(folder / "view.frame");
  EXPECT_EQ(frame.word(4), 7u);
  EXPECT_EQ(frame.word(5), 230u);
  process.write(R"({"id": 8, "size": "100x199"})"
                "\n");
  ASSERT_TRUE(waitForImage(process, "8")) << process.output();
  EXPECT_EQ(listScales(process, 8).front(), 1); // a coarse image would be too small
}

TEST_F(ServeFrame, HasTheCamera) {
  Process process(
      makeArguments({"--size", "16x16", "--position", "5,60,9", "--target", "1,2,3", "--up",
                     "0,0.1,1", "--projection", "perspective", "--angle", "20.5"}),
      folder.path());
  ASSERT_TRUE(waitForImage(process, "null")) << process.output();
  const FrameContent frame(folder / "view.frame");
  const std::vector<double> expected = {5, 60, 9, 1, 2, 3, 0, 0.1, 1};
  for (std::size_t i = 0; i < expected.size(); ++i)
    EXPECT_EQ(frame.number(46 + i), expected[i]);
  EXPECT_EQ(frame.word(55), 0u);
  EXPECT_EQ(frame.number(56), 20.5);
}

TEST_F(ServeFrame, UnusableFilesAreRefused) {
  expectErrors(
      {{"input", {"serve", "volume.nrrd", "--mapped-image", "volume.nrrd"}, 2, "volume.nrrd:"},
       {"folder", {"serve", "volume.nrrd", "--mapped-image", "."}, 4, ".:"},
       {"no folder",
        {"serve", "volume.nrrd", "--mapped-image", "no/view.frame"},
        4,
        "no/view.frame:"},
       {"stream", {"serve", "volume.nrrd", "--mapped-image", "/dev/stdout"}, 4, "/dev/stdout:"},
       {"result",
        {"serve", "volume.nrrd", "--mapped-image", "a.png", "--output", "a.png"},
        2,
        "a.png:"},
       {"render", {"render", "volume.nrrd", "--mapped-image", "view.frame"}, 2, "--mapped-image:"}},
      folder.path());
}

} // namespace
} // namespace fenestra::core::ServeFrameTests
