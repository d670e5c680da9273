#pragma once
// Sums and means over square windows of a picture, by running sums in double.

#include "denoise/filter/FilterInput.h"

namespace fenestra {

/// Sums over the windows of 2 radius + 1 pixels around each pixel, cut off at the picture's edges.
/// Independent of threads.
Plane computeBoxSums(const Plane& plane, int width, int height, int radius);

/// Means over the open pixels of such windows; 0 where none is open.
class MaskedMean {
public:
  /// `hole`: radius of the window in the middle that is left out; negative: none.
  MaskedMean(const Plane& active, int width, int height, int radius, int innerRadius = -1);

  /// Means of `plane`, which is 0 where a pixel is closed.
  Plane operator()(const Plane& plane) const;

private:
  Plane sum(const Plane& plane) const;

  int m_width, m_height, m_radius, m_innerRadius;
  Plane m_count;
};

} // namespace fenestra
