#pragma once
// Sums and means over square windows of an image, computed as running sums in double precision.

#include "denoise/filter/FilterInput.h"

namespace fenestra::core {

/// Sums over windows of 2 radius + 1 pixels around each pixel, clipped at the edges of the image.
/// Independent of the number of threads.
Plane computeBoxSums(const Plane& plane, int width, int height, int radius);

/// Means over the active pixels of such windows; 0 if there are none.
class MaskedMean {
public:
  /// `innerRadius`: radius of a window in the middle that is excluded; negative: none.
  MaskedMean(const Plane& active, int width, int height, int radius, int innerRadius = -1);

  /// Means of `plane`, which must be 0 at inactive pixels.
  Plane operator()(const Plane& plane) const;

private:
  Plane sum(const Plane& plane) const;

  int m_width, m_height, m_radius, m_innerRadius;
  Plane m_count;
};

} // namespace fenestra::core
