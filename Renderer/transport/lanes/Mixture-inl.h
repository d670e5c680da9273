// Parts of a mixture at points in index space.

/// Extinction (mm^-1) of one component a lane, as if it had all of the space.
HWY_INLINE Float extinctionOf(const WideMixture& mixture, LaneMask which, Int components,
                              Float scalar) {
  const Float place =
      max(min((scalar - mixture.start) * mixture.linesPerUnit, mixture.lastLine), 0.0F);
  const Float line = floor(place);
  const Int at = orZero(which, components * mixture.count) + wholeToInt(line);
  const auto [value, rise] = loadPairs(&mixture.lines[0].value, Indices(shiftLeft<1>(at)));
  Float extinction = notBelow0(fma(place - line, rise, value));
  const LaneMask bent = which & ~(rise == rise);
  forEachComponent(bent, components, [&](LaneMask same, std::size_t component) {
    const WideTable& table = mixture.extinction[component];
    extinction.where(same, valueIn(table.channels[0], segmentOf(table, scalar)));
  });
  return extinction;
}

/// Lanes of `which` whose component the clip leaves.
HWY_INLINE LaneMask freeIn(const WideMixture& mixture, LaneMask which, Int components) {
  return gather(mixture.isFree.data(), orZero(which, components)) == 1;
}

/// Calls visit(lanes, components, extinctions) for the parts in the lanes of `which`
/// (MixedField::forEachPart); extinctions of lanes that are not in `lanes` are 0. `kept`: keep of
/// the clip.
template <typename Visit>
HWY_INLINE void forEachPart(const WideMixture& mixture, LaneMask which, const Float3& index,
                            Float scalar, Float kept, Visit&& visit) {
  LaneShares(mixture.shares, index)
      .forEach(which, [&](LaneMask lanes, Int components, Float share) {
        Float part = share * extinctionOf(mixture, lanes, components, scalar);
        if (mixture.hasFree) {
          const LaneMask free = freeIn(mixture, lanes, components);
          part = select(free, part, kept * part);
        } else {
          part = kept * part;
        }
        visit(lanes, components, part);
      });
}

/// Extinction (mm^-1) of what a clip may remove, and of what it leaves.
struct LaneExtinctions {
  Float clipped, free;
};
inline LaneExtinctions extinctionsOf(const WideMixture& mixture, LaneMask which,
                                     const Float3& index, Float scalar) {
  LaneExtinctions sums{0.0F, 0.0F};
  LaneShares(mixture.alike, index).forEach(which, [&](LaneMask lanes, Int components, Float share) {
    const Float part = share * extinctionOf(mixture, lanes, components, scalar);
    if (!mixture.hasFree) {
      sums.clipped = sums.clipped + part;
      return;
    }
    const LaneMask free = freeIn(mixture, lanes, components);
    sums.free = sums.free + orZero(free, part);
    sums.clipped = sums.clipped + select(free, 0.0F, part);
  });
  return sums;
}

/// Extinctions of all matter at points, under the context's style. `isMixed`: there is a mixture.
template <bool isMixed>
HWY_INLINE LaneExtinctions extinctionsAt(const WideScene& scene, LaneMask which,
                                         const Float3& index, Float scalar) {
  LaneExtinctions all{0.0F, 0.0F};
  if constexpr (isMixed)
    all = extinctionsOf(*scene.mixture, which, index, scalar);
  else
    all.clipped = extinctionOf(scene, scalar);
  if (scene.context && scene.context->extinction != 1.0F) {
    const LaneMask focus = isFocus(*scene.context, index);
    const float factor = scene.context->extinction;
    all.clipped = select(focus, all.clipped, all.clipped * factor);
    if constexpr (isMixed)
      all.free = select(focus, all.free, all.free * factor);
  }
  return all;
}

/// Keep of the clip where a mixture's components differ in it; else 1.
inline Float keptOfParts(const WideScene& scene, LaneMask which, const Float3& index) {
  return scene.mixture->hasFree && scene.clipKind != WideScene::ClipKind::none
             ? keep(scene, index, which)
             : Float(1.0F);
}

/// Components that collisions of the lanes of `which` meet (MixedField::draw); 0 in others.
inline Int drawComponents(const WideMixture& mixture, LaneMask which, const Float3& index,
                          Float scalar, Float kept, Float uniform) {
  Float sum = 0.0F;
  forEachPart(mixture, which, index, scalar, kept,
              [&](LaneMask, Int, Float part) { sum = sum + part; });
  Float left = uniform * sum;
  LaneMask open = which;
  Int drawn = 0;
  forEachPart(mixture, which, index, scalar, kept, [&](LaneMask, Int components, Float part) {
    const LaneMask some = open & (part > 0.0F);
    drawn = select(some, components, drawn); // the last one, if rounding leaves all
    open = open.without(some & (left < part));
    left = left - part;
  });
  return drawn;
}

/// Albedo of one component a lane.
HWY_INLINE Float3 albedoIn(const EventScene& scene, LaneMask which, Int components, Float scalar) {
  Float3 albedo(0.0F, 0.0F, 0.0F);
  forEachComponent(which, components, [&](LaneMask same, std::size_t component) {
    albedo = select(same, albedoOf(scene.albedos[component], scalar), albedo);
  });
  return albedo;
}

/// Scattering of one component a lane; all count as coated, with a coat that may reflect nothing.
inline ScatterLaw<Float> lawsOf(const EventScene& scene, Int components) {
  constexpr std::int32_t stride = sizeof(ScatterLaw<float>) / sizeof(float);
  const Int at = components * stride;
  const ScatterLaw<float>& first = scene.laws.front();
  const auto each = [&](const float& member) { return gather(&member, at); };
  return {each(first.g),
          each(first.diffuse),
          each(first.specular),
          each(first.f0),
          each(first.odds),
          each(first.roughness),
          true,
          {each(first.coat[0]), each(first.coat[1]), each(first.coat[2]), each(first.coat[3])}};
}
