#pragma once
// Signals of tissues in a T1-weighted scan.

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

/// Sensitivity of the receive coils: smooth, from 0.85 to 1.15.
double biasField(const Vec3& point);

inline constexpr double noiseSigma = 11.0; ///< of each quadrature; muscle: signal / noise = 32

} // namespace fenestra
