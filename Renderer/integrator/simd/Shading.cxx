#include "integrator/simd/Shading.h"

namespace fenestra::core {
namespace {

bool hasWideLobes(const TransferFunction& transfer) {
  constexpr double minRoughness = 1e-2;
  constexpr double maxG = 0.9999;
  return std::abs(transfer.g) <= maxG &&
         makeBsdf(transfer.g, transfer.shading).roughness >= minRoughness;
}

} // namespace

bool SimdShading::isSupported(const Grid& grid, const TransferFunction& transfer,
                              const LightSet& lights, const Mixture* mixture) {
  constexpr double maxDistance = 1e15; // mm; squares and areas stay far below the largest float
  constexpr double maxRadiance = 1e20;
  constexpr double minRadius = 1e-3; // mm; minimum radius of spheres: sine^2 must not underflow
  constexpr double maxRadius = 1e6;  // mm; keeps distance^2 - radius^2 precise in float
  const auto isNear = [&](const auto& light, double limit) {
    return (light.center - grid.worldCenter()).norm() < limit &&
           light.radiance.maxCoeff() < maxRadiance;
  };
  const auto isAreaSupported = [&](const auto& light) {
    return isNear(light, maxDistance) &&
           std::max(light.right.norm(), light.up.norm()) < maxDistance;
  };
  const auto isSphereSupported = [&](const auto& light) {
    const double radius = std::sqrt(light.radius2);
    return isNear(light, maxRadius) && radius > minRadius && radius < maxRadius;
  };
  const auto isMapSupported = [](const PlacedEnvironment& environment) {
    return EnvironmentTables::isSupported(environment.sampler);
  };
  return hasWideLobes(transfer) &&
         (!mixture ||
          std::ranges::all_of(mixture->components, hasWideLobes, &Component::transfer)) &&
         std::ranges::all_of(lights.tables().areas, isAreaSupported) &&
         std::ranges::all_of(lights.tables().spheres, isSphereSupported) &&
         std::ranges::all_of(lights.environments(), isMapSupported);
}

SimdShading::SimdShading(const Grid& grid, const TransferFunction& transfer, const LightSet& set,
                         std::uint64_t maxBounces, bool normalsWanted, const Tint* tinted,
                         const Mixture* mixture)
    : hybrid(transfer.shading && transfer.extinction.span() > 0.0),
      surfaceRate(hybrid ? narrow(25.0 * std::pow(transfer.shading->gamma, 3)) : 0.0F),
      sobel(transfer.gradient == GradientKind::sobel),
      wantNormals(normalsWanted || transfer.shading),
      bounces(static_cast<std::int32_t>(
          std::min<std::uint64_t>(maxBounces, std::numeric_limits<std::int32_t>::max()))),
      lights(set.tables().cast<float>(grid.worldCenter())) {
  const auto add = [&](const TransferFunction& function) {
    const scalar::Bsdf b = makeBsdf(function.g, function.shading);
    bsdfs.push_back({narrow(b.g), narrow(b.diffuse), narrow(b.specular), narrow(b.f0),
                     narrow(b.oddsFactor), narrow(b.roughness), narrow(b.coat[0]),
                     narrow(b.coat[1]), narrow(b.coat[2]), narrow(b.coat[3])});
    isCoated = isCoated || b.isCoated;
    if (!tinted)
      albedos.emplace_back(function.albedo);
  };
  if (tinted) {
    tint.emplace(*tinted->weights, grid);
    for (const std::optional<ColorFunction>& color : tinted->albedo)
      albedos.emplace_back(color.value_or(transfer.albedo));
  }
  if (mixture)
    for (const Component& component : mixture->components)
      add(component.transfer);
  else
    add(transfer);
  Affine local = grid.indexToWorld;
  local.translation() -= grid.worldCenter();
  toLocal = affineRows(local);
  localToIndex = affineRows(Affine(grid.worldToIndex.linear()));
  const double span = transfer.extinction.span();
  const double scale = 0.5 / (span > 0.0 ? span : 1.0); // differences span two voxels
  indexDifferenceToGradient =
      affineRows(Affine(Mat3(scale * grid.worldToIndex.linear().transpose())));
  if (bounces > 0) // without scattering no light is sampled, and the large tables are not needed
    for (const PlacedEnvironment& environment : set.environments())
      if (environment.pmf > 0.0) // maps alone: constant and black ones are never sampled
        maps.emplace_back(environment.sampler, environment.pmf);
  hasSampledLights = !maps.empty();
  LightTables<float>::forEachSampled(
      lights, [&](const auto& list) { hasSampledLights = hasSampledLights || !list.empty(); });
}

} // namespace fenestra::core
