// Albedo (with tints and mixtures), gradient and normal at points in index space.

HWY_INLINE Float3 evalAlbedo(const SimdTable& table, Float scalar) {
  const auto& channels = table.channels;
  if (table.position.size() == 3) // one knot: constant
    return {channels[0][0].value, channels[1][0].value, channels[2][0].value};
  const Segment segment = findSegment(table, scalar);
  return {evalSegment(channels[0], segment), evalSegment(channels[1], segment),
          evalSegment(channels[2], segment)};
}

/// Albedo of one component per lane; 0 in lanes outside `which`.
HWY_INLINE Float3 evalComponentAlbedo(const SimdShading& shading, LaneMask which, Int components,
                                      Float scalar) {
  Float3 albedo(0.0F, 0.0F, 0.0F);
  forEachComponent(which, components, [&](LaneMask same, std::size_t component) {
    albedo = select(same, evalAlbedo(shading.albedos[component], scalar), albedo);
  });
  return albedo;
}

/// Albedo of a medium without mixture; with a tint TintField::albedo, for the lanes of `which`.
HWY_INLINE Float3 evalMediumAlbedo(const SimdShading& shading, LaneMask which, const Float3& index,
                                   Float scalar) {
  if (!shading.tint)
    return evalAlbedo(shading.albedos[0], scalar);
  Float3 sum(0.0F, 0.0F, 0.0F);
  LaneLabelWeights(*shading.tint, index)
      .forEach(which, [&](LaneMask lanes, Int components, Float fraction) {
        sum = sum + fraction * evalComponentAlbedo(shading, lanes, components, scalar);
      });
  return sum;
}

/// ContextStyle::desaturate, applied outside the focus.
HWY_INLINE Float3 desaturate(const SimdMedium::Context& context, const Float3& index,
                             const Float3& albedo) {
  const Float gray = dot(albedo, {0.2126F, 0.7152F, 0.0722F});
  const auto channel = [&](Float x) { return lerp(gray, x, context.saturation); };
  return select(isFocus(context, index), albedo,
                Float3{channel(albedo.x), channel(albedo.y), channel(albedo.z)});
}

/// Differences of the scalar across two voxels along each axis.
template <typename Voxel>
HWY_INLINE Float3 centralDifference(const SimdField& field, const Float3& p) {
  const auto& [x, y, z] = p;
  return {interpolateScalar<Voxel>(field, {x + 1.0F, y, z}) -
              interpolateScalar<Voxel>(field, {x - 1.0F, y, z}),
          interpolateScalar<Voxel>(field, {x, y + 1.0F, z}) -
              interpolateScalar<Voxel>(field, {x, y - 1.0F, z}),
          interpolateScalar<Voxel>(field, {x, y, z + 1.0F}) -
              interpolateScalar<Voxel>(field, {x, y, z - 1.0F})};
}

/// Unit normal toward a ray's origin, times `weight`; 0 where the gradient is 0. `alongRay`: the
/// gradient along the ray; only its sign counts.
HWY_INLINE Float3 makeNormal(const Float3& gradient, Float alongRay, Float weight) {
  const Float slope = sqrt(dot(gradient, gradient));
  return zeroUnless(slope > 0.0F, select(alongRay < 0.0F, weight, -weight) / slope * gradient);
}

/// 1 - e^-x.
HWY_INLINE Float oneMinusExp(Float x) {
  return -expm1(-x);
}
