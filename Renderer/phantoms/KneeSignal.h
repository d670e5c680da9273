#pragma once
// Tissue signals in a T1-weighted scan.

#include "base/Vector.h"

namespace fenestra::core {

// Signals including the tissue's texture, before bias field and noise; `point` in the knee's frame.
double muscleSignal(const Vec3& point);
double fatSignal(const Vec3& point, double strands); ///< `strands`: signal loss in septa
double marrowSignal(const Vec3& point);
double nerveSignal(const Vec3& point);
double meniscusSignal(const Vec3& point);
double ligamentSignal(const Vec3& point);
double cartilageSignal(const Vec3& point);

/// Sensitivity of the receive coils: smooth, 0.85 to 1.15.
double biasField(const Vec3& point);

inline constexpr double noiseSigma = 11.0; ///< per quadrature channel; SNR of muscle: 32

} // namespace fenestra::core
