// Environment maps (integrator/simd/EnvironmentTables.h): integrator/simd/EnvironmentSampler-inl.h
// for one path. Directions in world axes.

/// Total radiance of the constant environments and the skies.
FORMULA Float3 evaluateSkies(Float3 direction) {
  Float3 sum = Float3(scene.constantRed, scene.constantGreen, scene.constantBlue);
  for (Int i = 0; i < skyCount; ++i) {
    const Int at = i * skyWords;
    PlacedSky sky;
    sky.up = loadFloat3(at);
    sky.middle = loadFloat3(at + 3);
    sky.toTop = loadFloat3(at + 6);
    sky.toBottom = loadFloat3(at + 9);
    sum = addSky(sum, sky, direction);
  }
  return sum;
}

/// Offset of the mapWords numbers of a map: width, height; offset of the texels; tint; pmf; pdf per
/// brightness; bits and offset of the tables of rows, and of columns; offset of oneMinusCos.
FORMULA Int findMap(Int i) {
  return scene.maps + i * mapWords;
}

/// Samples a bin of the `table`th of alias tables.
FORMULA Bin sampleBin(Int bits, Int slots, Int table, UInt random) {
  const UInt size = 1U << UInt(bits);
  const Int own = bitsAsInt(random & (size - 1U));
  const Int slot = slots + ((table << bits) + own) * 2;
  const Float rest = toFloat(bitsAsInt(random >> UInt(bits)));
  const Float range = bitsAsFloat((127 + 32 - bits) << 23); // 2^(32 - bits)
  return chooseBin(own, loadFloat(slot), loadFloat(slot + 1), rest, range);
}

struct TexelSample {
  Float3 direction;
  Int texel;
};
FORMULA TexelSample sampleTexel(Int map, UInt u, UInt v) {
  const Int width = loadInt(map);
  const Bin row = sampleBin(loadInt(map + 8), loadInt(map + 9), 0, u);
  const Bin column = sampleBin(loadInt(map + 10), loadInt(map + 11), row.index, v);
  const Int fromSouth = loadInt(map + 1) - 1 - row.index;
  const LaneMask isSouth = row.index > fromSouth;
  const Int edge = loadInt(map + 12) + (isSouth ? fromSouth : row.index);
  const Float perWidth = 1.0F / toFloat(width);
  const Float turns = (toFloat(column.index) + column.fraction) * perWidth;
  TexelSample toward;
  toward.direction =
      directionInTexel(turns, lerp(loadFloat(edge), loadFloat(edge + 1), row.fraction), isSouth);
  toward.texel = row.index * width + column.index;
  return toward;
}

FORMULA Int findTexel(Int map, Float3 direction) {
  const Float width = toFloat(loadInt(map));
  const Float height = toFloat(loadInt(map + 1));
  const Int row = texelOnAxis(rowOfDirection(direction, height), height);
  return row * loadInt(map) + texelOnAxis(columnOfDirection(direction, width), width);
}

FORMULA Float3 loadRadiance(Int map, Int texel) {
  return loadFloat3(map + 3) * loadFloat3(loadInt(map + 2) + texel * 3);
}

/// Radiance and light sampling pdf of a direction.
struct Environment {
  Float3 radiance;
  Float pdf;
};
FORMULA Environment evaluateMaps(Float3 direction, Int texel) {
  Environment sum;
  sum.radiance = evaluateSkies(direction);
  sum.pdf = 0.0F;
  for (Int i = 0; i < mapCount; ++i) {
    const Int map = findMap(i);
    const Float3 radiance = loadRadiance(map, texel < 0 ? findTexel(map, direction) : texel);
    sum.radiance = sum.radiance + radiance;
    sum.pdf = sum.pdf + loadFloat(map + 7) * maxComponent(radiance);
  }
  return sum;
}

/// Samples a map. `choice`: as left by the other lights.
FORMULA LightSamples sampleMaps(Float choice, UInt u, UInt v) {
  Int i = 0;
  while (i < mapCount - 1 && choice > loadFloat(findMap(i) + 6)) { // errors go to the last map
    choice = choice - loadFloat(findMap(i) + 6);
    ++i;
  }
  const TexelSample toward = sampleTexel(findMap(i), u, v);
  const Environment light = evaluateMaps(toward.direction, mapCount == 1 ? toward.texel : -1);
  LightSamples sampled;
  sampled.direction = toward.direction;
  sampled.radiance = zeroUnless(light.pdf > 0.0F, light.radiance);
  sampled.distance = infiniteReal;
  sampled.pdf = select(light.pdf > 0.0F, light.pdf, 1.0F);
  sampled.isDelta = noLanes();
  return sampled;
}
