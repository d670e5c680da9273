// Sampling of environment maps: SIMD version of model/lights/EnvironmentSampler.h. Included inside
// a namespace, as LightSet-inl.h is.

#include "formulas/Environment.inl"

/// Samples a bin. `table`: index among the tables.
HWY_INLINE Bin sampleBin(const AliasTables& tables, Int table, UInt random) {
  const Int own = bitsAsInt(random & static_cast<std::uint32_t>(tables.size() - 1));
  const Int place = shiftLeft(table, tables.bits) + own;
  const auto [threshold, alias] =
      loadPairs(&tables.slots[0].threshold, Indices(shiftLeft<1>(place)));
  const Float rest = toFloat(bitsAsInt(shiftRight(random, tables.bits)));
  return chooseBin(own, threshold, alias, rest, tables.thresholdRange());
}

/// Direction sampled in proportion to its texel's brightness times solid angle.
struct TexelSample {
  Float3 direction;
  Int texel;
};
HWY_INLINE TexelSample sampleTexel(const EnvironmentTables& map, UInt u, UInt v) {
  const Bin row = sampleBin(map.rows, 0, u);
  const Bin column = sampleBin(map.columns, row.index, v);
  const Int fromSouth = Int(map.height - 1) - row.index;
  const LaneMask isSouth = row.index > fromSouth;
  const auto [upper, lower] =
      loadPairs(map.oneMinusCos.data(), Indices(select(isSouth, fromSouth, row.index)));
  const float perWidth = 1.0F / static_cast<float>(map.width);
  const Float turns = (toFloat(column.index) + column.fraction) * perWidth;
  return {directionInTexel(turns, lerp(upper, lower, row.fraction), isSouth),
          row.index * map.width + column.index};
}

HWY_INLINE Int findTexel(const EnvironmentTables& map, const Float3& d) {
  const auto width = static_cast<float>(map.width), height = static_cast<float>(map.height);
  const Int row = texelOnAxis(rowOfDirection(d, height), height);
  return row * map.width + texelOnAxis(columnOfDirection(d, width), width);
}

HWY_INLINE Float3 loadRadiance(const EnvironmentTables& map, Int texel) {
  const Indices first(texel * 3);
  const auto channel = [&](std::size_t c) {
    return map.tint[c] * bitsAsFloat(loadInts(map.rgb + c, first));
  };
  return {channel(0), channel(1), channel(2)};
}
