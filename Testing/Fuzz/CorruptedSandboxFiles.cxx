// Reads corrupted DICOM files, images and segmentations, transform files and image slices in the
// sandbox. Each must be read, or fail with an input Error of one line that names the file. usage:
// CorruptedSandboxFiles COUNT [SEED]

#include "TemporaryFolder.h"
#include "base/Error.h"
#include "files/medical/DicomSeries.h"
#include "files/medical/SliceFile.h"
#include "files/segments/DicomSegments.h"
#include "files/slicer/TransformFile.h"
#include "io/Sandbox.h"

#include <cstdio>
#include <random>

namespace fenestra::core {
namespace {

using Path = std::filesystem::path;
using Random = std::mt19937_64;

struct Seed {
  std::string extension, bytes;
};

std::vector<Seed> loadSeeds(const Path& folder) {
  std::vector<Seed> seeds;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    seeds.push_back({entry.path().extension(), readBytes(entry.path())});
  std::sort(seeds.begin(), seeds.end(), [](const Seed& a, const Seed& b) {
    return std::pair(a.extension, a.bytes) < std::pair(b.extension, b.bytes);
  });
  return seeds;
}

/// Applies up to six changes: replaces a byte or a number, removes or duplicates a range, or
/// truncates the bytes.
std::string corrupt(std::string bytes, Random& random) {
  const auto randomBelow = [&random](std::size_t limit) {
    return std::uniform_int_distribution<std::size_t>(0, limit - 1)(random);
  };
  for (std::size_t remaining = 1 + randomBelow(6); remaining > 0 && bytes.size() > 16;
       --remaining) {
    const std::size_t at = randomBelow(bytes.size() - 8), length = randomBelow(64);
    switch (randomBelow(6)) {
    case 0:
      bytes.replace(at, 1 + randomBelow(8), 8, randomBelow(2) ? '\xff' : '\0');
      break;
    case 1:
      bytes.erase(at, length);
      break;
    case 2:
      bytes.insert(randomBelow(bytes.size()), bytes.substr(at, length));
      break;
    case 3:
      if (randomBelow(8) == 0)
        bytes.resize(at);
      break;
    default:
      bytes[at] = static_cast<char>(randomBelow(256));
    }
  }
  return bytes;
}

struct Counts {
  int read = 0, refused = 0, wrong = 0;
};

template <typename Read>
void classify(Counts& counts, const Path& path, const Read& read) {
  std::string problem;
  try {
    read();
    ++counts.read;
    return;
  } catch (const Error& error) {
    const std::string line = error.what();
    if (error.kind() == ErrorKind::input && line.starts_with(path.string() + ": ") &&
        line.find('\n') == std::string::npos) {
      ++counts.refused;
      return;
    }
    problem = line;
  } catch (const std::exception& error) {
    problem = std::string("unexpected exception: ") + error.what();
  }
  ++counts.wrong;
  std::filesystem::copy_file(path,
                             "wrong" + std::to_string(counts.wrong) + path.extension().string(),
                             std::filesystem::copy_options::overwrite_existing);
  std::printf("%s\n", problem.c_str());
}

void readPages(const Path& path) {
  SliceReader reader;
  bool isLast = false;
  for (std::uint32_t page = 0; !isLast; ++page) {
    const SliceHeader header = reader.readHeader(path, page);
    reader.readSamples(path, page, header);
    isLast = header.isLast;
  }
}

int runAll(int total, Random random) {
  const TemporaryFolder folder;
  struct Kind {
    std::vector<Seed> seeds;
    void (*read)(const Path& path);
  };
  const Kind kinds[] = {{loadSeeds(FENESTRA_SANDBOX_FILES "/Dicom"),
                         [](const Path& path) { readDicomVolume({path}, path.string()); }},
                        {loadSeeds(FENESTRA_SANDBOX_FILES "/Segments"),
                         [](const Path& path) { readDicomSegments(path, nullptr); }},
                        {loadSeeds(FENESTRA_SANDBOX_FILES "/Transform"),
                         [](const Path& path) { readLinearTransform(path).inverse(); }},
                        {loadSeeds(FENESTRA_SANDBOX_FILES "/Image"), readPages}};
  Counts counts;
  for (int i = 0; i < total; ++i) {
    const auto& [seeds, read] = kinds[static_cast<std::size_t>(i) % std::size(kinds)];
    const Seed& seed = seeds[static_cast<std::size_t>(i) / std::size(kinds) % seeds.size()];
    const Path path = folder.write("damaged" + seed.extension, corrupt(seed.bytes, random));
    classify(counts, path, [&path, use = read] { use(path); });
  }
  std::printf("%d files: %d read, %d rejected, %d errors\n", total, counts.read, counts.refused,
              counts.wrong);
  return counts.wrong == 0 ? 0 : 1;
}

} // namespace
} // namespace fenestra::core

int main(int argc, char** argv) {
  fenestra::core::serveSandbox(argc, argv);
  if (argc != 2 && argc != 3) {
    std::fprintf(stderr, "usage: CorruptedSandboxFiles COUNT [SEED]\n");
    return 2;
  }
  return fenestra::core::runAll(std::atoi(argv[1]),
                                fenestra::core::Random(argc == 3 ? std::stoull(argv[2]) : 1));
}
