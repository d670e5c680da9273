// Image files that are damaged or malicious.

#include "ImageTesting.h"

#include <bit>
#include <cstring>

#include <sys/stat.h>

namespace fenestra::core::DamagedImageTests {
using namespace std::string_literals;
using namespace testing_images;

/// Suppression for the leak sanitizer: ITK's NRRD reader leaks a few bytes of a damaged file.
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libITKNrrdIO";
}

namespace {

using DamagedFiles = ImageFiles;

TEST_F(DamagedFiles, TruncatedFileIsRejectedOrComplete) {
  for (const std::string name : {"a.exr", "a.nrrd", "a.png", "a.tif"}) {
    const Image image = readImage(save(makeTestImage(), name));
    const std::string original = readContent(path(name));
    for (std::size_t length = 0; length < original.size(); length += 1 + original.size() / 100) {
      writeContent(path("cut-" + name), original.substr(0, length));
      try { // a PNG has every pixel before its last bytes
        const Image read = readImage(path("cut-" + name));
        EXPECT_EQ(read.channels, image.channels) << length << " of " << original.size();
        EXPECT_GT(length, original.size() * 9 / 10) << name;
      } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::input);
      }
    }
  }
}

TEST_F(DamagedFiles, ChangedByteIsReadOrRejected) {
  for (const std::string name : {"a.exr", "a.nrrd", "a.png", "a.tif"}) {
    const std::string original = readContent(save(makeTestImage(), name));
    const std::size_t step = 1 + original.size() / 1500;
    for (std::size_t at = 0; at < original.size(); at += step)
      for (const char value : {'\0', '\x7f', '\xff'}) {
        std::string changed = original;
        changed[at] = value;
        writeContent(path("changed-" + name), changed);
        try {
          const Image image = readImage(path("changed-" + name));
          for (const auto& [channel, plane] : image.channels)
            ASSERT_EQ(plane.size(), static_cast<std::size_t>(image.width * image.height));
        } catch (const Error& error) {
          ASSERT_EQ(error.kind(), ErrorKind::input);
        }
      }
  }
}

TEST_F(DamagedFiles, ClaimedSizeBeyondTheFileIsRejected) {
  const std::string head = "NRRD0004\ntype: float\ndimension: 3\nencoding: raw\nendian: little\n"
                           "kinds: vector domain domain\n";
  writeContent(path("a.nrrd"), head + "sizes: 4 30000 30000\n\n1234");
  catchError(ErrorKind::input, "damaged-file", [&] { readImage(path("a.nrrd")); });
  writeContent(path("b.nrrd"), head + "sizes: 4 40000 2\n\n1234");
  catchError(ErrorKind::input, "invalid-file | 32768", [&] { readImage(path("b.nrrd")); });
  // Attribute of 2 GB, directly after the magic number and the version.
  std::string exr = readContent(save(makeTestImage(), "a.exr"));
  exr.replace(8, 0, std::string("note\0string\0\xff\xff\xff\x7f", 16));
  writeContent(path("a.exr"), exr);
  catchError(ErrorKind::input, "damaged-file | attribute", [&] { readImage(path("a.exr")); });
  // Channel list that ends before its declared size: OpenEXR would read the following bytes as an
  // attribute.
  exr.replace(8, 16, std::string("c\0chlist\0\x0d\0\0\0\0w\0string\0\xff\xff\xff\x7f", 26));
  writeContent(path("a.exr"), exr);
  catchError(ErrorKind::input, "damaged-file", [&] { readImage(path("a.exr")); });
  // Width and height of a PNG are bytes 16 to 23; libpng checks either them or the checksum first.
  std::string png = readContent(save(makeTestImage(), "a.png"));
  png.replace(16, 8, std::string("\0\0\x70\0\0\0\x70\0", 8));
  writeContent(path("a.png"), png);
  catchError(ErrorKind::input, ": a.png", [&] { readImage(path("a.png")); });
}

TEST_F(DamagedFiles, ClaimedMemoryBeyondTheLimitIsRejected) {
  const std::string head = "NRRD0004\ntype: float\ndimension: 3\nencoding: gzip\nendian: little\n"
                           "kinds: vector domain domain\n";
  writeContent(path("a.nrrd"), head + "sizes: 4 16384 8192\n\n" + std::string(200'000, '\0'));
  catchError(ErrorKind::input, "limit-exceeded | 536870912", [&] { readImage(path("a.nrrd")); });
  // A writer that stops early leaves zeros in the table of offsets to blocks of scan lines. The
  // first block follows that table.
  std::string exr = readContent(save(makeTestImage(40, 70), "a.exr"));
  constexpr std::size_t tableBytes = 8 * ((70 + 15) / 16);
  const auto readOffset = [&exr](std::size_t at) {
    std::uint64_t offset = 0;
    std::memcpy(&offset, &exr.at(at), sizeof offset);
    return offset;
  };
  std::size_t table = 0;
  while (readOffset(table) != table + tableBytes)
    ++table;
  exr.replace(table + tableBytes - 8, 8, std::string(8, '\0'));
  writeContent(path("cut.exr"), exr.substr(0, exr.size() * 2 / 3));
  catchError(ErrorKind::input, "damaged-file", [&] { readImage(path("cut.exr")); });
}

TEST_F(DamagedFiles, NameOfAnotherFileIsRejected) {
  const std::string head = "NRRD0004\ntype: float\ndimension: 2\nencoding: raw\nendian: little\n"
                           "sizes: 4 4\n";
  for (const std::string& line : {"data file: -"s, "datafile: /dev/zero"s, " Data  File:-"s,
                                  "#" + std::string(5000, 'x') + "\ndata file: -"}) {
    writeContent(path("a.nrrd"), head + line + "\n\n" + std::string(64, '\0'));
    SCOPED_TRACE(line);
    catchError(ErrorKind::input, ": a.nrrd", [&] { readImage(path("a.nrrd")); });
  }
  ::mkfifo(path("pipe.exr").c_str(), 0600);
  fs::create_directory(path("folder.png"));
  for (const char* name : {"pipe.exr", "folder.png", "missing.exr", "text.txt"})
    catchError(ErrorKind::input, ": "s + name, [&] { readImage(path(name)); });
}

/// Teem's message buffer holds 1024 bytes of a line, and its arrays hold the sizes of 16 axes.
TEST_F(DamagedFiles, OverlongHeaderFieldIsRejected) {
  const std::string head = "NRRD0004\ntype: float\nencoding: raw\nendian: little\n";
  const std::string plain = head + "dimension: 2\nsizes: 4 4\n", ones(1000, '1');
  for (const std::string& header :
       {plain + "space: left-posterior-superior\nspace directions: (" + ones + ",0,0) (0,1,0)\n",
        plain + "dimension" + std::string(1000, 'n') + ": 4\n",
        head + "dimension: 17\nsizes: 4 4 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1\n",
        head + "dimension: 2\nsizes: 4 99999999999\n"}) {
    writeContent(path("a.nrrd"), header + "\n" + std::string(64, '\0'));
    SCOPED_TRACE(header);
    catchError(ErrorKind::input, ": a.nrrd", [&] { readImage(path("a.nrrd")); });
  }
}

TEST_F(DamagedFiles, ErrorsPrintNothingToStandardError) {
  ::testing::internal::CaptureStderr();
  for (const std::string name : {"a.exr", "a.nrrd", "a.png", "a.tif"}) {
    writeContent(path(name), "this text is not an image, despite the extension");
    catchError(ErrorKind::input, ": "s + name, [&] { readImage(path(name)); });
  }
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

} // namespace
} // namespace fenestra::core::DamagedImageTests
