#pragma once
// Small input files for the executable, and the common checks of its error messages.

#include "Process.h"
#include "TemporaryFolder.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <set>

namespace fenestra::core {

struct NrrdText {
  std::string sizes = "4 4 4";
  std::string type = "int16";
  std::string encoding = "raw";
  std::string fields = {}; ///< further lines

  /// File with 1 mm voxels and the center of the first voxel at the origin. Only volumes with three
  /// axes have a space.
  std::string encode(const std::string& samples) const {
    const auto axes = 1 + std::count(sizes.begin(), sizes.end(), ' ');
    std::string text = "NRRD0004\ntype: " + type + "\ndimension: " + std::to_string(axes) + "\n";
    if (axes == 3)
      text += "space: left-posterior-superior\n"
              "space directions: (1,0,0) (0,1,0) (0,0,1)\nspace origin: (0,0,0)\n";
    return text + "sizes: " + sizes + "\nendian: little\nencoding: " + encoding + "\n" + fields +
           "\n" + samples;
  }
};

/// Samples of a 4x4x4 volume: the 16-bit values 0 to 63.
inline std::string makeRamp() {
  std::string samples;
  for (char value = 0; value < 64; ++value)
    samples += {value, 0};
  return samples;
}

inline std::string compressGzip(const std::string& bytes, const TemporaryFolder& folder) {
  const std::filesystem::path path = folder / "deflated.gz";
  const gzFile file = gzopen(path.c_str(), "wb");
  gzwrite(file, bytes.data(), static_cast<unsigned>(bytes.size()));
  gzclose(file);
  const std::string result = readBytes(path);
  std::filesystem::remove(path);
  return result;
}

/// Segmentation with A ("Bone, left", one central voxel, value 1) and B ("Void", empty, value 2).
inline std::string makeSegments() {
  NrrdText text;
  text.type = "uint8";
  text.fields = "Segment0_ID:=A\nSegment0_Name:=Bone, left\nSegment0_LabelValue:=1\n"
                "Segment0_Layer:=0\nSegment1_ID:=B\nSegment1_Name:=Void\n"
                "Segment1_LabelValue:=2\nSegment1_Layer:=0\n";
  std::string labels(64, '\0');
  labels[21] = 1;
  return text.encode(labels);
}

/// Folder with a volume and its segments.
class SmallScene : public ::testing::Test {
protected:
  SmallScene() {
    folder.write("volume.nrrd", NrrdText().encode(makeRamp()));
    folder.write("segments.seg.nrrd", makeSegments());
  }

  /// Runs `fenestra volume.nrrd … ` with 16x16 pixels and 2 samples per pixel.
  Outcome renderVolume(const Arguments& arguments) const {
    Arguments all = {"volume.nrrd", "--size", "16x16", "--samples", "2"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    return run(all, folder.path());
  }

  TemporaryFolder folder;
};

/// Folder with a knee of 60x68x24 voxels in knee/. The executable creates it once per process.
inline const TemporaryFolder& kneeFolder() {
  static const TemporaryFolder folder;
  static const Outcome outcome =
      run({"phantom", "knee", "--size", "60x68x24", "--output", "knee"}, folder.path());
  if (outcome.status != 0)
    throw std::runtime_error("the knee phantom cannot be created: " + outcome.err);
  return folder;
}

inline std::set<std::string> listFiles(const std::filesystem::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    names.insert(entry.path().lexically_relative(folder).string());
  return names;
}

/// Expects that a message states `expected`: its subject and perhaps a field, then a colon; wording
/// after the last colon is not compared. FACTs after " | " are names and numbers that the message
/// must contain.
inline void expectStated(const std::string& message, const std::string& expected) {
  std::size_t end = expected.find(" | ");
  const std::string head = expected.substr(0, end) + ' ';
  if (const std::size_t colon = head.rfind(": "); colon != std::string::npos) {
    const std::string subject = head.substr(0, colon) + ": ";
    const std::size_t at = message.find(subject);
    EXPECT_TRUE(at == 0 ||
                (at < message.size() && (message[at - 1] == ' ' || message[at - 1] == '/')))
        << message << "\nexpected: " << subject;
  }
  while (end != std::string::npos) {
    const std::size_t begin = end + 3;
    end = expected.find(" | ", begin);
    const std::string fact = expected.substr(begin, end - begin);
    EXPECT_NE(message.find(fact), std::string::npos) << message << "\nexpected: " << fact;
  }
}

/// Expects that the first numbers after the first ": " are `counts`. Words are not compared.
inline void expectCounts(const std::string& text, const std::vector<int>& counts) {
  std::vector<int> found;
  std::size_t at = std::min(text.size(), text.find(": "));
  while (found.size() < counts.size() &&
         (at = text.find_first_of("0123456789", at)) != std::string::npos) {
    found.push_back(std::atoi(text.c_str() + at));
    at = text.find_first_not_of("0123456789", at);
  }
  EXPECT_EQ(found, counts) << text;
}

/// Expects one line on standard error: an error that states `expected`.
inline void expectErrorLine(const std::string& err, const std::string& expected) {
  const std::string start = "fenestra: error: ";
  EXPECT_TRUE(err.starts_with(start)) << err;
  EXPECT_EQ(err.find('\n'), err.size() - 1) << err;
  expectStated(err.substr(std::min(err.size(), start.size())), expected);
}

/// Command line that must fail with this exit status and error line.
struct ExpectedError {
  std::string name;
  Arguments arguments;
  int status;
  std::string text; ///< as for expectStated
};

/// Runs each command line. Expects its exit status, one line on standard error, nothing on standard
/// output, and no file created or removed.
inline void expectErrors(const std::vector<ExpectedError>& errors,
                         const std::filesystem::path& folder) {
  const std::set<std::string> before = listFiles(folder);
  for (const ExpectedError& error : errors) {
    SCOPED_TRACE(error.name);
    const Outcome outcome = run(error.arguments, folder);
    EXPECT_EQ(outcome.status, error.status) << outcome.err;
    expectErrorLine(outcome.err, error.text);
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(listFiles(folder), before);
  }
}

} // namespace fenestra::core
