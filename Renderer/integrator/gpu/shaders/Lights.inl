// The lights of a scene: model/lights/LightLoops-inl.h and integrator/simd/LightSet-inl.h for one
// path. Points and directions in local space.
// Tables begin with the lights: skies, areas, directional lights and spheres.

FORMULA Int findArea(Int i) {
  return skyCount * skyWords + i * areaWords;
}
FORMULA Int findDirectional(Int i) {
  return findArea(areaCount) + i * directionalWords;
}
FORMULA Int findSphere(Int i) {
  return findDirectional(directionalCount) + i * sphereWords;
}

FORMULA PlacedDirectional loadDirectional(Int at) {
  PlacedDirectional light;
  light.pmf = loadFloat(at);
  light.toward = loadFloat3(at + 1);
  light.irradiance = loadFloat3(at + 4);
  return light;
}
FORMULA PlacedArea loadArea(Int at) {
  PlacedArea light;
  light.pmf = loadFloat(at);
  light.isDisk = loadInt(at + 1) != 0;
  light.center = loadFloat3(at + 2);
  light.normal = loadFloat3(at + 5);
  light.right = loadFloat3(at + 8);
  light.up = loadFloat3(at + 11);
  light.perRight = loadFloat(at + 14);
  light.perUp = loadFloat(at + 15);
  light.area = loadFloat(at + 16);
  light.radiance = loadFloat3(at + 17);
  return light;
}
FORMULA PlacedSphere loadSphere(Int at) {
  PlacedSphere light;
  light.pmf = loadFloat(at);
  light.center = loadFloat3(at + 1);
  light.radius2 = loadFloat(at + 4);
  light.radiance = loadFloat3(at + 5);
  return light;
}

/// Samples one light as seen from `point`. `choice`: uniform in (0, 1]; uBits, vBits: random bits.
FORMULA LightSamples sampleLights(Float3 point, Float choice, UInt uBits, UInt vBits) {
  const Float u = toUniform(uBits);
  const Float v = toUniform(vBits);
  for (Int i = 0; i < areaCount; ++i) {
    const Int at = findArea(i);
    const Float pmf = loadFloat(at);
    if (choice <= pmf)
      return sampleLight(loadArea(at), point, u, v);
    choice = choice - pmf;
  }
  for (Int i = 0; i < directionalCount; ++i) {
    const Int at = findDirectional(i);
    const Float pmf = loadFloat(at);
    if (choice <= pmf)
      return sampleLight(loadDirectional(at), point, u, v);
    choice = choice - pmf;
  }
  for (Int i = 0; i < sphereCount; ++i) {
    const Int at = findSphere(i);
    const Float pmf = loadFloat(at);
    if (choice <= pmf)
      return sampleLight(loadSphere(at), point, u, v);
    choice = choice - pmf;
  }
  if (mapCount > 0)
    return sampleMaps(choice, uBits, vBits);
  LightSamples none;
  none.direction = Float3(0.0F, 0.0F, 1.0F);
  none.radiance = Float3(0.0F, 0.0F, 0.0F);
  none.distance = infiniteReal;
  none.pdf = 1.0F;
  none.isDelta = noLanes();
  return none;
}

/// Light emitted along a scattered ray, up to its collision or at infinity.
FORMULA Float3 findEmission(Float3 origin, Float3 direction, Float distance, Float scatterPdf) {
  Float3 sum = Float3(0.0F, 0.0F, 0.0F);
  for (Int i = 0; i < areaCount; ++i) {
    const PlacedArea light = loadArea(findArea(i));
    const LightHits at = intersect(light, allLanes(), origin, direction, distance);
    if (at.hit)
      sum = sum + weighScattering(scatterPdf, at.pdf) * Float3(light.radiance);
  }
  for (Int i = 0; i < sphereCount; ++i) {
    const PlacedSphere light = loadSphere(findSphere(i));
    const LightHits at = intersect(light, allLanes(), origin, direction, distance);
    if (at.hit)
      sum = sum + weighScattering(scatterPdf, at.pdf) * Float3(light.radiance);
  }
  if (distance == infiniteReal) {
    const Environment far = evaluateMaps(direction, -1);
    if (mapCount > 0)
      sum = sum + weighScattering(scatterPdf, far.pdf) * far.radiance;
    else
      sum = sum + far.radiance;
  }
  return sum;
}
