#pragma once
// What a T1-weighted scan shows of each tissue.

#include "base/Vector.h"

namespace fenestra {

enum class KneeTissue {
  skin,
  subcutaneousFat,
  fascia,
  deepFat,
  fatPad,
  muscle,
  vessel,
  nerve,
  fluid,
  meniscus,
  ligament,
  cartilage,
  cortex,
  marrow,
};

/// Signal with the tissue's own texture, before bias field and noise; `point` in the knee's frame.
double tissueSignal(KneeTissue tissue, const Vec3& point);

/// The receive coils' sensitivity: smooth, within 0.85 and 1.15.
double biasField(const Vec3& point);

inline constexpr double noiseSigma = 11.0; ///< of a quadrature: signal-to-noise of muscle is 32

} // namespace fenestra
