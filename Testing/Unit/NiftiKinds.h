#pragma once
// Bytes of NIfTI-2, FreeSurfer and paired files with the content of a NIfTI-1 file.

#include "NiftiFile.h"

#include <algorithm>
#include <bit>

namespace fenestra::core {

/// Bytes of numbers in a byte order.
class Bytes {
public:
  Bytes(std::size_t size, std::endian order) : m_bytes(size, '\0'), m_order(order) {}

  template <typename T>
  void put(std::size_t at, T value) {
    std::string bytes(reinterpret_cast<const char*>(&value), sizeof value);
    if (m_order != std::endian::native)
      std::ranges::reverse(bytes);
    m_bytes.resize(std::max(m_bytes.size(), at + sizeof value), '\0');
    std::ranges::copy(bytes, m_bytes.begin() + std::ptrdiff_t(at));
  }
  template <typename T>
  void append(const std::vector<T>& values) {
    for (const T value : values)
      put(m_bytes.size(), value);
  }
  void putText(std::size_t at, const std::string& text) {
    std::ranges::copy(text, m_bytes.begin() + std::ptrdiff_t(at));
  }
  const std::string& get() const { return m_bytes; }

private:
  std::string m_bytes;
  std::endian m_order;
};

/// The image of a NIfTI-1 file with a sform as NIfTI-2.
inline std::string makeNifti2(const NiftiFile& file, std::endian order) {
  Bytes bytes(544, order);
  bytes.put(0, std::int32_t{540});
  bytes.putText(4, "n+2");
  bytes.put(12, std::int16_t{4}); // int16
  bytes.put(16, std::int64_t{3});
  for (std::size_t axis = 0; axis < 3; ++axis) {
    bytes.put(24 + 8 * axis, std::int64_t{file.size[axis]});
    bytes.put(112 + 8 * axis, double{file.pixdim[axis + 1]});
  }
  bytes.put(168, std::int64_t{544});
  bytes.put(176, 1.0); // slope
  bytes.put(348, std::int32_t{file.sformCode});
  for (std::size_t i = 0; i < 12; ++i)
    bytes.put(400 + 8 * i, double{file.rows[i]});
  bytes.put(500, std::int32_t{2}); // mm
  bytes.append(file.samples);
  return bytes.get();
}

/// The samples of a NIfTI-1 file as a FreeSurfer volume, which `map` places.
inline std::string makeMgh(const NiftiFile& file, const Affine& map) {
  Bytes bytes(284, std::endian::big);
  bytes.put(0, std::int32_t{1});
  const Mat3 axes = map.linear().normalizedColumns();
  const Vec3 spacing = map.linear().columnNorms();
  const Vec3 half(0.5 * file.size[0], 0.5 * file.size[1], 0.5 * file.size[2]);
  const Vec3 center = map * half;
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    bytes.put(4 + 4 * i, std::int32_t{file.size[i]});
    bytes.put(30 + 4 * i, static_cast<float>(spacing[axis]));
    bytes.put(78 + 4 * i, static_cast<float>(center[axis]));
    for (int row = 0; row < 3; ++row)
      bytes.put(42 + 12 * i + 4 * static_cast<std::size_t>(row),
                static_cast<float>(axes(row, axis)));
  }
  bytes.put(16, std::int32_t{1}); // frames
  bytes.put(20, std::int32_t{4}); // int16
  bytes.put(28, std::int16_t{1}); // has directions
  bytes.append(file.samples);
  return bytes.get();
}

/// Contents of a .hdr and a .img file.
struct Pair {
  std::string header, samples;
};

inline Pair makePair(const NiftiFile& file, const std::string& magic) {
  const std::string bytes = file.bytes();
  Pair pair{bytes.substr(0, 348), bytes.substr(352)};
  const float offset = 0.0f;
  std::memcpy(&pair.header[108], &offset, sizeof offset);
  pair.header.replace(344, 3, magic);
  return pair;
}

} // namespace fenestra::core
