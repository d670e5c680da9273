#pragma once
// Text of small TIFF files, little-endian, with one strip per page.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace fenestra::core {

struct TiffPages {
  std::uint32_t columns = 4, rows = 3;
  std::uint16_t bits = 8, sampleFormat = 1; ///< 1: unsigned, 2: signed, 3: floating point
  std::uint16_t samples = 1;
  std::uint16_t photometric = 1; ///< 0: white is zero, 1: black is zero, 2: RGB
  std::uint16_t orientation = 1;
  std::uint16_t compression = 1; ///< 1: none, 8: zlib

  /// `strips`: samples of the pages as they are stored.
  std::string encode(const std::vector<std::string>& strips) const {
    std::string file("II\x2a\0", 4);
    std::size_t link = file.size();
    put<std::uint32_t>(file, 0);
    for (const std::string& strip : strips) {
      const std::size_t begin = file.size();
      file += strip;
      file.append(file.size() % 2, '\0');
      const auto directory = static_cast<std::uint32_t>(file.size());
      for (unsigned i = 0; i < 4; ++i)
        file[link + i] = static_cast<char>(directory >> (8 * i));
      addDirectory(file, begin, strip.size());
      link = file.size();
      put<std::uint32_t>(file, 0);
    }
    return file;
  }

private:
  template <typename T>
  static void put(std::string& file, std::size_t value) {
    for (unsigned i = 0; i < sizeof(T); ++i)
      file += static_cast<char>(value >> (8 * i));
  }

  void addDirectory(std::string& file, std::size_t begin, std::size_t bytes) const {
    const std::array<std::array<std::size_t, 2>, 11> fields = {{{256, columns},
                                                                {257, rows},
                                                                {258, bits},
                                                                {259, compression},
                                                                {262, photometric},
                                                                {273, begin},
                                                                {274, orientation},
                                                                {277, samples},
                                                                {278, rows},
                                                                {279, bytes},
                                                                {339, sampleFormat}}};
    put<std::uint16_t>(file, fields.size());
    for (const auto& [tag, value] : fields) {
      const bool isLong = tag == 256 || tag == 257 || tag == 273 || tag == 278 || tag == 279;
      put<std::uint16_t>(file, tag);
      put<std::uint16_t>(file, isLong ? 4 : 3);
      put<std::uint32_t>(file, 1);
      put<std::uint32_t>(file, value);
    }
  }
};

} // namespace fenestra::core
