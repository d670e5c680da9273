#include "transport/lanes/PathTables.h"

namespace fenestra {
namespace {

/// An area light in local space, in float.
EventScene::Area narrowArea(const PlacedAreaLight& light, const Vec3& from) {
  const Vec3 right = light.half.x() * light.right;
  const Vec3 up = light.half.y() * light.up;
  return {light.shape == AreaLight::Shape::disk,
          narrow3(light.center - from),
          narrow3(light.normal),
          narrow3(right),
          narrow3(up),
          narrow(1.0 / right.squaredNorm()),
          narrow(1.0 / up.squaredNorm()),
          narrow(light.area),
          narrow3(light.radiance),
          narrow(light.share)};
}

ScatterLaw<float> narrowLaw(const TransferFunction& transfer) {
  const ScatterLaw<double> law = lawOf(transfer.g, transfer.shading);
  return {narrow(law.g),
          narrow(law.diffuse),
          narrow(law.specular),
          narrow(law.f0),
          narrow(law.odds),
          narrow(law.roughness),
          law.isCoated,
          {narrow(law.coat[0]), narrow(law.coat[1]), narrow(law.coat[2]), narrow(law.coat[3])}};
}

/// True if no lobe is narrower than the resolution of directions in float.
bool isWide(const TransferFunction& transfer) {
  constexpr double leastRoughness = 1e-2;
  constexpr double greatestG = 0.9999;
  return std::abs(transfer.g) <= greatestG &&
         lawOf(transfer.g, transfer.shading).roughness >= leastRoughness;
}

} // namespace

bool EventScene::serves(const Grid& grid, const TransferFunction& transfer, const LightSet& lights,
                        const Mixture* mixture) {
  constexpr double farthest = 1e15; // mm; squares and areas stay far below the greatest float
  constexpr double brightest = 1e20;
  constexpr double smallest = 1e-3; // mm; radius of a sphere whose square of the sine is a float
  constexpr double greatestSphere = 1e6; // mm; distance^2 - radius^2 has digits left in float
  const auto isNear = [&](const auto& light) {
    return (light.center - grid.worldCenter()).norm() < farthest &&
           light.radiance.maxCoeff() < brightest;
  };
  const auto fits = [&](const PlacedAreaLight& light) {
    return isNear(light) && light.half.maxCoeff() < farthest;
  };
  const auto sphereFits = [&](const PlacedSphereLight& light) {
    return light.radius > smallest && light.radius < greatestSphere &&
           (light.center - grid.worldCenter()).norm() < greatestSphere &&
           light.radiance.maxCoeff() < brightest;
  };
  const auto mapFits = [](const SharedEnvironment& environment) {
    return MapTables::serves(environment.sampler);
  };
  return lights.hasOnlyListedKinds() && isWide(transfer) &&
         (!mixture || std::ranges::all_of(mixture->components, isWide, &Component::transfer)) &&
         std::ranges::all_of(lights.areas(), fits) &&
         std::ranges::all_of(lights.spheres(), sphereFits) &&
         std::ranges::all_of(lights.environments(), mapFits);
}

EventScene::EventScene(const Grid& grid, const TransferFunction& transfer, const LightSet& lights,
                       std::uint64_t mostBounces, bool normalsWanted, const Tint* tints,
                       const Mixture* mixture)
    : albedo(transfer.albedo),
      law(narrowLaw(transfer)),
      hybrid(transfer.shading && transfer.extinction.span() > 0.0),
      surfaceRate(hybrid ? narrow(25.0 * std::pow(transfer.shading->gamma, 3)) : 0.0F),
      wantNormals(normalsWanted || transfer.shading),
      bounces(static_cast<std::int32_t>(
          std::min<std::uint64_t>(mostBounces, std::numeric_limits<std::int32_t>::max()))),
      constantEnvironment(narrow3(lights.constantEnvironment())) {
  if (tints)
    tint.emplace(*tints, grid);
  if (mixture)
    for (const Component& component : mixture->components) {
      albedos.emplace_back(component.transfer.albedo);
      laws.push_back(narrowLaw(component.transfer));
    }
  Affine local = grid.indexToWorld;
  local.translation() -= grid.worldCenter();
  toLocal = affineRows(local);
  localToIndex = affineRows(Affine(grid.worldToIndex.linear()));
  const double span = transfer.extinction.span();
  const double scale = 0.5 / (span > 0.0 ? span : 1.0);
  indexDifferenceToGradient =
      affineRows(Affine(Mat3(scale * grid.worldToIndex.linear().transpose())));
  for (const PlacedAreaLight& light : lights.areas())
    areas.push_back(narrowArea(light, grid.worldCenter()));
  for (const PlacedDirectionalLight& light : lights.directionals())
    directionals.push_back({narrow3(light.toward), narrow3(light.irradiance), narrow(light.share)});
  for (const PlacedSphereLight& light : lights.spheres())
    spheres.push_back({narrow3(Vec3(light.center - grid.worldCenter())),
                       narrow(light.radius * light.radius), narrow3(light.radiance),
                       narrow(light.share)});
  for (const SkyLight& sky : lights.skies())
    skies.push_back({narrow3(sky.up), narrow3(sky.middle), narrow3(Rgb(sky.top - sky.middle)),
                     narrow3(Rgb(sky.bottom - sky.middle))});
  if (bounces > 0) // else nothing is lit, and large tables are not needed
    for (const SharedEnvironment& environment : lights.environments())
      if (environment.share > 0.0) // no constant, no black map
        maps.emplace_back(environment.sampler, environment.share);
}

} // namespace fenestra
