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

/// Sobel's kernel along one axis, interpolated (Field::SobelAxis): four voxels from `first` on, all
/// inside the volume, of which the last one repeats if the axis has fewer.
struct LaneSobelAxis {
  Float first;     ///< an integer
  Float smooth[4]; ///< weights of the voxels; their sum is 1
  Float rise[3];   ///< weights of the differences from each voxel to the next

  HWY_INLINE LaneSobelAxis(const SimdAxis& a, Float x) {
    const auto [lower, f] = locateOnAxis(a, x);
    first = max(min(lower - 1.0F, a.lastCell - 2.0F), 0.0F);
    // At the border the four voxels begin one voxel later or earlier than the kernel.
    const LaneMask isLater = lower - 1.0F < first, isEarlier = first < lower - 1.0F;
    rise[0] = select(isLater, 1.0F, zeroUnless(~isEarlier, 1.0F - f));
    rise[1] = select(isLater, f, select(isEarlier, 1.0F - f, 1.0F));
    rise[2] = select(isEarlier, 1.0F, zeroUnless(~isLater, f));
    const Float repeatFirst = zeroUnless(isLater, 2.0F * (1.0F - f));
    const Float repeatLast = zeroUnless(isEarlier, 2.0F * f);
    smooth[0] = 0.25F * (rise[0] + repeatFirst);
    smooth[1] = 0.25F * (rise[0] + rise[1]);
    smooth[2] = 0.25F * (rise[1] + rise[2]);
    smooth[3] = 0.25F * (rise[2] + repeatLast);
  }
  HWY_INLINE Float evalSmooth(const LaneQuad& v) const {
    return fma(smooth[0], v[0], fma(smooth[1], v[1], fma(smooth[2], v[2], smooth[3] * v[3])));
  }
  /// Twice the derivative per voxel. Exactly 0 if all values are equal.
  HWY_INLINE Float evalRise(const LaneQuad& v) const {
    return fma(rise[0], v[1] - v[0], fma(rise[1], v[2] - v[1], rise[2] * (v[3] - v[2])));
  }
};

/// Twice Field::sobelGradient, per voxel, as centralDifference.
template <typename Voxel>
HWY_INLINE Float3 sobelDifference(const SimdField& field, const Float3& p) {
  const SimdAxes& axes = field.axes;
  const LaneSobelAxis x(axes[0], p.x), y(axes[1], p.y), z(axes[2], p.z);
  const Indices index(voxelOffset(axes, x.first, y.first, z.first));
  const auto offset = [](const SimdAxis& axis, std::int32_t step) {
    return std::min(step, static_cast<std::int32_t>(axis.last)) * axis.stride;
  };
  LaneQuad alongX, alongY, smooth; // of the four slices
  for (std::int32_t k = 0; k < 4; ++k) {
    LaneQuad rowsAlongX, smoothRows;
    for (std::int32_t j = 0; j < 4; ++j) {
      const LaneQuad row = loadRow<Voxel>(field, index, offset(axes[2], k) + offset(axes[1], j));
      rowsAlongX[j] = x.evalRise(row);
      smoothRows[j] = x.evalSmooth(row);
    }
    alongX[k] = y.evalSmooth(rowsAlongX);
    alongY[k] = y.evalRise(smoothRows);
    smooth[k] = y.evalSmooth(smoothRows);
  }
  return {z.evalSmooth(alongX), z.evalSmooth(alongY), z.evalRise(smooth)};
}

/// The medium's differences of the scalar across two voxels along each axis.
template <typename Voxel>
HWY_INLINE Float3 scalarDifference(const SimdShading& shading, const SimdField& field,
                                   const Float3& p) {
  return shading.sobel ? sobelDifference<Voxel>(field, p) : centralDifference<Voxel>(field, p);
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
