// Matter of lanes at points in index space: albedo, with segments' colours, and gradient.

HWY_INLINE Float3 albedoOf(const WideTable& table, Float scalar) {
  const auto& channels = table.channels;
  if (table.position.size() == 3) // 1.0F knot
    return {channels[0][0].value, channels[1][0].value, channels[2][0].value};
  const Segment segment = segmentOf(table, scalar);
  return {valueIn(channels[0], segment), valueIn(channels[1], segment),
          valueIn(channels[2], segment)};
}

/// TintedField::albedo for the lanes of `which`, 0 in others; `own`: of the transfer function.
HWY_INLINE Float3 tintedAlbedo(const WideTint& tint, LaneMask which, const Float3& index,
                               Float scalar, const Float3& own) {
  Float3 sum(0.0F, 0.0F, 0.0F);
  LaneShares(tint.shares, index).forEach(which, [&](LaneMask lanes, Int components, Float share) {
    Float3 albedo = own;
    forEachComponent(lanes, components, [&](LaneMask same, std::size_t component) {
      if (const auto& table = tint.albedo[component])
        albedo = select(same, albedoOf(*table, scalar), albedo);
    });
    sum = sum + share * albedo;
  });
  return sum;
}

/// ContextStyle::paled, outside the focus.
HWY_INLINE Float3 paled(const WideScene::Context& context, const Float3& index,
                        const Float3& albedo) {
  const Float grey = dot(albedo, {0.2126F, 0.7152F, 0.0722F});
  const auto channel = [&](Float x) { return lerp(grey, x, context.saturation); };
  return select(isFocus(context, index), albedo,
                Float3{channel(albedo.x), channel(albedo.y), channel(albedo.z)});
}

/// Differences of the scalar over two voxels along each axis.
template <typename Voxel>
HWY_INLINE Float3 differenceAt(const WideField& field, const Float3& p) {
  const auto& [x, y, z] = p;
  return {scalarAt<Voxel>(field, {x + 1.0F, y, z}) - scalarAt<Voxel>(field, {x - 1.0F, y, z}),
          scalarAt<Voxel>(field, {x, y + 1.0F, z}) - scalarAt<Voxel>(field, {x, y - 1.0F, z}),
          scalarAt<Voxel>(field, {x, y, z + 1.0F}) - scalarAt<Voxel>(field, {x, y, z - 1.0F})};
}

/// 1 - e^-x.
HWY_INLINE Float missing(Float x) {
  return -expm1(-x);
}

/// Medium's probability of scattering at a surface; `slope`: length of the gradient.
HWY_INLINE Float surfaceChance(const EventScene& scene, Float extinction, Float slope) {
  return missing(extinction) * missing(scene.surfaceRate * slope);
}
