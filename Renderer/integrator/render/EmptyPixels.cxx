#include "integrator/render/EmptyPixels.h"

#include "model/camera/BoxProjection.h"

#include <tbb/combinable.h>
#include <tbb/parallel_for.h>

namespace fenestra::core {
namespace {

/// Tolerance, pixels; larger than the rounding error of a projection.
constexpr double tolerance = 0.01;

/// First and last tile that raster coordinates from `low` to `high` touch; first > last if none.
/// All tiles if both are NaN.
std::pair<int, int> findTiles(double low, double high, int pixels, int tileSize) {
  if (low - tolerance >= pixels || high + tolerance < 0.0)
    return {0, -1};
  const double last = pixels - 1.0;
  const double from = low - tolerance > 0.0 ? std::min(low - tolerance, last) : 0.0;
  const double to = high + tolerance < last ? std::max(high + tolerance, 0.0) : last;
  return {static_cast<int>(from) / tileSize, static_cast<int>(to) / tileSize};
}

} // namespace

EmptyPixels::EmptyPixels(const Camera& camera, const MajorantGrid& majorants)
    : m_tilesPerRow(static_cast<std::size_t>((camera.width() + tileSize - 1) / tileSize)) {
  const int tilesPerColumn = (camera.height() + tileSize - 1) / tileSize;
  const std::size_t tiles = m_tilesPerRow * static_cast<std::size_t>(tilesPerColumn);
  const BoxProjection cells(camera, majorants.worldToCell().inverse());
  const double perPitch = 1.0 / camera.pixelPitch();
  tbb::combinable<std::vector<std::uint8_t>> parts(
      [&] { return std::vector<std::uint8_t>(tiles); });
  const auto markTiles = [&](const BoxProjection::Bounds& bounds,
                             std::vector<std::uint8_t>& isOccupied) {
    const double middle = 0.5 * camera.height();
    const auto [left, right] =
        findTiles(0.5 * camera.width() + bounds.lower.x() * perPitch,
                  0.5 * camera.width() + bounds.upper.x() * perPitch, camera.width(), tileSize);
    const auto [top, bottom] =
        findTiles(middle - bounds.upper.y() * perPitch, middle - bounds.lower.y() * perPitch,
                  camera.height(), tileSize);
    for (int row = top; row <= bottom; ++row)
      for (int column = left; column <= right; ++column)
        isOccupied[static_cast<std::size_t>(row) * m_tilesPerRow +
                   static_cast<std::size_t>(column)] = 1;
  };
  const Size3& count = majorants.cellCount();
  tbb::parallel_for(std::int64_t{0}, count.z(), [&](std::int64_t z) {
    std::vector<std::uint8_t>& isOccupied = parts.local();
    std::int64_t cell = z * count.x() * count.y();
    for (std::int64_t y = 0; y < count.y(); ++y)
      for (std::int64_t x = 0; x < count.x(); ++x)
        if (majorants.cell(cell++).majorant > 0.0F)
          markTiles(cells.project({x, y, z}), isOccupied);
  });
  m_isOccupied.resize(tiles);
  parts.combine_each([&](const std::vector<std::uint8_t>& part) {
    std::transform(part.begin(), part.end(), m_isOccupied.begin(), m_isOccupied.begin(),
                   std::bit_or<>());
  });
}

} // namespace fenestra::core
