#include "files/medical/SliceFile.h"

#include "base/Error.h"
#include "io/InputRegistry.h"

#include <optional>
#include <stdexcept>
#include <vector>

namespace fenestra::core {
namespace {

using Path = std::filesystem::path;

std::string makeRequest(char kind, std::uint32_t page, const Path& path) {
  std::string request(1, kind);
  return request.append(reinterpret_cast<const char*>(&page), sizeof page).append(path.string());
}

/// Throws Error (input) unless there is no problem.
void rejectProblem(const Path& path, SliceProblem problem) {
  const auto refuse = [&](const char* what) {
    throw inputError(ErrorCode::unsupportedFile, path, what);
  };
  using enum SliceProblem;
  switch (problem) {
  case none:
    return;
  case color:
    return refuse("is a color image; save the slices with one gray value per pixel");
  case alpha:
    return refuse("has an alpha channel; save the slices with one gray value per pixel");
  case tiled:
    return refuse("has tiles; save it with rows (strips)");
  case inverted:
    return refuse("has inverted gray values (WhiteIsZero); save it with BlackIsZero");
  case orientation:
    return refuse("is rotated or mirrored by its Orientation field; save it upright");
  case large:
    throw inputError(ErrorCode::limitExceeded, path, "has more than ", maxSliceBytes >> 20,
                     " MB of samples; crop the slices or reduce their size");
  case depth:
    break;
  }
  refuse("has an unsupported sample type; save the slices with 8 or 16 bits, or as TIFF of 32-bit "
         "floats");
}

/// Interprets a reply, which is untrusted. Throws std::runtime_error for a malformed one.
SliceHeader parseHeader(const Path& path, const std::string& reply) {
  constexpr double maxSide = 0x1p31;
  const std::vector<double> numbers = ReplyReader(reply).numbers();
  if (numbers.size() != 5)
    throw std::runtime_error("reply has another length");
  for (const double x : numbers)
    if (!(x >= 0.0 && x < maxSide))
      throw std::runtime_error("reply has a value out of range");
  rejectProblem(path, static_cast<SliceProblem>(static_cast<int>(numbers[0])));
  const SliceHeader header{.columns = static_cast<std::uint32_t>(numbers[1]),
                           .rows = static_cast<std::uint32_t>(numbers[2]),
                           .type = static_cast<std::size_t>(numbers[3]),
                           .isLast = numbers[4] != 0.0};
  if (header.columns == 0 || header.rows == 0 || header.type >= sliceTypes.size() ||
      header.columns > maxSliceBytes || header.rows > maxSliceBytes / header.columns)
    throw std::runtime_error("reply contradicts itself");
  return header;
}

Error makeDamagedSliceError(const Path& path) {
  return inputError(ErrorCode::damagedFile, path,
                    "is damaged, truncated or does not match its extension; save it again");
}

} // namespace

bool isTiff(const Path& path) {
  const std::string extension = lowercaseExtension(path);
  return extension == ".tif" || extension == ".tiff";
}

bool isSliceFile(const Path& path) {
  return isTiff(path) || lowercaseExtension(path) == ".png";
}

SliceReader::SliceReader() : m_reader(sliceJob) {}

SliceHeader SliceReader::readHeader(const Path& path, std::uint32_t page) {
  constexpr std::uint64_t maxBytes = 1 << 10;
  requireFile(path, "give only the folder");
  try {
    if (const auto reply = m_reader.request(makeRequest(sliceHeaderRequest, page, path), maxBytes);
        reply && !reply->empty())
      return parseHeader(path, *reply);
  } catch (const Error&) {
    throw;
  } catch (const std::runtime_error&) { // malformed reply
  }
  throw makeDamagedSliceError(path);
}

std::string SliceReader::readSamples(const Path& path, std::uint32_t page,
                                     const SliceHeader& header) {
  auto reply = m_reader.request(makeRequest(sliceSamplesRequest, page, path), header.bytes());
  if (!reply || reply->size() != header.bytes())
    throw makeDamagedSliceError(path);
  return *std::move(reply);
}

} // namespace fenestra::core
