// Folders of PNG and TIFF slices, and TIFF files of several pages.

#include "files/medical/ImageStack.h"

#include "Approx.h"
#include "Refusals.h"
#include "TiffPages.h"

#include <zlib.h>

#include <cstring>

namespace fenestra::core::ImageStackTests {
namespace {

constexpr std::size_t columns = 4, rows = 3, slices = 3;
const Vec3 spacing(0.02, 0.03, 0.5);

double sampleValue(std::size_t x, std::size_t y, std::size_t z, double step = 1.0) {
  return step * static_cast<double>(1 + x + columns * (y + rows * z));
}

template <typename T>
std::string makeSamples(std::size_t z, double step = 1.0) {
  std::vector<T> samples;
  for (std::size_t y = 0; y < rows; ++y)
    for (std::size_t x = 0; x < columns; ++x)
      samples.push_back(static_cast<T>(sampleValue(x, y, z, step)));
  return std::string(asBytes(samples));
}

std::string deflateBytes(const std::string& bytes) {
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::string packed(size, '\0');
  compress(reinterpret_cast<Bytef*>(packed.data()), &size,
           reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uLong>(bytes.size()));
  return packed.substr(0, size);
}

std::string bigEndian(std::uint32_t value) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8)
    bytes += static_cast<char>(value >> shift);
  return bytes;
}

/// PNG with these fields of its header. `samples`: native; 16 bits are stored big-endian.
std::string makePng(std::string samples, char bits, char color = 0, std::uint32_t width = columns,
                    std::uint32_t height = rows) {
  const auto makeChunk = [](const std::string& type, const std::string& data) {
    const std::string body = type + data;
    const uLong sum =
        crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size()));
    return bigEndian(static_cast<std::uint32_t>(data.size())) + body +
           bigEndian(static_cast<std::uint32_t>(sum));
  };
  if (bits == 16)
    for (std::size_t i = 0; i + 1 < samples.size(); i += 2)
      std::swap(samples[i], samples[i + 1]);
  std::string filtered;
  const std::size_t rowBytes = samples.size() / rows;
  for (std::size_t row = 0; row < rows; ++row)
    filtered += '\0' + samples.substr(row * rowBytes, rowBytes);
  return "\x89PNG\r\n\x1a\n" +
         makeChunk("IHDR",
                   bigEndian(width) + bigEndian(height) + bits + color + std::string(3, '\0')) +
         makeChunk("IDAT", deflateBytes(filtered)) + makeChunk("IEND", "");
}

Volume readStack(const std::filesystem::path& path) {
  return readImageStack(openImageStack(path), {.spacing = spacing});
}

/// Expects the samples of all slices, at the positions of the documented axes.
void expectStack(const std::filesystem::path& path, double step = 1.0) {
  ASSERT_TRUE(isImageStack(path));
  const Volume volume = readStack(path);
  ASSERT_EQ(volume.grid.size, Size3(columns, rows, slices)) << path;
  for (const double x : {0.0, columns - 1.0})
    for (const double y : {0.0, rows - 1.0})
      for (const double z : {0.0, slices - 1.0})
        EXPECT_TRUE(isApprox(volume.grid.indexToWorld * Vec3(x, y, z),
                             Vec3(-0.02 * x, -0.03 * y, 0.5 * z), 1e-4));
  std::visit(
      [&](const auto& voxels) {
        for (std::size_t i = 0; i < columns * rows * slices; ++i)
          EXPECT_EQ(double(voxels[i]), sampleValue(i, 0, 0, step)) << path << " " << i;
      },
      volume.voxels);
  ASSERT_EQ(volume.warnings.size(), 1U);
  EXPECT_EQ(volume.warnings[0].code, ErrorCode::assumedGeometry);
}

/// Writes three slices, whose names are in another order as text than by their numbers.
template <typename Encode>
void writeSlices(const TemporaryFolder& folder, const std::string& extension, Encode&& encode) {
  for (const auto& [number, z] : {std::pair("08", 0), {"9", 1}, {"10", 2}})
    folder.write("slice" + std::string(number) + extension, encode(static_cast<std::size_t>(z)));
}

void writeBytes(const TemporaryFolder& folder, const std::string& extension = ".png") {
  writeSlices(folder, extension, [&](std::size_t z) {
    const std::string samples = makeSamples<std::uint8_t>(z);
    return extension == ".png" ? makePng(samples, 8) : TiffPages().encode({samples});
  });
}

TEST(ImageStack, PngSlicesGiveTheirSamples) {
  const TemporaryFolder bytes, words;
  writeBytes(bytes);
  expectStack(bytes.path());
  writeSlices(words, ".PNG",
              [](std::size_t z) { return makePng(makeSamples<std::uint16_t>(z, 1500.0), 16); });
  expectStack(words.path(), 1500.0);
}

TEST(ImageStack, TiffSlicesAndPagesGiveTheirSamples) {
  const auto expectBoth = [](TiffPages tiff, auto sample, double step) {
    using T = decltype(sample);
    for (const bool isPacked : {false, true}) {
      const TemporaryFolder folder, pages;
      tiff.compression = isPacked ? 8 : 1;
      const auto encode = [&](std::size_t z) {
        const std::string samples = makeSamples<T>(z, step);
        return isPacked ? deflateBytes(samples) : samples;
      };
      writeSlices(folder, ".tif", [&](std::size_t z) { return tiff.encode({encode(z)}); });
      expectStack(folder.path(), step);
      expectStack(pages.write("v.tiff", tiff.encode({encode(0), encode(1), encode(2)})), step);
    }
  };
  expectBoth({.bits = 8}, std::uint8_t(), 1.0);
  expectBoth({.bits = 8, .sampleFormat = 2}, std::int8_t(), -1.0);
  expectBoth({.bits = 16}, std::uint16_t(), 1500.0);
  expectBoth({.bits = 16, .sampleFormat = 2}, std::int16_t(), -800.0);
  expectBoth({.bits = 32, .sampleFormat = 3}, float(), 0.25);
}

TEST(ImageStack, OtherFilesAreIgnored) {
  const TemporaryFolder folder;
  writeBytes(folder);
  for (const char* name : {"Thumbs.db", "scan.log", "notes.txt", ".hidden.png", "._slice9.tif"})
    folder.write(name, "no image");
  std::filesystem::create_directory(folder / "others");
  expectStack(folder.path());
}

TEST(ImageStack, FoldersOfOtherVolumesAreNoStacks) {
  const TemporaryFolder folder;
  EXPECT_FALSE(isImageStack(folder.path()));
  folder.write("logo.png", makePng(makeSamples<std::uint8_t>(0), 8));
  EXPECT_TRUE(isImageStack(folder.path()));
  std::filesystem::create_directory(folder / "series");
  EXPECT_FALSE(isImageStack(folder.path()));
  writeBytes(folder);
  EXPECT_TRUE(isImageStack(folder.path()));
  folder.write("organ.nii.gz", "");
  EXPECT_FALSE(isImageStack(folder.path()));
  std::filesystem::remove(folder / "organ.nii.gz");
  folder.write("image", std::string(128, '\0') + "DICM");
  EXPECT_FALSE(isImageStack(folder.path()));
}

TEST(ImageStack, RequiresASpacing) {
  const TemporaryFolder folder;
  writeBytes(folder);
  const ImageStack stack = openImageStack(folder.path());
  EXPECT_EQ(stack.files().size(), slices);
  expectRefused(folder.path(), "spacing-required | 3", [&] { readImageStack(stack, {}); });
}

TEST(ImageStack, HasOneFrameAndNoForm) {
  const TemporaryFolder folder;
  writeBytes(folder);
  const ImageStack stack = openImageStack(folder.path());
  expectRefused(folder.path(), "unknown-frame | 1",
                [&] { readImageStack(stack, {.frame = 1, .spacing = spacing}); });
  expectRefused(folder.path(), "unknown-form", [&] {
    readImageStack(stack, {.niftiForm = NiftiForm::qform, .spacing = spacing});
  });
}

TEST(ImageStack, UnevenNumbersGiveAWarning) {
  const TemporaryFolder folder;
  writeBytes(folder);
  folder.write("slice12.png", makePng(makeSamples<std::uint8_t>(3), 8));
  const Volume volume = readStack(folder.path());
  EXPECT_EQ(volume.grid.size[2], 4);
  ASSERT_EQ(volume.warnings.size(), 2U);
  expectMessage(volume.warnings[0], "assumed-geometry | slice10.png | slice12.png");
}

/// Expects an error that names `name` once it is in a folder of valid slices.
void expectSliceRefused(const std::string& name, const std::string& bytes,
                        const std::string& expected) {
  const TemporaryFolder folder;
  writeBytes(folder, std::filesystem::path(name).extension());
  const auto path = folder.write(name, bytes);
  expectRefused(path, expected, [&] { readStack(folder.path()); });
}

TEST(ImageStack, DifferentSlicesAreRefused) {
  const std::string samples = makeSamples<std::uint8_t>(0);
  expectSliceRefused("slice11.png", makePng(samples.substr(3), 8, 0, 3),
                     "invalid-file | 3x3 | 4x3");
  expectSliceRefused("slice11.png", makePng(samples + samples, 16), "invalid-file | 16-bit");
  expectSliceRefused("slice11.tif", TiffPages{.columns = 6, .rows = 2}.encode({samples}),
                     "invalid-file | 6x2");
  expectSliceRefused("slice11.tif", TiffPages{.sampleFormat = 2}.encode({samples}),
                     "invalid-file | signed");
  expectSliceRefused("slice11.tif", TiffPages().encode({samples, samples}), "unsupported-file");
}

TEST(ImageStack, ColorsAndOtherSamplesAreRefused) {
  const std::string samples = makeSamples<std::uint8_t>(0), pair = samples + samples;
  const std::string triple = pair + samples;
  expectSliceRefused("a.png", makePng(triple, 8, 2), "unsupported-file | color");
  expectSliceRefused("a.png", makePng(pair, 8, 4), "unsupported-file | alpha");
  expectSliceRefused("a.png", makePng(samples.substr(0, 3), 1), "unsupported-file");
  const auto expectTiff = [](const TiffPages& tiff, const std::string& strip,
                             const std::string& fact) {
    expectSliceRefused("a.tif", tiff.encode({strip}), "unsupported-file" + fact);
  };
  expectTiff({.samples = 3, .photometric = 2}, triple, " | color");
  expectTiff({.samples = 2}, pair, " | alpha");
  expectTiff({.photometric = 0}, samples, " | WhiteIsZero");
  expectTiff({.orientation = 3}, samples, " | Orientation");
  expectTiff({.bits = 32}, pair + pair, "");
  expectTiff({.bits = 64, .sampleFormat = 3}, pair + pair + pair + pair, "");
  expectTiff({.bits = 12}, pair, "");
}

TEST(ImageStack, DamagedSlicesAreRefused) {
  const std::string png = makePng(makeSamples<std::uint8_t>(0), 8);
  const std::string tiff = TiffPages().encode({makeSamples<std::uint8_t>(0)});
  for (const std::size_t end : {std::size_t(0), std::size_t(20), std::size_t(50), png.size() - 13})
    expectSliceRefused("slice9.png", png.substr(0, end), "damaged-file");
  for (const std::size_t end : {std::size_t(0), std::size_t(20), tiff.size() - 30})
    expectSliceRefused("slice9.tif", tiff.substr(0, end), "damaged-file");
  std::string early = tiff; // its strip begins 5 bytes before the end
  const std::string offsetField("\x11\x01\4\0\1\0\0\0", 8);
  early[early.find(offsetField) + offsetField.size()] = static_cast<char>(early.size() - 5);
  expectSliceRefused("slice9.tif", early, "damaged-file");
  expectSliceRefused("slice9.tif", png, "damaged-file");
  const TemporaryFolder folder;
  const std::string strip = deflateBytes(makeSamples<std::uint8_t>(0));
  const auto path = folder.write("v.tif", TiffPages{.compression = 8}.encode(
                                              {strip, strip.substr(0, strip.size() / 2), strip}));
  expectRefused(path, "damaged-file", [&] { readStack(path); });
}

TEST(ImageStack, SizesThatTheFilesCannotHoldAreRefused) {
  const std::string samples = makeSamples<std::uint8_t>(0);
  const TemporaryFolder folder;
  for (const char* name : {"a1.png", "a2.png"})
    folder.write(name, makePng(samples, 8, 0, 20'000, 20'000));
  expectRefused(folder.path(), "damaged-file | 800000000", [&] { readStack(folder.path()); });
  const TiffPages large{.columns = 20'000, .rows = 20'000, .compression = 8};
  const auto pages = folder.write("v.tif", large.encode({deflateBytes(samples), "x"}));
  expectRefused(pages, "damaged-file | 800000000", [&] { readStack(pages); });
  expectSliceRefused("slice0.png", makePng(samples, 8, 0, 60'000, 60'000), "limit-exceeded | 512");
}

TEST(ImageStack, BothKindsOrOneSliceAreRefused) {
  const TemporaryFolder folder, single;
  writeBytes(folder);
  writeBytes(folder, ".tif");
  expectRefused(folder.path(), "invalid-file", [&] { openImageStack(folder.path()); });
  const auto path = single.write("one.tif", TiffPages().encode({makeSamples<std::uint8_t>(0)}));
  expectRefused(path, "unsupported-file", [&] { openImageStack(path); });
  expectRefused(path, "unsupported-file", [&] { openImageStack(single.path()); });
}

} // namespace
} // namespace fenestra::core::ImageStackTests
