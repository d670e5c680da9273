#include "scene/CheckpointFile.h"

#include "image/PixelWords.h"
#include "io/Digest.h"
#include "io/InputRegistry.h"
#include "io/JsonNode.h"

#include <array>
#include <cstring>

namespace fenestra::core {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using nlohmann::ordered_json;

constexpr std::string_view magic = "fenestra film 1 ";
constexpr std::size_t maxFirstLine = 40;
constexpr double maxSamples = 0x1p62; ///< so that sums of a few counts fit 64 bits

/// Calls visit(column, row) for the pixels of a shard, in the order of the file.
template <typename Visit>
void forEachPixel(const Film& film, const Shard& shard, Visit&& visit) {
  const Tiles tiles(film.width(), film.height());
  for (const int number : tiles.select(shard)) {
    const Tiles::Tile tile = tiles.at(number);
    for (int row = tile.top; row < tile.bottom; ++row)
      for (int column = tile.left; column < tile.right; ++column)
        visit(column, row);
  }
}

std::uint64_t countPixels(int width, int height, const Shard& shard) {
  const Tiles tiles(width, height);
  std::uint64_t pixels = 0;
  for (const int number : tiles.select(shard)) {
    const Tiles::Tile tile = tiles.at(number);
    pixels += static_cast<std::uint64_t>(tile.right - tile.left) *
              static_cast<std::uint64_t>(tile.bottom - tile.top);
  }
  return pixels;
}

struct NamedCount {
  const char* name;
  std::uint64_t Counters::*count;
};

constexpr NamedCount namedCounts[] = {
    {"paths", &Counters::paths},
    {"collisions", &Counters::collisions},
    {"lookups", &Counters::lookups},
    {"cells", &Counters::cells},
    {"skippedCells", &Counters::skippedCells},
    {"shadowRays", &Counters::shadowRays},
    {"gradients", &Counters::gradients},
};

ordered_json makeHeader(const RenderResult& result, const Shard& shard,
                        const ordered_json& metadata) {
  ordered_json header = {{"size", {result.film.width(), result.film.height()}},
                         {"part", {shard.index, shard.count}},
                         {"block", result.film.pixels().front().blockSize},
                         {"target", result.target},
                         {"finished", result.finishedSamples},
                         {"begun", result.begunSamples},
                         {"lastPass", result.last.samples},
                         {"lastNoise", result.last.noise}, // null: infinite
                         {"hasPlan", !result.last.plan.noise().empty()},
                         {"counts", ordered_json::object()},
                         {"made", metadata}};
  for (const auto& [name, count] : namedCounts)
    header["counts"][name] = result.counters.*count;
  return header;
}

} // namespace

std::string encodeCheckpoint(const RenderResult& result, const Shard& shard,
                             const ordered_json& metadata) {
  const Film& film = result.film;
  const std::string header = dumpJson(makeHeader(result, shard, metadata), -1) + '\n';
  const std::vector<float>& plan = result.last.plan.noise();
  std::string content = concat(magic, header.size(), '\n', header);
  content.reserve(content.size() +
                  sizeof(PixelWords) * countPixels(film.width(), film.height(), shard) +
                  plan.size() * sizeof(float) + sizeof(std::uint64_t));
  forEachPixel(film, shard,
               [&](int column, int row) { content += asBytes(toWords(film.at(column, row))); });
  content += asBytes(plan);
  Digest digest;
  digest.add(content);
  return content += asBytes(std::array{digest.value()});
}

CheckpointFile::CheckpointFile(const fs::path& path) : m_path(path) {
  requireFile(path, "give a checkpoint file");
  std::ifstream file = open(0);
  std::string line(maxFirstLine, '\0');
  file.read(line.data(), static_cast<std::streamsize>(line.size()));
  line.resize(static_cast<std::size_t>(file.gcount()));
  const std::size_t end = line.find('\n');
  const auto bytes = line.starts_with(magic) && end != line.npos
                         ? parseNumber<std::uint64_t>(line.substr(magic.size(), end - magic.size()))
                         : std::nullopt;
  if (!bytes)
    throw inputError(ErrorCode::unsupportedFile, path,
                     "is not a checkpoint of this version of Fenestra; choose another file, "
                     "or move it away to start over");
  const std::uint64_t size = fs::file_size(path);
  std::array<std::uint64_t, 1> digest = {};
  if (*bytes > maxTextBytes || size < end + 1 + *bytes + sizeof digest)
    throw makeDamageError();
  open(size - sizeof digest).read(reinterpret_cast<char*>(digest.data()), sizeof digest);
  if (computeDigest(path, size - sizeof digest) != digest.front())
    throw makeDamageError();
  std::string text(*bytes, '\0');
  open(end + 1).read(text.data(), static_cast<std::streamsize>(text.size()));
  m_header = parseJson(text, path.string());
  const JsonNode header(m_header, path.string());
  constexpr int maxSide = 1 << 14; // as --size
  const std::vector<double> sides = header.at("size").numbers(2, 1, maxSide),
                            shard = header.at("part").numbers(2, 0, maxShards);
  m_width = static_cast<int>(sides[0]);
  m_height = static_cast<int>(sides[1]);
  m_shard = {static_cast<int>(shard[0]), static_cast<int>(shard[1])};
  m_hasPlan = header.at("hasPlan").boolean();
  if (m_shard.index >= m_shard.count || !header.at("made").isObject())
    throw makeDamageError();
  m_pixelsBegin = end + 1 + *bytes;
  m_planBegin = m_pixelsBegin + sizeof(PixelWords) * countPixels(m_width, m_height, m_shard);
  const std::uint64_t pixels =
      static_cast<std::uint64_t>(m_width) * static_cast<std::uint64_t>(m_height);
  if (size != m_planBegin + (m_hasPlan ? pixels * sizeof(float) : 0) + sizeof digest)
    throw makeDamageError();
}

Error CheckpointFile::makeDamageError() const {
  return inputError(ErrorCode::damagedFile, m_path,
                    "is a damaged checkpoint; delete it, and render again");
}

std::ifstream CheckpointFile::open(std::uint64_t position) const {
  std::ifstream file(m_path, std::ios::binary);
  file.seekg(static_cast<std::streamoff>(position));
  return file;
}

std::string CheckpointFile::target() const {
  return JsonNode(m_header, m_path.string()).at("target").text();
}

std::uint64_t CheckpointFile::readCount(const char* key) const {
  const double samples = JsonNode(m_header, m_path.string()).at(key).number(0.0, maxSamples);
  return static_cast<std::uint64_t>(samples);
}

Counters CheckpointFile::counters() const {
  const JsonNode counts = JsonNode(m_header, m_path.string()).at("counts");
  Counters counters;
  for (const auto& [name, count] : namedCounts)
    counters.*count = static_cast<std::uint64_t>(counts.at(name).number(0.0, maxSamples));
  return counters;
}

RenderResult CheckpointFile::readProgress() const {
  const JsonNode header(m_header, m_path.string());
  constexpr double maxBlockSize = 1024.0;
  const auto block = static_cast<std::uint32_t>(header.at("block").number(1.0, maxBlockSize));
  RenderResult result{Film(m_width, m_height, Sampler::hasIndependentHalfBuffers, block)};
  result.target = target();
  result.counters = counters();
  result.finishedSamples = finishedSamples();
  result.begunSamples = begunSamples();
  result.last.samples = readCount("lastPass");
  if (header.at("lastNoise").isNumber())
    result.last.noise = header.at("lastNoise").number(0.0, infinity);
  if (!m_hasPlan)
    return result;
  std::vector<float> plan(result.film.pixelCount());
  open(m_planBegin)
      .read(reinterpret_cast<char*>(plan.data()),
            static_cast<std::streamsize>(plan.size() * sizeof(float)));
  if (!std::ranges::all_of(plan, [](float s) { return s >= 0.0F && std::isfinite(s); }))
    throw makeDamageError();
  result.last.plan = SamplePlan(std::move(plan));
  return result;
}

void CheckpointFile::readPixels(Film& film) const {
  std::ifstream file = open(m_pixelsBegin);
  PixelWords words = {};
  forEachPixel(film, m_shard, [&](int column, int row) {
    file.read(reinterpret_cast<char*>(words.data()), sizeof words);
    fromWords(words, film.at(column, row));
  });
  if (!file)
    throw makeDamageError();
}

} // namespace fenestra::core
