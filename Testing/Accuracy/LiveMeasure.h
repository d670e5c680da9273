#pragma once
// The live clipping surface (clip/portable/LiveSurface.h) against that of stills.

#include "Subjects.h"
#include "Views.h"
#include "clip/portable/LiveSurface.h"

#include <memory>

namespace fenestra::core {
class PreparedScene;
}

namespace fenestra::core::accuracy {

/// Absolute differences of depths, mm.
struct LiveError {
  double mean = 0.0, p95 = 0.0;
  std::size_t count = 0; ///< of pixels
};
struct LiveDifference {
  LiveError focus, context; ///< where both surfaces have focus; where neither has
};

/// A subject with its focus as triangles.
class LiveSubject {
public:
  explicit LiveSubject(const Subject& subject);
  ~LiveSubject();

  std::size_t triangleCount() const { return m_focus->corners().size() / 3; }
  /// View `number` of `count` around the focus, 20 degrees above the horizon.
  View makeView(double number, int count, int size, bool isPerspective) const;
  /// Compares all pixels with the still's surface.
  LiveDifference compare(const View& view) const;
  /// Mean change of the context's depth, mm, while an orthographic camera turns by 0.1 degrees.
  double measureTurn(int number) const;
  /// Processor time of the calling thread per camera, s: the median of 100.
  double measureSeconds() const;

private:
  LiveSurface build(const View& view) const;

  Subject m_subject;
  std::unique_ptr<const PreparedScene> m_scene;
  std::unique_ptr<const ClosedSurface> m_focus;
  BoxCorners m_volume;
  Vec3 m_center;
  double m_radius;
};

} // namespace fenestra::core::accuracy
