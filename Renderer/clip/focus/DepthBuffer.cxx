#include "clip/focus/DepthBuffer.h"

#include "base/Error.h"

namespace fenestra::core {

namespace {

struct Rectangle {
  Vec2 lower = Vec2::Constant(infinity);
  Vec2 upper = Vec2::Constant(-infinity);

  void extend(const Vec2& point) {
    lower = lower.cwiseMin(point);
    upper = upper.cwiseMax(point);
  }
};

/// Bounds of the volume's projection on the plane through the target, mm.
Rectangle projectVolume(const Camera& camera, const Grid& volume) {
  constexpr double maxAngle = 75.0 * pi / 180.0; // from the camera's axis, in perspective
  const Vec2 limit = Vec2::Constant(camera.targetDepth() * std::tan(maxAngle));
  Rectangle rectangle;
  for (int i = 0; i < 8; ++i) {
    const Vec3 corner = toBuffer(camera, volume.worldCorner(i));
    if (camera.pose().projection == Projection::orthographic) {
      rectangle.extend(corner.head<2>());
    } else if (corner.z() > 0.0) {
      rectangle.extend(corner.head<2>().cwiseMax(-limit).cwiseMin(limit));
    } else { // behind the camera: the projection of the box is unbounded
      rectangle.extend(-limit);
      rectangle.extend(limit);
    }
  }
  return rectangle;
}

/// Sets `before` and `after` such that the samples of the axis cover [a, b], mm.
void extendAxis(DepthAxis& axis, double factor, double a, double b) {
  const double first = std::min(a / axis.pitch, b / axis.pitch) - axis.start;
  const double last = std::max(a / axis.pitch, b / axis.pitch) - axis.start;
  const auto countSamples = [factor](double pixels) {
    constexpr double limit = 1e9; // larger than any buffer; its square does not overflow
    return static_cast<std::int64_t>(std::ceil(std::clamp(pixels / factor, 0.0, limit)));
  };
  axis.factor = factor;
  axis.before = countSamples(-first);
  axis.after = countSamples(last - static_cast<double>(axis.inside - 1));
}

/// Axis on which the center of pixel i is at (i + 1/2 - pixels / 2) pitch, as in Camera::toPlane.
DepthAxis makeViewportAxis(double pitch, int pixels) {
  DepthAxis axis;
  axis.pitch = pitch;
  axis.start = 0.5 - 0.5 * pixels;
  axis.inside = pixels;
  return axis;
}

} // namespace

DepthBuffer::DepthBuffer(const Camera& camera, const Grid& volume)
    : m_x(makeViewportAxis(camera.pixelPitch(), camera.width())),
      m_y(makeViewportAxis(-camera.pixelPitch(), camera.height())),
      m_reference(camera.targetDepth()) {
  const double pitch = camera.pixelPitch();
  const Rectangle span = projectVolume(camera, volume);
  const double farthest = span.lower.cwiseAbs().cwiseMax(span.upper.cwiseAbs()).maxCoeff();
  if (!(pitch > 0.0) || !std::isfinite(pitch) || !(farthest / pitch < 1e15) ||
      std::min(camera.width(), camera.height()) < 1)
    throw requestError(ErrorCode::emptyImagePlane, "image plane",
                       "it is empty, or a pixel is smaller than 1e-15 of the volume");
  // Samples: 4 Mi or 5/4 of the viewport, whichever is more, and room for one on each side of it.
  const std::int64_t limit = std::max<std::int64_t>(
      {4 << 20, m_x.inside * m_y.inside * 5 / 4, (m_x.inside + 2) * (m_y.inside + 2)});
  const auto fits = [&](double factor) {
    extendAxis(m_x, factor, span.lower.x(), span.upper.x());
    extendAxis(m_y, factor, span.lower.y(), span.upper.y());
    return size() <= limit;
  };
  double fitting = 1.0;
  while (!fits(fitting)) // terminates: the limit allows one sample on each side
    fitting *= 2.0;
  for (double failing = 0.5 * fitting; failing >= 1.0 && fitting - failing > 1.0;) {
    const double middle = std::floor(0.5 * (failing + fitting));
    (fits(middle) ? fitting : failing) = middle;
  }
  fits(fitting);
  m_depths.assign(index(size()), std::numeric_limits<float>::infinity());
}

void DepthBuffer::move(double offset) {
  for (float& depth : m_depths)
    depth = static_cast<float>(depth + offset);
}

} // namespace fenestra::core
