// Checkpoint files: content is read back unchanged, and any other file is rejected.

#include "scene/CheckpointFile.h"

#include "FilmTesting.h"
#include "Refusals.h"
#include "io/Digest.h"

#include <array>
#include <random>

namespace fenestra::core::testing::CheckpointFileTests {
namespace {

const nlohmann::ordered_json testMetadata = {{"version", "1"}, {"settings", {{"seed", {"1"}}}}};

RenderResult renderResult(int width, int height, double noise) {
  RenderSettings settings;
  settings.samples = 21;
  settings.noise = noise;
  settings.path.wantNormals = true;
  return makeWavyScene(width, height).render(settings);
}

RenderResult readCheckpoint(const std::filesystem::path& path) {
  const CheckpointFile file(path);
  RenderResult result = file.readProgress();
  file.readPixels(result.film);
  return result;
}

/// Copies the flags of deterministic pixels, which follow from the scene and are not stored.
void copyDeterministic(const Film& from, Film& to) {
  for (int row = 0; row < to.height(); ++row)
    for (int column = 0; column < to.width(); ++column)
      to.at(column, row).isDeterministic = from.at(column, row).isDeterministic;
}

TEST(CheckpointFile, RoundTripPreservesEveryBit) {
  const TemporaryFolder folder;
  for (const double noise : {-1.0, 0.01}) {
    const RenderResult result = renderResult(80, 72, noise);
    EXPECT_EQ(result.last.plan.noise().empty(), noise < 0.0);
    const auto path = folder.write("a.film", encodeCheckpoint(result, {}, testMetadata));
    EXPECT_EQ(CheckpointFile(path).metadata(), nlohmann::json(testMetadata));
    RenderResult loaded = readCheckpoint(path);
    copyDeterministic(result.film, loaded.film);
    expectIdentical(result.film, loaded.film);
    EXPECT_EQ(loaded.film.hasIndependentHalves(), result.film.hasIndependentHalves());
    EXPECT_EQ(loaded.finishedSamples, result.finishedSamples);
    EXPECT_EQ(loaded.begunSamples, result.begunSamples);
    EXPECT_EQ(loaded.last.samples, result.last.samples);
    EXPECT_EQ(loaded.last.noise, result.last.noise);
    EXPECT_EQ(loaded.last.plan.noise(), result.last.plan.noise());
    EXPECT_EQ(loaded.target, result.target);
    EXPECT_EQ(loaded.counters.paths, result.counters.paths);
    EXPECT_EQ(loaded.counters.gradients, result.counters.gradients);
  }
}

TEST(CheckpointFile, ShardsContainOnlyTheirTiles) {
  const TemporaryFolder folder;
  const RenderResult result = renderResult(33, 21, -1.0);
  Film sum =
      readCheckpoint(folder.write("a.film", encodeCheckpoint(result, {}, testMetadata))).film;
  const Film full = sum;
  std::size_t bytes = 0;
  sum = Film(33, 21, true, result.film.pixels().front().blockSize);
  for (int index = 0; index < 4; ++index) {
    const auto path = folder.write("p.film", encodeCheckpoint(result, {index, 4}, testMetadata));
    bytes += readBytes(path).size();
    EXPECT_EQ(CheckpointFile(path).shard(), (Shard{index, 4}));
    CheckpointFile(path).readPixels(sum);
  }
  expectIdentical(full, sum);
  EXPECT_LT(bytes, readBytes(folder / "a.film").size() + 4000);
}

/// Upper bound of a header's size in these files: damage is denser there than in the pixels.
constexpr std::size_t headerBytes = 700;

TEST(CheckpointFile, AnyDamagedByteIsRejected) {
  const TemporaryFolder folder;
  const std::string content = encodeCheckpoint(renderResult(8, 8, -1.0), {}, testMetadata);
  ASSERT_NO_THROW(readCheckpoint(folder.write("a.film", content)));
  std::mt19937 random(1);
  for (std::size_t at = 0; at < content.size(); at += 1 + random() % (at < headerBytes ? 5 : 90)) {
    std::string damaged = content;
    damaged[at] = static_cast<char>(damaged[at] ^ 1 << random() % 8);
    const auto path = folder.write("a.film", damaged);
    expectRefused(path, "", [&] { readCheckpoint(path); });
  }
}

TEST(CheckpointFile, TruncatedOrLongerFileIsRejected) {
  const TemporaryFolder folder;
  const std::string content = encodeCheckpoint(renderResult(8, 8, -1.0), {}, testMetadata);
  for (std::size_t size = 0; size < content.size(); size += size < headerBytes ? 23 : 1009) {
    const auto path = folder.write("a.film", content.substr(0, size));
    expectRefused(path, "", [&] { readCheckpoint(path); });
  }
  const auto path = folder.write("a.film", content + '\0');
  expectRefused(path, "damaged-file", [&] { readCheckpoint(path); });
}

/// `content` with a correct digest.
std::string withDigest(std::string content) {
  content.resize(content.size() - sizeof(std::uint64_t));
  Digest digest;
  digest.add(content);
  return content += asBytes(std::array{digest.value()});
}

/// `content` with a text of its header replaced by one of the same length, and a correct digest.
std::string replaceText(std::string content, const std::string& text,
                        const std::string& replacement) {
  EXPECT_EQ(text.size(), replacement.size());
  const std::size_t at = content.find(text);
  EXPECT_NE(at, content.npos) << text;
  return withDigest(content.replace(at, text.size(), replacement));
}

TEST(CheckpointFile, ForgedHeaderIsRejected) {
  const TemporaryFolder folder;
  const std::string content = encodeCheckpoint(renderResult(8, 8, -1.0), {}, testMetadata);
  ASSERT_NO_THROW(readCheckpoint(folder.write("a.film", replaceText(content, "[8,8]", "[8,8]"))));
  const std::pair<const char*, const char*> forgeries[] = {
      {"[8,8]", "[9,8]"},
      {"[8,8]", "[0,8]"},
      {"[0,1]", "[1,1]"},
      {"[0,1]", "[0,0]"},
      {"[0,1]", "[1,2]"},
      {"\"block\":8", "\"block\":0"},
      {"\"begun\":21", "\"begun\":-1"},
      {"\"finished\"", "\"finish\":0"},
      {"false", "true "},
      {"\"made\"", "\"mode\""},
  };
  for (const auto& [text, replacement] : forgeries) {
    const auto path = folder.write("a.film", replaceText(content, text, replacement));
    expectRefused(path, "", [&] { readCheckpoint(path); });
  }
}

TEST(CheckpointFile, ChangedFileWithACorrectDigestIsReadOrRejected) {
  const TemporaryFolder folder;
  const std::string content = encodeCheckpoint(renderResult(2, 2, -1.0), {}, testMetadata);
  std::mt19937 random(2);
  int read = 0;
  for (int i = 0; i < 500; ++i) {
    std::string changed = content;
    for (int change = 0; change < 2; ++change)
      changed[random() % 420] = static_cast<char>(random() % 4 ? '0' + random() % 10 : random());
    const auto path = folder.write("a.film", withDigest(changed));
    try {
      readCheckpoint(path);
      ++read;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input) << error.what();
    }
  }
  EXPECT_GT(read, 10);
  EXPECT_LT(read, 490);
}

} // namespace
} // namespace fenestra::core::testing::CheckpointFileTests
