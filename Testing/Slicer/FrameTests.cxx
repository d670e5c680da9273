// The frame file: the renderer's writer and the extension's reader, in one process at two
// addresses.

#include "FenestraFrame.h"
#include "TemporaryFolder.h"
#include "files/images/FrameFile.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <functional>
#include <limits>
#include <thread>

namespace fenestra::core {
namespace {

using SlicerExport::Frame;
using SlicerExport::FrameState;
using SlicerExport::readFrame;

class SlicerFrame : public ::testing::Test {
protected:
  SlicerFrame() {
    outputs.add(path);
    file.emplace(path, outputs);
  }

  /// Publishes an image whose values all follow from `number`.
  void publish(int number, int width, int height, bool hasMiddle = true) {
    const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    const std::vector<std::uint8_t> display(4 * pixels, static_cast<std::uint8_t>(number));
    const std::vector<float> depth(pixels, static_cast<float>(number));
    std::vector<float> middle(pixels, static_cast<float>(number) + 0.5F);
    middle.back() = std::numeric_limits<float>::infinity();
    std::vector<FrameLayer> layers = {{"display", 4, 1, std::as_bytes(std::span(display))},
                                      {"depth", 1, 4, std::as_bytes(std::span(depth))}};
    if (hasMiddle)
      layers.push_back({"depth50", 1, 4, std::as_bytes(std::span(middle))});
    file->publish({number,
                   width,
                   height,
                   2 * width,
                   2 * height,
                   3,
                   0.5,
                   std::nan(""),
                   number > 5,
                   {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}, number > 5, 30.5}},
                  layers);
  }

  /// Maps the file as another process does, and reads it.
  FrameState read(Frame& frame) const {
    MappedFile mapped(path);
    mapped.extend(std::filesystem::file_size(path));
    return readFrame(mapped.bytes().data(), mapped.bytes().size(), frame);
  }

  const TemporaryFolder folder;
  const std::filesystem::path path = folder / "view.frame";
  Outputs outputs;
  std::optional<FrameFile> file;
};

TEST_F(SlicerFrame, IsEmptyThenHasTheLatestImage) {
  Frame frame;
  EXPECT_EQ(read(frame), FrameState::empty);
  publish(7, 5, 3);
  ASSERT_EQ(read(frame), FrameState::complete);
  EXPECT_EQ(frame.request, 7);
  EXPECT_EQ(frame.width, 5);
  EXPECT_EQ(frame.height, 3);
  EXPECT_EQ(frame.fullWidth, 10);
  EXPECT_EQ(frame.fullHeight, 6);
  EXPECT_EQ(frame.samples, 3U);
  EXPECT_EQ(frame.noise, 0.5); // that after denoising is unknown
  EXPECT_TRUE(frame.isLast);
  EXPECT_EQ(frame.position, (std::array{1.0, 2.0, 3.0}));
  EXPECT_EQ(frame.target, (std::array{4.0, 5.0, 6.0}));
  EXPECT_EQ(frame.up, (std::array{7.0, 8.0, 9.0}));
  EXPECT_TRUE(frame.isOrthographic);
  EXPECT_EQ(frame.extent, 30.5);
  EXPECT_EQ(frame.display, std::vector<std::uint8_t>(60, 7));
  EXPECT_EQ(frame.depth.front(), 7.5F);
  EXPECT_EQ(frame.depth.back(), 7.0F); // half of the light is stopped nowhere
  publish(2, 3, 1, false);
  ASSERT_EQ(read(frame), FrameState::complete);
  EXPECT_EQ(frame.display.size(), 12U);
  EXPECT_EQ(frame.depth, std::vector<float>(3, 2.0F));
  EXPECT_FALSE(frame.isLast);
}

TEST_F(SlicerFrame, ALargerImageNeedsALargerMapping) {
  publish(1, 5, 3);
  MappedFile mapped(path);
  mapped.extend(std::filesystem::file_size(path));
  publish(2, 100, 100);
  Frame frame;
  EXPECT_EQ(readFrame(mapped.bytes().data(), mapped.bytes().size(), frame), FrameState::outgrown);
  mapped.extend(std::filesystem::file_size(path));
  EXPECT_EQ(readFrame(mapped.bytes().data(), mapped.bytes().size(), frame), FrameState::complete);
  EXPECT_EQ(frame.request, 2);
}

/// True if all values equal `value`.
template <typename Value>
bool hasOnly(const std::vector<Value>& values, Value value) {
  return std::all_of(values.begin(), values.end(), [value](Value v) { return v == value; });
}

TEST_F(SlicerFrame, NoneOfAHundredThousandReadsIsTorn) {
  constexpr int reads = 100'000;
  publish(0, 16, 16, false);
  std::atomic<bool> isDone = false;
  std::thread writer([&] {
    for (int number = 1; !isDone; number = number % 200 + 1)
      publish(number, 8 + number % 5, 16, false);
  });
  MappedFile mapped(path);
  mapped.extend(std::filesystem::file_size(path));
  int complete = 0, torn = 0, changes = 0, before = 0;
  for (int i = 0; i < reads || changes < 100; ++i) {
    Frame frame;
    const FrameState state = readFrame(mapped.bytes().data(), mapped.bytes().size(), frame);
    if (state == FrameState::outgrown)
      mapped.extend(std::filesystem::file_size(path));
    if (state != FrameState::complete)
      continue;
    ++complete;
    const auto number = static_cast<int>(frame.request);
    changes += number != before ? 1 : 0;
    before = number;
    const bool isOfOneImage = frame.width == (number == 0 ? 16 : 8 + number % 5) &&
                              hasOnly(frame.display, static_cast<std::uint8_t>(number)) &&
                              hasOnly(frame.depth, static_cast<float>(number));
    torn += isOfOneImage ? 0 : 1;
  }
  isDone = true;
  writer.join();
  EXPECT_EQ(torn, 0);
  EXPECT_GT(complete, 0);
  std::cout << complete << " of " << reads << " reads were complete, of " << changes
            << " changes\n";
}

TEST_F(SlicerFrame, DamagedFilesAreRefused) {
  publish(1, 5, 3);
  const MappedFile source(path);
  std::vector<std::uint64_t> words(std::filesystem::file_size(path) / 8);
  std::ifstream(path, std::ios::binary)
      .read(reinterpret_cast<char*>(words.data()), static_cast<std::streamsize>(8 * words.size()));
  const auto readChanged = [&](std::size_t word, std::uint64_t value) {
    std::vector<std::uint64_t> changed = words;
    changed[word] = value;
    Frame frame;
    return readFrame(changed.data(), 8 * changed.size(), frame);
  };
  EXPECT_EQ(readChanged(2, 3), FrameState::busy);
  constexpr std::uint64_t huge = ~std::uint64_t{0};
  const std::pair<std::size_t, std::uint64_t> damages[] = {
      {0, 1},                    // magic
      {1, 2},                    // version
      {5, 0},     {5, huge},     // width
      {6, 60000},                // height: beyond the file
      {13, 1},                   // layers
      {14, 1},                   // name
      {15, huge}, {15, 8 * 511}, // offset
      {16, huge}, {17, huge}};   // components and their size
  for (const auto& [word, value] : damages)
    EXPECT_THROW(readChanged(word, value), std::runtime_error) << word << ' ' << value;
  Frame frame;
  EXPECT_THROW(readFrame(words.data(), 64, frame), std::runtime_error);
}

} // namespace
} // namespace fenestra::core
