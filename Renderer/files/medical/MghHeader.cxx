#include "files/medical/MghHeader.h"

#include "base/Error.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <map>

namespace fenestra::core {
namespace {

/// Big-endian number at a byte offset.
template <typename T>
T readBigEndian(std::string_view bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  if constexpr (std::endian::native == std::endian::little)
    swapBytes(value);
  return value;
}

SampleType readMghType(std::string_view bytes, const std::filesystem::path& path) {
  static const std::map<std::int32_t, SampleType> types = {// MRI_… of FreeSurfer's mri.h
                                                           {0, std::uint8_t()},
                                                           {1, std::int32_t()},
                                                           {3, float()},
                                                           {4, std::int16_t()},
                                                           {10, std::uint16_t()}};
  const auto code = readBigEndian<std::int32_t>(bytes, 20);
  const auto type = types.find(code);
  if (type == types.end())
    throw fieldError(path, "type", code, " is not a scalar type; convert it with mri_convert");
  return type->second;
}

/// Index to RAS from directions, spacings and the position of the center, which is at half of the
/// size, not of the last index.
Affine readMghGeometry(std::string_view bytes, const std::filesystem::path& path,
                       const Vec3& center) {
  const auto triple = [&](std::size_t at) {
    Vec3 values;
    for (int i = 0; i < 3; ++i)
      values[i] = double{readBigEndian<float>(bytes, at + 4 * static_cast<std::size_t>(i))};
    return values;
  };
  Mat3 axes;
  for (int axis = 0; axis < 3; ++axis)
    axes.col(axis) = triple(42 + 12 * static_cast<std::size_t>(axis));
  const Vec3 spacing = triple(30), position = triple(78);
  const auto isUsable = [](const Vec3& values) { return (values.array().abs() < 1e9).all(); };
  if (!isUsable(axes.col(0)) || !isUsable(axes.col(1)) || !isUsable(axes.col(2)) ||
      !isUsable(spacing) || !isUsable(position))
    throw fieldError(path, "directions",
                     "has a number that is not finite or exceeds 1e9 mm; write it again");
  const Mat3 linear = axes * Mat3::Diagonal(spacing);
  return Affine(linear, position - linear * center);
}

} // namespace

NiftiHeader parseMghHeader(std::string_view bytes, const std::filesystem::path& path) {
  NiftiHeader header;
  for (std::size_t axis = 0; axis < 4; ++axis)
    header.size.push_back(readBigEndian<std::int32_t>(bytes, 4 + 4 * axis));
  if (readBigEndian<std::int32_t>(bytes, 0) != 1 ||
      !std::ranges::all_of(header.size, [](std::int64_t n) { return n >= 1; }))
    throw inputError(ErrorCode::damagedFile, path,
                     "is not a FreeSurfer volume, or its header is damaged; write it again");
  header.type = readMghType(bytes, path);
  header.isSwapped = std::endian::native == std::endian::little;
  header.offset = mghHeaderBytes;
  const Vec3 center = 0.5 * Size3(header.size[0], header.size[1], header.size[2]).cast<double>();
  if (readBigEndian<std::int16_t>(bytes, 28) != 0) {
    header.indexToRas = readMghGeometry(bytes, path, center);
    return header;
  }
  const Mat3 coronal(Vec3(-1, 0, 0), Vec3(0, 0, -1), Vec3(0, 1, 0));
  header.indexToRas = Affine(coronal, Vec3(Vec3::Zero() - coronal * center));
  header.warnings.push_back(makeMessage(
      ErrorCode::assumedGeometry, path,
      "states no directions; voxels of 1 mm are placed around the origin, along left, inferior and "
      "anterior"));
  return header;
}

} // namespace fenestra::core
