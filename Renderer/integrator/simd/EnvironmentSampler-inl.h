// Sampling of environment maps: SIMD version of model/lights/EnvironmentSampler.h. Included inside
// a namespace, as LightSet-inl.h is.

/// A bin of an alias table, and a position inside it, uniform in (0, 1].
struct Bin {
  Int index;
  Float fraction;
};

/// Samples a bin. `table`: index among the tables.
HWY_INLINE Bin sampleBin(const AliasTables& tables, Int table, UInt random) {
  const Int own = bitsAsInt(random & static_cast<std::uint32_t>(tables.size() - 1));
  const Int place = shiftLeft(table, tables.bits) + own;
  const auto [threshold, other] =
      loadPairs(&tables.slots[0].threshold, Indices(shiftLeft<1>(place)));
  const Float rest = toFloat(bitsAsInt(shiftRight(random, tables.bits)));
  const LaneMask below = rest < threshold;
  const Float inside = select(below, rest, rest - threshold) + 0.5F;
  const Float size = select(below, threshold, tables.thresholdRange() - threshold);
  return {select(below, own, toInt(other)), inside / size};
}

/// Direction sampled in proportion to its texel's brightness times solid angle.
struct TexelSample {
  Float3 direction;
  Int texel;
};
HWY_INLINE TexelSample sampleTexel(const EnvironmentTables& map, UInt u, UInt v) {
  const Bin row = sampleBin(map.rows, 0, u);
  const Bin column = sampleBin(map.columns, row.index, v);

  // Uniform in solid angle inside the texel: uniform in cos(theta) and in phi.
  const Int fromSouth = Int(map.height - 1) - row.index;
  const LaneMask isSouth = row.index > fromSouth;
  const auto [upper, lower] =
      loadPairs(map.oneMinusCos.data(), Indices(select(isSouth, fromSouth, row.index)));
  const Float oneMinusCos = lerp(upper, lower, row.fraction);
  const Float sine = safeSqrt(oneMinusCos * (2.0F - oneMinusCos));
  const float perWidth = 1.0F / static_cast<float>(map.width);
  const CosineSine phi = cosSinTurns((toFloat(column.index) + column.fraction) * perWidth);
  const Float z = 1.0F - oneMinusCos;
  return {{-sine * phi.sine, -sine * phi.cosine, select(isSouth, -z, z)},
          row.index * map.width + column.index};
}

HWY_INLINE Int findTexel(const EnvironmentTables& map, const Float3& d) {
  const auto cell = [](Float place, std::int32_t count) { // maps NaN to a valid index, too
    return toInt(clampZero(min(place, static_cast<float>(count - 1))));
  };
  const Float sine = sqrt(square(d.x) + square(d.y));
  const auto width = static_cast<float>(map.width), height = static_cast<float>(map.height);
  const Int column = cell((0.5F + angleInTurns(d.y, d.x)) * width, map.width);
  const Int row = cell(angleInTurns(d.z, sine) * (2.0F * height), map.height);
  return row * map.width + column;
}

HWY_INLINE Float3 loadRadiance(const EnvironmentTables& map, Int texel) {
  const Indices first(texel * 3);
  const auto channel = [&](std::size_t c) {
    return map.tint[c] * bitsAsFloat(loadInts(map.rgb + c, first));
  };
  return {channel(0), channel(1), channel(2)};
}
