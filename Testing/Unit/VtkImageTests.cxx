// VTK XML images: every encoding of an array, geometry, and damaged files.

#include "Approx.h"
#include "Refusals.h"

#include "files/medical/VolumeReader.h"
#include "files/segments/SegmentationReader.h"
#include "io/Base64.h"

#include <zlib.h>

#include <bit>
#include <cstring>

namespace fenestra::core::VtkImageTests {
namespace {

const Size3 size(3, 4, 2);
constexpr std::size_t count = 24;

template <typename T>
std::string toBytes(T value, std::endian order) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  if (order != std::endian::native)
    std::ranges::reverse(bytes);
  return bytes;
}

struct Encoding {
  std::string format = "appended"; ///< or "binary" or "ascii"
  bool isBase64 = false;           ///< of appended data
  bool isDeflated = false, has64Bits = false;
  std::endian order = std::endian::little;
};

/// A file of one array of the values 1 to 24, on points.
struct VtiFile {
  Encoding encoding = {};
  std::string type = "Int16", components = "1";
  std::string extent = "0 2 0 3 0 1", pieceExtent = extent;
  std::string geometry = R"(Origin="10 20 30" Spacing="0.5 2 3")";
  std::string where = "PointData", active = "a", more = {};
  std::string compressor = "vtkZLibDataCompressor";
  std::uint64_t declared = 0;                   ///< of plain arrays, bytes; 0: the true size
  std::uint64_t blockSize = 20, blockCount = 0; ///< of deflated arrays; count 0: the true one

  std::string word(std::uint64_t value) const {
    return encoding.has64Bits ? toBytes(value, encoding.order)
                              : toBytes(static_cast<std::uint32_t>(value), encoding.order);
  }

  template <typename T>
  std::string samples() const {
    std::string bytes;
    for (std::size_t i = 1; i <= count; ++i)
      bytes += toBytes(static_cast<T>(i), encoding.order);
    return bytes;
  }

  /// Header and data of the array; separately, since base64 encodes them in different ways.
  std::pair<std::string, std::string> store(const std::string& bytes) const {
    if (!encoding.isDeflated)
      return {"", word(declared ? declared : bytes.size()) + bytes};
    std::string lengths, blocks;
    std::uint64_t blockTotal = 0;
    constexpr std::size_t trueSize = 20;
    for (std::size_t at = 0; at < bytes.size(); at += trueSize, ++blockTotal) {
      const std::string part = bytes.substr(at, trueSize);
      uLongf length = compressBound(uLong(part.size()));
      std::string packed(length, '\0');
      compress(reinterpret_cast<Bytef*>(packed.data()), &length,
               reinterpret_cast<const Bytef*>(part.data()), uLong(part.size()));
      lengths += word(length);
      blocks += packed.substr(0, length);
    }
    return {word(blockCount ? blockCount : blockTotal) + word(blockSize) +
                word(blockCount ? 0 : bytes.size() % trueSize) + lengths,
            blocks};
  }

  template <typename T = std::int16_t>
  std::string encode() const {
    const auto [header, data] = store(samples<T>());
    const std::string base64 = toBase64(header) + toBase64(data);
    std::string content, appended;
    if (encoding.format == "ascii")
      for (std::size_t i = 1; i <= count; ++i)
        content += std::to_string(i) + (i % 6 == 0 ? "\n" : " ");
    else if (encoding.format == "binary")
      content = "\n  " + base64 + "\n";
    else
      appended = std::string("<AppendedData encoding=\"") + (encoding.isBase64 ? "base64" : "raw") +
                 "\">\n  _" + "ab" + (encoding.isBase64 ? base64 : header + data) +
                 "\n</AppendedData>\n";
    return std::string("<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" version=\"1.0\"") +
           " byte_order=\"" + (encoding.order == std::endian::big ? "Big" : "Little") +
           "Endian\" header_type=\"" + (encoding.has64Bits ? "UInt64" : "UInt32") + "\"" +
           (encoding.isDeflated ? " compressor=\"" + compressor + "\"" : "") +
           ">\n<ImageData WholeExtent=\"" + extent + "\" " + geometry + ">\n<Piece Extent=\"" +
           pieceExtent + "\">\n<" + where + " Scalars=\"" + active + "\">\n<DataArray type=\"" +
           type + "\" Name=\"a\" NumberOfComponents=\"" + components + "\" format=\"" +
           encoding.format + "\" offset=\"2\">" + content + "</DataArray>\n" + more + "</" + where +
           ">\n</Piece>\n</ImageData>\n" + appended + "</VTKFile>\n";
  }
};

std::vector<Encoding> listEncodings() {
  std::vector<Encoding> all = {{.format = "ascii"}};
  for (const bool isDeflated : {false, true})
    for (const bool has64Bits : {false, true})
      for (const auto order : {std::endian::little, std::endian::big})
        for (const auto& [format, isBase64] :
             {std::pair("binary", true), {"appended", true}, {"appended", false}})
          all.push_back({format, isBase64, isDeflated, has64Bits, order});
  return all;
}

std::string describe(const Encoding& e) {
  return e.format + (e.isBase64 ? " base64" : " raw") + (e.isDeflated ? " deflated" : "") +
         (e.has64Bits ? " 64" : " 32") + (e.order == std::endian::big ? " big" : " little");
}

void expectVoxels(const Volume& volume, const std::string& what) {
  ASSERT_EQ(volume.grid.size, size) << what;
  std::visit(
      [&](const auto& voxels) {
        for (std::size_t i = 0; i < count; ++i)
          ASSERT_EQ(double(voxels[i]), static_cast<double>(i + 1)) << what;
      },
      volume.voxels);
}

/// Expects the voxels (0, 0, 0) and (2, 3, 1) at these points, RAS.
void expectCorners(const Volume& volume, const Vec3& first, const Vec3& last) {
  EXPECT_TRUE(isApprox(volume.grid.indexToWorld * Vec3(0, 0, 0), first, 1e-4));
  EXPECT_TRUE(isApprox(volume.grid.indexToWorld * Vec3(2, 3, 1), last, 1e-4));
}

TEST(VtkImage, EveryEncodingGivesTheSameVoxels) {
  const TemporaryFolder folder;
  for (const Encoding& encoding : listEncodings()) {
    const Volume volume = readVolume(folder.write("v.vti", VtiFile{encoding}.encode()));
    expectVoxels(volume, describe(encoding));
    expectCorners(volume, Vec3(-10, -20, 30), Vec3(-11, -26, 33));
    ASSERT_EQ(volume.warnings.size(), 1U);
    EXPECT_EQ(volume.warnings[0].code, ErrorCode::assumedGeometry);
  }
}

template <typename T>
void expectType(const std::string& type) {
  const TemporaryFolder folder;
  for (const Encoding& encoding :
       {Encoding{}, Encoding{.order = std::endian::big}, Encoding{.format = "ascii"}}) {
    VtiFile file{encoding};
    file.type = type;
    expectVoxels(readVolume(folder.write("v.vti", file.encode<T>())), type);
  }
}

TEST(VtkImage, EveryTypeIsRead) {
  expectType<std::int8_t>("Int8");
  expectType<std::uint8_t>("UInt8");
  expectType<std::int16_t>("Int16");
  expectType<std::uint16_t>("UInt16");
  expectType<std::int32_t>("Int32");
  expectType<std::uint32_t>("UInt32");
  expectType<std::int64_t>("Int64");
  expectType<std::uint64_t>("UInt64");
  expectType<float>("Float32");
  expectType<double>("Float64");
}

TEST(VtkImage, ExtentsAndDirectionsMoveTheVoxels) {
  const TemporaryFolder folder;
  VtiFile file;
  file.extent = file.pieceExtent = "4 6 -1 2 10 11";
  expectCorners(readVolume(folder.write("v.vti", file.encode())), Vec3(-12, -18, 60),
                Vec3(-13, -24, 63));
  file.geometry += R"( Direction="0 -1 0 1 0 0 0 0 1")"; // x goes toward +y, y toward -x
  expectCorners(readVolume(folder.write("v.vti", file.encode())), Vec3(-12, -22, 60),
                Vec3(-6, -23, 63));
  file.geometry = "";
  const auto path = folder.write("v.vti", file.encode());
  expectCorners(readVolume(path), Vec3(-4, 1, 10), Vec3(-6, -2, 11));
  const Volume chosen = readVolume(path, {.spacing = Vec3(0.5, 2, 3)});
  expectCorners(chosen, Vec3(-2, 2, 30), Vec3(-3, -4, 33));
}

TEST(VtkImage, CellsAreVoxelsAtTheirCenters) {
  const TemporaryFolder folder;
  VtiFile file;
  file.where = "CellData";
  file.extent = file.pieceExtent = "0 3 0 4 0 2";
  const Volume volume = readVolume(folder.write("v.vti", file.encode()));
  expectVoxels(volume, "cells");
  expectCorners(volume, Vec3(-10.25, -21, 31.5), Vec3(-11.25, -27, 34.5));
}

TEST(VtkImage, ActiveScalarsAreChosen) {
  const TemporaryFolder folder;
  VtiFile file;
  file.more = R"(<DataArray type="UInt8" Name="b" format="ascii">1 2 3</DataArray>)";
  expectVoxels(readVolume(folder.write("v.vti", file.encode())), "active");
  file.active = "none";
  const auto path = folder.write("v.vti", file.encode());
  expectRefused(path, "unsupported-file | 2", [&] { readVolume(path); });
  file.more = "";
  expectVoxels(readVolume(folder.write("v.vti", file.encode())), "the only one");
}

TEST(VtkImage, LabelMapsAreSegmentations) {
  const TemporaryFolder folder;
  const Segmentation labels = readSegmentation(folder.write("labels.vti", VtiFile().encode()));
  EXPECT_EQ(labels.segments().size(), count);
  EXPECT_TRUE(isApprox(labels.grid().indexToWorld.translation(), Vec3(-10, -20, 30), 1e-9));
}

void expectRefusal(const VtiFile& file, const std::string& expected) {
  const TemporaryFolder folder;
  const auto path = folder.write("v.vti", file.encode());
  expectRefused(path, expected, [&] { readVolume(path); });
}

TEST(VtkImage, OtherContentIsRefused) {
  VtiFile lz4{{.isDeflated = true}};
  lz4.compressor = "vtkLZ4DataCompressor";
  expectRefusal(lz4, "unsupported-file");
  VtiFile file;
  file.components = "3";
  expectRefusal(file, "unsupported-file | 3");
  file = {};
  file.pieceExtent = "0 2 0 3 0 0";
  expectRefusal(file, "invalid-field: Extent");
  file = {};
  file.where = "CellData";
  file.extent = file.pieceExtent = "0 2 0 3 0 0";
  expectRefusal(file, "invalid-field: WholeExtent");
  for (const char* extent : {"0 2 0 3", "0 2 0 3 1 0", "0 2.5 0 3 0 1", "0 1e300 0 3 0 1", "x"}) {
    file = {};
    file.extent = file.pieceExtent = extent;
    expectRefusal(file, "invalid-field: WholeExtent");
  }
  for (const char* geometry : {R"(Spacing="1 1")", R"(Origin="1 1 nan")", R"(Direction="1 0 0")",
                               R"(Spacing="0 1 1")", R"(Direction="1 0 0 2 0 0 0 0 1")"}) {
    file = {};
    file.geometry = geometry;
    expectRefusal(file, "");
  }
  file = {};
  file.more = "</PointData></Piece><Piece Extent=\"0 2 0 3 0 1\"><PointData>";
  expectRefusal(file, "unsupported-file | 2");
}

TEST(VtkImage, SpacingFormAndFrameAreRefused) {
  const TemporaryFolder folder;
  const auto path = folder.write("v.vti", VtiFile().encode());
  expectRefused(path, "invalid-value", [&] { readVolume(path, {.spacing = Vec3(1.0, 1.0, 1.0)}); });
  expectRefused(path, "unknown-form", [&] { readVolume(path, {.niftiForm = NiftiForm::sform}); });
  expectRefused(path, "unknown-frame", [&] { readVolume(path, {.frame = 1}); });
}

TEST(VtkImage, TruncatedFilesAreRefused) {
  const TemporaryFolder folder;
  const auto expectDamaged = [&](const std::string& text) {
    const auto path = folder.write("cut.vti", text);
    expectRefused(path, "damaged-file", [&] { readVolume(path); });
  };
  for (const Encoding& encoding : listEncodings()) {
    const std::string whole = VtiFile{encoding}.encode();
    const bool isAppended = encoding.format == "appended";
    const std::size_t data = whole.find(isAppended ? "_ab" : "offset=\"2\">");
    const std::size_t dataEnd = whole.rfind(isAppended ? "\n</AppendedData>" : "\n</DataArray>");
    for (const std::size_t end : {std::size_t(0), whole.size() / 4, data + 2, data + 20, data + 40})
      expectDamaged(whole.substr(0, end));
    if (isAppended)
      expectDamaged(whole.substr(0, dataEnd - 2)); // shorter by less than the array's header
    else if (encoding.format == "binary")
      expectDamaged(whole.substr(0, dataEnd - 4) + whole.substr(dataEnd)); // complete elements
  }
}

TEST(VtkImage, DamagedDataAreRefused) {
  const TemporaryFolder folder;
  const auto expectChanged = [&](const Encoding& encoding, char from, char to) {
    std::string text = VtiFile{encoding}.encode();
    const std::size_t data = text.find(encoding.format == "appended" ? "_ab" : "offset=\"2\">");
    std::replace(text.begin() + std::ptrdiff_t(data) + 12, text.end() - 40, from, to);
    const auto path = folder.write("bad.vti", text);
    expectRefused(path, "damaged-file", [&] { readVolume(path); });
  };
  expectChanged({.format = "ascii"}, '2', 'x');
  expectChanged({.format = "ascii"}, '7', ' ');
  expectChanged({.format = "binary"}, 'A', '*');
  expectChanged({.isBase64 = true, .isDeflated = true}, 'A', 'B');
  expectChanged({.isDeflated = true}, 'x', 'y'); // zlib's first byte
}

TEST(VtkImage, SizesThatLieAreRefused) {
  for (const Encoding& encoding : listEncodings()) {
    VtiFile file{encoding};
    file.extent = file.pieceExtent = "0 2147483646 0 2147483646 0 2147483646";
    expectRefusal(file, "damaged-file");
    file.extent = file.pieceExtent = "0 2 0 3 0 2";
    expectRefusal(file, "damaged-file");
    file.extent = file.pieceExtent = "0 1 0 3 0 1";
    expectRefusal(file, "damaged-file");
  }
  for (const std::uint64_t declared : {std::uint64_t{49}, std::uint64_t{1} << 31, UINT64_MAX}) {
    VtiFile file{{.has64Bits = true}};
    file.declared = declared;
    expectRefusal(file, "damaged-file");
  }
}

/// Blocks that would inflate to more than the file can hold, or that are too many.
TEST(VtkImage, BlocksThatLieAreRefused) {
  for (const Encoding& encoding :
       {Encoding{.format = "binary", .isDeflated = true, .has64Bits = true},
        Encoding{.isDeflated = true, .has64Bits = true}}) {
    VtiFile file{encoding};
    for (const std::uint64_t blockSize :
         {std::uint64_t{19}, std::uint64_t{1} << 40, std::uint64_t{1} << 63, UINT64_MAX}) {
      file.blockSize = blockSize;
      expectRefusal(file, "damaged-file");
    }
    file.blockSize = 20;
    for (const std::uint64_t blockCount : {std::uint64_t{1} << 20, UINT64_MAX}) {
      file.blockCount = blockCount;
      expectRefusal(file, "damaged-file");
    }
  }
  // The array has the size of the extent, but its only block has a few bytes.
  VtiFile bomb{{.isDeflated = true, .has64Bits = true}};
  bomb.extent = bomb.pieceExtent = "0 599 0 499 0 0"; // which the file could hold
  bomb.blockCount = 1;
  bomb.blockSize = 600'000;
  expectRefusal(bomb, "damaged-file");
}

} // namespace
} // namespace fenestra::core::VtkImageTests
