// Albedo (with tints and mixtures), gradient and normal at points in index space.

#include "formulas/Scattering.inl"
// Uses it:
#include "formulas/Paths.inl"

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
  Float total = 0.0F;
  LaneLabelWeights(*shading.tint, index)
      .forEach(which, [&](LaneMask lanes, Int components, Float fraction) {
        const Float weight = colorWeight(fraction);
        sum = sum + weight * evalComponentAlbedo(shading, lanes, components, scalar);
        total = total + weight;
      });
  return zeroUnless(which, 1.0F / total) * sum;
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

/// Twice Field::sobelGradient, per voxel, as centralDifference.
template <typename Voxel>
HWY_INLINE Float3 sobelDifference(const SimdField& field, const Float3& p) {
  const SimdAxes& axes = field.axes;
  const auto locate = [&](std::size_t axis, Float at) {
    return makeSobelAxis(axes[axis].last, axes[axis].lastCell, at);
  };
  const SobelAxis x = locate(0, p.x), y = locate(1, p.y), z = locate(2, p.z);
  const Indices index(voxelOffset(axes, x.first, y.first, z.first));
  const auto offset = [](const SimdAxis& axis, std::size_t step) {
    return std::min(static_cast<std::int32_t>(step), static_cast<std::int32_t>(axis.last)) *
           axis.stride;
  };
  Float4 alongX, alongY, means; // of the four slices
  for (std::size_t k = 0; k < 4; ++k) {
    Float4 rowsAlongX, rowMeans;
    for (std::size_t j = 0; j < 4; ++j) {
      const Float4 row = loadRow<Voxel>(field, index, offset(axes[2], k) + offset(axes[1], j));
      rowsAlongX[j] = evalRise(x, row);
      rowMeans[j] = evalMean(x, row);
    }
    alongX[k] = evalMean(y, rowsAlongX);
    alongY[k] = evalRise(y, rowMeans);
    means[k] = evalMean(y, rowMeans);
  }
  return {evalMean(z, alongX), evalMean(z, alongY), evalRise(z, means)};
}

/// The medium's differences of the scalar across two voxels along each axis.
template <typename Voxel>
HWY_INLINE Float3 scalarDifference(const SimdShading& shading, const SimdField& field,
                                   const Float3& p) {
  return shading.sobel ? sobelDifference<Voxel>(field, p) : centralDifference<Voxel>(field, p);
}

/// Bsdf of one component per lane; of a medium without mixture: the only one.
template <bool isMixed>
HWY_INLINE Bsdf loadBsdfs(const SimdShading& shading, Int components) {
  const SimdShading::BsdfNumbers& first = shading.bsdfs.front();
  const Int at = components * static_cast<std::int32_t>(first.size());
  const auto each = [&](std::size_t member) {
    if constexpr (isMixed)
      return gather(&first[member], at);
    else
      return Float(first[member]);
  };
  return {each(0),
          each(1),
          each(2),
          each(3),
          each(4),
          each(5),
          {each(6), each(7), each(8), each(9)},
          shading.isCoated};
}
