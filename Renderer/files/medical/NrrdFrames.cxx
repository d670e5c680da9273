#include "files/medical/NrrdFrames.h"

#include "base/Error.h"
#include "files/formats/NrrdHeader.h"
#include "files/formats/TextHeader.h"
#include "files/medical/SampleStream.h"

#include <algorithm>
#include <array>
#include <map>
#include <vector>

namespace fenestra::core {

using namespace header;

namespace {

using Path = std::filesystem::path;

/// Sample type by its names in teem.
SampleType findType(const Path& path, const std::string& name) {
  static const std::map<std::string, SampleType> types = [] {
    std::map<std::string, SampleType> all = {{"float", float()}, {"double", double()}};
    const auto add = [&](SampleType isSigned, SampleType isUnsigned, const std::string& bits,
                         const std::vector<std::string>& words) {
      for (const std::string& word : words) {
        all[word] = all["signed " + word] = isSigned;
        all["unsigned " + word] = isUnsigned;
      }
      for (const char* end : {"", "_t"}) {
        all[concat("int", bits, end)] = isSigned;
        all[concat("uint", bits, end)] = isUnsigned;
      }
      all["u" + words.front()] = isUnsigned;
    };
    add(std::int8_t(), std::uint8_t(), "8", {"char"});
    add(std::int16_t(), std::uint16_t(), "16", {"short", "short int"});
    add(std::int32_t(), std::uint32_t(), "32", {"int"});
    add(std::int64_t(), std::uint64_t(), "64", {"longlong", "long long", "long long int"});
    return all;
  }();
  const auto type = types.find(toLower(name));
  if (type == types.end())
    throw fieldError(path, "type", "is not supported; convert it to 16-bit integers");
  return type->second;
}

/// The first three numbers. Throws Error (input) if there are fewer.
Vec3 toVector(const Path& path, const char* field, const std::vector<double>& numbers) {
  if (numbers.size() < 3)
    throw fieldError(path, field, "needs vectors of three numbers; fix the header");
  return {numbers[0], numbers[1], numbers[2]};
}

/// From the file's space to RAS. A space without anatomical directions is taken as LPS.
Mat3 toRas(const std::string& space) {
  const bool isRight = space.starts_with("right-") || space.starts_with("ra");
  const bool isAnterior = space.find("-anterior-") != std::string::npos ||
                          space.starts_with("ra") || space.starts_with("la");
  return Mat3::Diagonal({isRight ? 1.0 : -1.0, isAnterior ? 1.0 : -1.0, 1.0});
}

/// Direction of each axis, mm; those of the time axis are not used.
std::array<Vec3, 4> readDirections(const Path& path, const Fields& fields, std::size_t time,
                                   const std::optional<Vec3>& spacing) {
  const auto vectors = parseNrrdVectors(findValue(fields, "spacedirections"));
  const auto numbers = parseNumbers(findValue(fields, "spacings"));
  const bool hasNumbers = numbers && !numbers->empty();
  if (hasNumbers && (numbers->size() != 4 || *std::ranges::min_element(*numbers) <= 0.0))
    throw fieldError(path, "spacings", "must be four positive numbers; fix the header");
  std::array<Vec3, 4> directions;
  for (std::size_t axis = 0, spatial = 0; axis < directions.size(); ++axis) {
    if (axis == time)
      continue;
    const auto dimension = static_cast<int>(spatial++);
    if (vectors && !vectors->empty()) {
      directions[axis] = toVector(path, "space directions", (*vectors)[axis]);
    } else {
      directions[axis] = Vec3::Zero();
      directions[axis][dimension] = hasNumbers ? (*numbers)[axis]
                                    : spacing  ? (*spacing)[dimension]
                                               : 1.0;
    }
  }
  return directions;
}

Vec3 readOrigin(const Path& path, const Fields& fields) {
  if (fields.contains("axismins"))
    throw fieldError(path, "axis mins",
                     "is not supported beside a first axis of time; write a "
                     "space with its origin");
  const auto origin = parseNrrdVectors(findValue(fields, "spaceorigin"));
  if (!origin || origin->size() > 1)
    throw fieldError(path, "space origin", "must be a vector; fix the header");
  return origin->empty() ? Vec3::Zero() : toVector(path, "space origin", origin->front());
}

} // namespace

std::optional<NrrdFrames> findNrrdFrames(const Path& path, const std::optional<Vec3>& spacing) {
  const Fields fields = readNrrdHeader(path).fields;
  const std::optional<std::size_t> time = findNrrdFrameAxis(fields);
  const bool hasSpace = fields.contains("space") || fields.contains("spacedimension");
  if (!time || (!hasSpace && *time == 3))
    return std::nullopt;
  const std::vector<std::string> sizes = splitWords(findValue(fields, "sizes"));
  if (sizes.size() != 4)
    throw damagedError(path, "NRRD");
  if (*time == 1 || *time == 2)
    throw inputError(ErrorCode::unsupportedFile, path, "has time as axis ", *time + 1,
                     " of four; write it as the first or the last");
  const std::array<Vec3, 4> directions = readDirections(path, fields, *time, spacing);
  NrrdFrames frames;
  frames.isInterleaved = *time == 0;
  const auto vectors = parseNrrdVectors(findValue(fields, "spacedirections"));
  frames.hasSpaceTime = vectors && !vectors->empty() && !(*vectors)[*time].empty();
  frames.type = findType(path, findValue(fields, "type"));
  frames.count = static_cast<std::size_t>(*parseInteger(sizes[*time]));
  Mat3 steps;
  for (std::size_t axis = 0, first = *time == 0 ? 1 : 0; axis < 3; ++axis) {
    frames.size[static_cast<int>(axis)] = *parseInteger(sizes[first + axis]);
    steps.col(static_cast<int>(axis)) = directions[first + axis];
  }
  const Mat3 ras = toRas(toLower(findValue(fields, "space")));
  frames.indexToRas = Affine(ras * steps, ras * readOrigin(path, fields));
  return frames;
}

SampleSource openNrrdFrames(const Path& path, const StoredSamples& stored,
                            const NrrdFrames& frames) {
  SampleSource source{.type = frames.type};
  const std::size_t sampleBytes = bytesPerSample(source.type);
  if (!(stored.isRaw || stored.isStream) || (sampleBytes > 1 && !stored.order))
    throw inputError(ErrorCode::unsupportedFile, path,
                     "has frames as text, in several files or without an endian; write it again, "
                     "as raw or gzip");
  std::uint64_t count = frames.count;
  for (const std::int64_t size : frames.size)
    if (__builtin_mul_overflow(count, size, &count))
      count = UINT64_MAX;
  const std::uint64_t declared = checkDeclaredBytes(path, stored, count, sampleBytes);
  source.count = static_cast<std::size_t>(count);
  source.isSwapped = sampleBytes > 1 && *stored.order != std::endian::native;
  openStream(path, stored, declared, source);
  return source;
}

} // namespace fenestra::core
