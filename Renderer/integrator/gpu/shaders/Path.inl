// One path as a machine that advances by one step: out of a majorant cell, or to a tentative
// collision. So a loop over steps can stop anywhere and resume, and a thread whose path has ended
// takes the next one without waiting for others. The random numbers are those of the SIMD
// integrator. The target defines loadStart, storeResult and countWork.

/// Phases of a path.
CONSTANT Int idle = 0;      ///< no path
CONSTANT Int pathRay = 1;   ///< on a camera ray or a scattered ray
CONSTANT Int shadowRay = 2; ///< on a ray to a light; the scattered ray is next

/// Vectors alternate with numbers: GLSL aligns vectors to 16 bytes.
struct PathState {
  Float3 origin;    ///< of the ray, index space
  Float t;          ///< position on the ray, mm
  Float3 ray;       ///< its direction, index space per mm
  Float end;        ///< its length, mm
  Float3 direction; ///< of the camera ray or scattered ray: unit, world axes
  Float scatterPdf; ///< of `direction`
  Float3 throughput;
  Float opticalDepth; ///< to the next tentative collision
  Float3 radiance;
  Float acceptance;            ///< random number that accepts or rejects that collision
  Float3 light;                ///< radiance of the sampled light, per transmittance
  Float ratio;                 ///< transmittance of the shadow ray so far
  Float depth, depthPerLength; ///< of the camera ray's start, mm; per mm of the ray
  Int bounces;
  Int phase;
  UInt rayCounter;   ///< random numbers of the ray
  UInt counter, key; ///< random numbers of the path
  Int path;          ///< index among the batch's paths
};

FORMULA UInt nextRayBits(INOUT(PathState) s) {
  s.rayCounter = nextCounter(s.rayCounter);
  return mixBits(s.rayCounter);
}
FORMULA UInt nextBits(INOUT(PathState) s) {
  s.counter = nextCounter(s.counter);
  return mixBits(s.counter ^ s.key);
}
FORMULA Float nextUniform(INOUT(PathState) s) {
  return toUniform(nextBits(s));
}

/// Random words of one pair of a sample's numbers (base/Sampler.h).
struct WordPair {
  UInt first, second;
};
FORMULA WordPair makePair(STRUCT(PathStart) start, UInt pair) {
  const UInt number = start.number;
  const UInt word = firstWordOfSample(number) + 2U * pair;
  WordPair words;
  words.first = streamWord(start.start, start.key, word);
  words.second = streamWord(start.start, start.key, word + 1U);
  if (isStratified != 0 && pair < 4U) {
    const UInt index = indexInBlock(number);
    const UInt shuffle = streamWord(start.start, start.key, wordOfShuffle(number, index, pair));
    const UInt strata =
        shuffle ^ bitsAsUInt(loadInt(scene.nets + bitsAsInt(placeInNets(shuffle, index))));
    words.first = replaceLeading(strata, words.first);
    words.second = replaceLeading(nextStrata(strata), words.second);
  }
  return words;
}

/// Sets the ray from s.origin. depthBits: random bits of the first collision's optical depth.
FORMULA void startRay(INOUT(PathState) s, Float3 ray, Float end, UInt depthBits, Float acceptance) {
  s.ray = ray;
  s.t = 0.0F;
  s.end = end;
  s.opticalDepth = toExponential(depthBits);
  s.rayCounter = depthBits;
  s.acceptance = acceptance;
}

/// A quantity of camera rays at a raster position relative to the image's center.
FORMULA Float3 evalAtRaster(STRUCT(AffineRow) middle, STRUCT(AffineRow) perColumn,
                            STRUCT(AffineRow) perRow, Float x, Float y) {
  return toFloat3(middle) + x * toFloat3(perColumn) + y * toFloat3(perRow);
}

FORMULA void startPath(INOUT(PathState) s, Int path) {
  const PathStart start = loadStart(path);
  const WordPair position = makePair(start, 0U);
  const WordPair collision = makePair(start, 1U);
  const WordPair seed = makePair(start, 4U);
  const Float x = toFloat(start.column) - scene.middleColumn + toUniformBelow1(position.first);
  const Float y = toFloat(start.row) - scene.middleRow + toUniformBelow1(position.second);
  const Float3 toward =
      evalAtRaster(scene.forward, scene.forwardPerColumn, scene.forwardPerRow, x, y);
  s.depthPerLength = 1.0F / sqrt(dot(toward, toward));
  s.direction = s.depthPerLength * toward;
  const Float3 ray = mapDirection(scene.localToIndex, s.direction);
  const Float3 point = evalAtRaster(scene.point, scene.pointPerColumn, scene.pointPerRow, x, y);
  LaneIntervals inside;
  inside.begin = 0.0F;
  inside.end = infiniteReal;
  if (clipsCameraRays != 0)
    inside = findVisible(point, ray, s.depthPerLength);
  inside = clipToDomain(inside, point, ray);
  const LaneMask isInside = inside.begin < inside.end;
  const Float entry = zeroUnless(isInside, inside.begin);
  s.origin = point + entry * ray;
  s.depth = entry * s.depthPerLength;
  s.throughput = Float3(1.0F, 1.0F, 1.0F);
  s.radiance = Float3(0.0F, 0.0F, 0.0F);
  s.light = s.radiance;
  s.scatterPdf = 0.0F;
  s.ratio = 1.0F;
  s.bounces = 0;
  s.phase = pathRay;
  s.counter = seed.first;
  s.key = seed.second;
  s.path = path;
  startRay(s, ray, zeroUnless(isInside, inside.end - entry), collision.first,
           toUniformBelow1(collision.second));
}

/// Ends the path. Results of paths that never scattered are those of their camera ray: distance to
/// the collision, or infinity, and direction.
FORMULA void endPath(INOUT(PathState) s, Float distance) {
  storeResult(s.path, 0, s.radiance, toFloat(s.bounces));
  if (s.bounces == 0) {
    storeResult(s.path, 1, Float3(0.0F, 0.0F, 0.0F), distance);
    storeResult(s.path, 2, s.direction, 0.0F);
  }
  s.phase = idle;
}

FORMULA void startPathRay(INOUT(PathState) s) {
  const Float3 ray = mapDirection(scene.localToIndex, s.direction);
  const UInt depthBits = nextBits(s);
  const Float acceptance = nextUniform(s);
  s.phase = pathRay;
  startRay(s, ray, lengthInDomain(s.origin, ray), depthBits, acceptance);
}

/// A real collision: what scatters there.
struct Vertex {
  Float3 incoming; ///< direction of the path
  Float3 albedo;
  Float3 gradient;
  Bsdf bsdf;
  LaneMask isSurface;
};

FORMULA Vertex makeVertex(INOUT(PathState) s, LaneMask isFirst, Float scalar) {
  Int component = 0;
  if (componentKind == mixed)
    component = sampleComponent(s.origin, scalar, nextUniform(s));
  Vertex vertex;
  vertex.incoming = s.direction;
  vertex.albedo = evalAlbedoAt(s.origin, component, scalar);
  vertex.gradient = Float3(0.0F, 0.0F, 0.0F);
  vertex.bsdf = loadBsdf(component);
  vertex.isSurface = noLanes();
  if (isHybrid != 0) {
    vertex.gradient = evalGradient(s.origin);
    if (clipKind != clipNone && scene.cutSlope > 0.0F && !isUnclipped(component))
      vertex.gradient = vertex.gradient + cutGradient(s.origin);
    const Float slope = sqrt(dot(vertex.gradient, vertex.gradient));
    Float choice = nextUniform(s);
    if (isFirst)
      choice = toUniform(makePair(loadStart(s.path), 3U).first);
    vertex.isSurface =
        choice < surfaceProbability(evalExtinction(component, scalar), scene.surfaceRate, slope);
  }
  return vertex;
}

FORMULA void recordFirstHit(STRUCT(PathState) s, STRUCT(Vertex) vertex, Float distance) {
  Float3 normal = Float3(0.0F, 0.0F, 0.0F);
  if (wantNormals != 0) {
    Float3 gradient = vertex.gradient;
    if (isHybrid == 0)
      gradient = evalGradient(s.origin);
    normal = makeNormal(gradient, dot(vertex.incoming, gradient), 1.0F);
  }
  storeResult(s.path, 1, vertex.albedo, fma(distance, s.depthPerLength, s.depth));
  storeResult(s.path, 2, normal, 0.0F);
}

FORMULA ScatterEval evaluateVertex(STRUCT(Vertex) vertex, Float3 outgoing) {
  if (vertex.isSurface)
    return evaluate(makeSurfaceLobes(vertex.bsdf, vertex.incoming, vertex.gradient, vertex.albedo),
                    outgoing);
  return evaluate(makePhaseLobe(vertex.bsdf.g, vertex.incoming, vertex.albedo), outgoing);
}
FORMULA ScatterSamples sampleVertex(STRUCT(Vertex) vertex, Float choice, Float u, Float v) {
  if (vertex.isSurface)
    return sampleLobe(
        makeSurfaceLobes(vertex.bsdf, vertex.incoming, vertex.gradient, vertex.albedo), choice, u,
        v);
  return sampleLobe(makePhaseLobe(vertex.bsdf.g, vertex.incoming, vertex.albedo), u, v);
}

/// Samples a light and starts the shadow ray toward it, if it can contribute.
FORMULA void startShadowRay(INOUT(PathState) s, STRUCT(Vertex) vertex, LaneMask isFirst) {
  Float choice = nextUniform(s);
  if (isFirst)
    choice = toUniform(makePair(loadStart(s.path), 3U).second);
  const UInt u = nextBits(s);
  const UInt v = nextBits(s);
  const LightSamples light = sampleLights(mapPoint(scene.toLocal, s.origin), choice, u, v);
  const ScatterEval scattered = evaluateVertex(vertex, light.direction);
  s.light = weighLight(light.radiance, light.pdf, light.isDelta, scattered, s.throughput);
  const UInt depthBits = nextBits(s);
  const Float acceptance = nextUniform(s);
  if (!(maxComponent(s.light) > 0.0F))
    return;
  const Float3 ray = mapDirection(scene.localToIndex, light.direction);
  s.phase = shadowRay;
  s.ratio = 1.0F;
  startRay(s, ray, min(light.distance, lengthInDomain(s.origin, ray)), depthBits, acceptance);
}

/// Scatters at a collision, `distance` mm along the ray.
FORMULA void scatter(INOUT(PathState) s, Float distance, Float scalar) {
  const LaneMask isFirst = s.bounces == 0;
  s.bounces = s.bounces + 1;
  s.origin = s.origin + distance * s.ray;
  const Vertex vertex = makeVertex(s, isFirst, scalar);
  if (isFirst)
    recordFirstHit(s, vertex, distance);
  if (hasSampledLights != 0)
    startShadowRay(s, vertex, isFirst);
  Float choice = 0.0F;
  if (isHybrid != 0)
    choice = nextUniform(s);
  Float u = nextUniform(s);
  Float v = nextUniform(s);
  if (isFirst) {
    const WordPair first = makePair(loadStart(s.path), 2U);
    u = toUniformBelow1(first.first);
    v = toUniformBelow1(first.second);
  }
  const ScatterSamples next = sampleVertex(vertex, choice, u, v);
  s.throughput = s.throughput * next.weight;
  const Float keep = keepProbability(s.throughput);
  s.throughput = zeroUnless(nextUniform(s) <= keep, (1.0F / keep) * s.throughput);
  s.scatterPdf = next.pdf;
  s.direction = next.outgoing;
}

/// After a vertex and its shadow ray: starts the scattered ray, or ends the path.
FORMULA void continuePath(INOUT(PathState) s) {
  if (maxComponent(s.throughput) > 0.0F)
    startPathRay(s);
  else
    endPath(s, 0.0F);
}

/// Handles the end of a ray: a collision at `distance`, or infinity.
FORMULA void handleVertex(INOUT(PathState) s, Float distance, Float scalar) {
  if (s.bounces > 0)
    s.radiance = s.radiance + s.throughput * findEmission(mapPoint(scene.toLocal, s.origin),
                                                          s.direction, distance, s.scatterPdf);
  if (distance == infiniteReal || s.bounces >= scene.bounces) {
    endPath(s, distance);
    return;
  }
  countWork(collisionCount);
  scatter(s, distance, scalar);
  if (s.phase == pathRay)
    continuePath(s);
  else
    countWork(shadowRayCount);
}

/// Handles a tentative collision. Returns true if the ray ends there.
FORMULA bool collide(INOUT(PathState) s, STRUCT(Walk) walk, STRUCT(Cell) cell,
                     INOUT(Float) scalar) {
  countWork(lookupCount);
  const Float3 point = pointAt(walk, s.t);
  scalar = interpolateScalar(point);
  const Extinctions all = evalExtinctions(point, scalar);
  const Float u = s.acceptance;
  Float extinction = all.clipped + all.unclipped;
  if (clipKind != clipNone && cell.isCut) {
    // The clip is evaluated only where it matters: where the collision could be real without it.
    LaneMask isPossible = s.phase == pathRay ? u * cell.majorant < extinction : all.clipped > 0.0F;
    Float clipped = all.clipped;
    if (hasSilhouettes != 0 && hasUnclipped == 0 && s.phase == shadowRay && isPossible) {
      // Delta tracking: exact surfaces are queried only if the collision would be real.
      isPossible = toUniform(nextRayBits(s)) * cell.majorant < extinction;
      clipped = cell.majorant;
      extinction = 0.0F;
    }
    if (isPossible)
      extinction = clipped * clipWeight(point) + all.unclipped;
  }
  s.opticalDepth = toExponential(nextRayBits(s));
  s.acceptance = toUniform(nextRayBits(s));
  if (s.phase == pathRay)
    return u * cell.majorant < extinction;
  s.ratio = attenuate(s.ratio, extinction, cell.majorant);
  if (s.ratio < leastRatio)
    s.ratio = playRatioRoulette(s.ratio, u);
  return s.ratio <= 0.0F;
}

/// Advances a path that is not idle. `walk`: of its ray; a new ray replaces it.
FORMULA void advance(INOUT(PathState) s, INOUT(Walk) walk) {
  const Cell cell = findCell(walk, s.t);
  const Float stop = min(max(cell.exit, s.t) + scene.overshoot, s.end);
  const Float depthToStop = (stop - s.t) * cell.majorant;
  Float distance = infiniteReal;
  Float scalar = 0.0F;
  if (s.opticalDepth < depthToStop) {
    s.t = s.t + s.opticalDepth / cell.majorant;
    if (!collide(s, walk, cell, scalar))
      return;
    distance = s.t;
  } else {
    countWork(cellCount);
    if (cell.majorant == 0.0F)
      countWork(skippedCellCount);
    s.t = stop;
    s.opticalDepth = s.opticalDepth - depthToStop;
    if (stop < s.end)
      return;
  }
  if (s.phase == shadowRay) {
    s.radiance = s.radiance + s.ratio * s.light;
    continuePath(s);
  } else {
    handleVertex(s, distance, scalar);
  }
  walk = makeWalk(s.origin, s.ray);
}
