#pragma once
// Noise as a function of position only: independent of run, order and thread.

#include "base/Vector.h"

#include <cstdint>

namespace fenestra::core {

/// Value noise on the unit lattice, smoothly interpolated, in [-1, 1]. Divide `point` by the
/// feature size; different seeds give independent fields.
double valueNoise(const Vec3& point, std::uint64_t seed);

/// Normal noise with mean 0 and standard deviation 1.
double normalNoise(std::uint64_t voxel);

/// Rician noise, as in MR magnitude images: the signal has normal noise of standard deviation
/// `sigma` in both quadratures (Gudbjartsson and Patz 1995, "The Rician Distribution of Noisy MRI
/// Data").
double ricianNoise(double signal, double sigma, std::uint64_t voxel);

} // namespace fenestra::core
