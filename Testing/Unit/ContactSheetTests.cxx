#include "files/images/ContactSheet.h"

#include "TemporaryFolder.h"
#include "files/images/BitmapFont.h"
#include "files/images/ImageWriter.h"
#include "io/Outputs.h"

#include <gtest/gtest.h>

#include <numeric>
#include <set>
#include <span>

namespace fenestra::ContactSheetTests {
namespace {

double sumCoverage(const TextBitmap& line) {
  return std::accumulate(line.coverage.begin(), line.coverage.end(), 0.0);
}

TEST(BitmapFont, EveryCharacterHasAShape) {
  EXPECT_EQ(toAscii("Müller 3°"), "Muller 3\x7f");
  EXPECT_EQ(toAscii("\xff\t"), "\x7f\x7f");
  std::set<std::vector<float>> shapes;
  for (char c = ' '; c < 0x7f; ++c)
    shapes.insert(rasterizeText(std::string(1, c), 1.0).coverage);
  EXPECT_EQ(shapes.size(), 95U) << "all shapes differ";
}

TEST(BitmapFont, CoverageGrowsWithTheSquareOfTheSize) {
  const std::string text = "Liver, 12";
  const double one = sumCoverage(rasterizeText(text, 1.0));
  EXPECT_EQ(rasterizeText(text, 1.0).width, glyphWidth * 9);
  EXPECT_EQ(rasterizeText(text, 1.0).height, lineHeight);
  for (const double size : {1.5, 2.0, 3.0})
    EXPECT_NEAR(sumCoverage(rasterizeText(text, size)), size * size * one, 0.05 * size * size * one)
        << size;
}

std::filesystem::path writeFile(const std::filesystem::path& path, const Image& image) {
  Outputs outputs;
  declareImage(path, outputs);
  writeImage(image, {}, path, outputs, {DisplayView::standard});
  outputs.commit();
  return path;
}

/// Writes a gray image.
std::filesystem::path makeGrayFile(const TemporaryFolder& folder, const std::string& name,
                                   int width, int height, float value) {
  Image image{width, height, {}, {}};
  for (const char* channel : {"R", "G", "B"})
    image.channels[channel].assign(static_cast<std::size_t>(width * height), value);
  return writeFile(folder / name, image);
}

TEST(ContactSheet, ShowsImagesInOrderAndReportsMissingOnes) {
  const TemporaryFolder folder;
  const std::vector<SheetEntry> entries = {
      {.name = "large", .lines = {"a"}, .image = makeGrayFile(folder, "l.png", 672, 336, 0.25F)},
      {.name = "small", .lines = {"b"}, .image = makeGrayFile(folder, "s.png", 2, 2, 0.75F)},
      {.name = "lost", .lines = {"c"}, .image = folder / "lost.png"},
  };
  const Image sheet = makeContactSheet("Batch", "3 cases", entries);
  const Plane& red = sheet.channels.at("R");
  const auto at = [&](int x, int y) {
    return red[static_cast<std::size_t>(y) * static_cast<std::size_t>(sheet.width) +
               static_cast<std::size_t>(x)];
  };
  // Boxes of 336 x 336 pixels, 20 pixels apart; the first row begins at y = 89.
  ASSERT_EQ(sheet.width, 20 + 3 * 356);
  const int middle = 89 + 336 / 2;
  EXPECT_NEAR(at(20 + 168, middle), 0.25F, 0.01F);
  EXPECT_LT(at(20 + 168, middle - 100), 0.1F) << "the image is half as high as wide";
  EXPECT_NEAR(at(376 + 10, middle - 160), 0.75F, 0.01F) << "the image is enlarged to the box";
  EXPECT_NEAR(at(376 + 326, middle + 160), 0.75F, 0.01F);
  float brightest = 0.0F;
  for (int y = 89; y < 89 + 336; ++y)
    for (int x = 732; x < 732 + 336; ++x)
      brightest = std::max(brightest, at(x, y));
  EXPECT_GT(brightest, 0.8F) << "text reports the missing image";
}

TEST(ContactSheet, AveragesInLinearLight) {
  const TemporaryFolder folder;
  Image stripes{672, 672, {}, {}};
  for (const char* channel : {"R", "G", "B"})
    for (int i = 0; i < 672 * 672; ++i)
      stripes.channels[channel].push_back(i % 2 == 0 ? 0.0F : 1.0F);
  const SheetEntry entry{.name = "a", .image = writeFile(folder / "stripes.png", stripes)};
  const Image sheet = makeContactSheet("", "", std::span(&entry, 1));
  EXPECT_NEAR(sheet.channels.at("G")[static_cast<std::size_t>(sheet.width * 200 + 200)], 0.5F,
              0.01F);
}

} // namespace
} // namespace fenestra::ContactSheetTests
