#ifndef __FenestraViewImage_h
#define __FenestraViewImage_h

#include <cstddef>
#include <limits>
#include <vector>

/// An image of one camera, with a depth per pixel. The upper row first.
struct FenestraViewImage {
  static constexpr float noDepth = std::numeric_limits<float>::infinity();

  int width = 0, height = 0;       ///< pixels
  std::vector<unsigned char> rgba; ///< display colors (sRGB) with straight alpha, 4 per pixel
  std::vector<float> depth;        ///< mm from the camera along its view axis; `noDepth`: nothing

  /// False: the arrays do not fit the size.
  bool IsValid() const {
    if (this->width <= 0 || this->height <= 0)
      return false;
    const auto pixels =
        static_cast<std::size_t>(this->width) * static_cast<std::size_t>(this->height);
    return this->rgba.size() == 4 * pixels && this->depth.size() == pixels;
  }
  std::size_t GetIndex(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(this->width) +
           static_cast<std::size_t>(column);
  }
};

#endif
