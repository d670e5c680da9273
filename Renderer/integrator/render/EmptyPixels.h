#pragma once
// Pixels that need only one sample.

#include "integrator/scalar/MajorantGrid.h"
#include "model/camera/Camera.h"

#include <vector>

namespace fenestra::core {

/// Pixels whose camera rays (anywhere in the box filter's footprint) cross no cell of majorant > 0.
/// If the background is constant within each pixel, all samples of such a pixel are equal.
class EmptyPixels {
public:
  /// Contains no pixel.
  EmptyPixels() = default;
  EmptyPixels(const Camera& camera, const MajorantGrid& majorants);

  bool contains(int column, int row) const {
    return !m_isOccupied.empty() &&
           m_isOccupied[static_cast<std::size_t>(row / tileSize) * m_tilesPerRow +
                        static_cast<std::size_t>(column / tileSize)] == 0;
  }

private:
  static constexpr int tileSize = 4; ///< pixels

  std::size_t m_tilesPerRow = 0; ///< tiles per row
  std::vector<std::uint8_t> m_isOccupied;
};

} // namespace fenestra::core
