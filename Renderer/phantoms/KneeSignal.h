#pragma once
// Signals of tissues in a T1-weighted scan.

#include "base/Vector.h"

namespace fenestra {

// Signals with the tissue's own texture, before bias field and noise; `point` in the knee's frame.
double muscleSignal(const Vec3& point);
double fatSignal(const Vec3& point, double strands); ///< `strands`: loss in connective tissue
double marrowSignal(const Vec3& point);
double nerveSignal(const Vec3& point);
double meniscusSignal(const Vec3& point);
double ligamentSignal(const Vec3& point);
double cartilageSignal(const Vec3& point);

/// Sensitivity of the receive coils: smooth, from 0.85 to 1.15.
double biasField(const Vec3& point);

inline constexpr double noiseSigma = 11.0; ///< of each quadrature; muscle: signal / noise = 32

} // namespace fenestra
