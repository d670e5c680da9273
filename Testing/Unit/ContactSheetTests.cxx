#include "files/images/ContactSheet.h"

#include "TemporaryFolder.h"
#include "files/images/ImageWriter.h"
#include "files/images/TextBitmap.h"
#include "io/Outputs.h"

#include <gtest/gtest.h>

#include <numeric>
#include <set>
#include <span>

namespace fenestra::core::ContactSheetTests {
namespace {

double sumCoverage(const TextBitmap& line) {
  return std::accumulate(line.coverage.begin(), line.coverage.end(), 0.0);
}

TEST(TextBitmap, CharactersHaveDifferentShapesAndUnknownOnesAreBoxes) {
  std::set<std::vector<float>> shapes;
  for (char c = '!'; c < 0x7f; ++c)
    shapes.insert(rasterizeText(std::string(1, c), {}).coverage);
  for (const char* letter : {"\u00fc", "\u0394", "\u0416", "\uffff"}) // the last one is a box
    shapes.insert(rasterizeText(letter, {}).coverage);
  EXPECT_EQ(shapes.size(), 98U);
  const TextBitmap box = rasterizeText("\uffff", {});
  EXPECT_GT(sumCoverage(box), 10.0);
  for (const char* text : {"\xff", "\t", "\xe2\x82"}) // no UTF-8, control character, cut
    EXPECT_EQ(rasterizeText(text, {}).coverage.size() / box.coverage.size(),
              std::string(text).size() == 2 ? 2U : 1U)
        << text;
  EXPECT_EQ(rasterizeText("", {}).coverage.size(), 0U);
}

TEST(TextBitmap, CoverageGrowsWithTheSquareOfTheSize) {
  const std::string text = "Liver, 12 \u00b5m";
  const TextBitmap large = rasterizeText(text, {.size = 100.0});
  EXPECT_NEAR(-large.top, 100.0 * fontAscent, 20.0);
  for (const double size : {9.5, 14.0, 28.0, 300.0}) {
    const TextBitmap line = rasterizeText(text, {.size = size});
    const double scale = size / 100.0;
    EXPECT_NEAR(line.advance, large.advance * scale, 1e-2 * line.advance) << size;
    EXPECT_NEAR(sumCoverage(line), scale * scale * sumCoverage(large), 0.03 * sumCoverage(line))
        << size;
  }
  EXPECT_NEAR(-rasterizeText("H", {.size = 1000.0}).top, 1000.0 * fontCapHeight, 2.0);
}

TEST(TextBitmap, OutlineSurroundsTheGlyphs) {
  const TextBitmap plain = rasterizeText("I", {.size = 100.0});
  const TextBitmap thick = rasterizeText("I", {.size = 100.0, .outline = 10.0});
  EXPECT_NEAR(thick.left + thick.width, plain.left + plain.width + 10, 1);
  EXPECT_NEAR(thick.top, plain.top - 10, 1);
  EXPECT_EQ(thick.advance, plain.advance);
  // Area of a shape and its border: area + perimeter * r + pi * r^2.
  const double width = 9.863, height = 72.9; // of this letter
  EXPECT_NEAR(sumCoverage(plain), width * height, 1.0);
  EXPECT_NEAR(sumCoverage(thick), width * height + 20.0 * (width + height) + 314.2, 5.0);
}

TEST(TextBitmap, LongTextEndsInAnEllipsis) {
  const double width = rasterizeText("A long name", {}).advance;
  EXPECT_EQ(rasterizeText("A long name", {.maxWidth = width}).advance, width);
  const TextBitmap cut = rasterizeText("A long name", {.maxWidth = width - 0.5});
  EXPECT_EQ(cut.coverage, rasterizeText("A long na\u2026", {}).coverage);
  EXPECT_EQ(rasterizeText("A long name", {.maxWidth = 1.0}).coverage,
            rasterizeText("\u2026", {}).coverage);
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
} // namespace fenestra::core::ContactSheetTests
