// Components of a mixture at points in index space.

/// Turns a bool into a compile-time constant for std::visit.
inline std::variant<std::false_type, std::true_type> toConstant(bool value) {
  if (value)
    return std::true_type();
  return std::false_type();
}

/// Extinction (mm^-1) of one component per lane, at label weight 1.
HWY_INLINE Float evalExtinction(const SimdLines& table, LaneMask which, Int components,
                                Float scalar) {
  LineValue at = evalLines(table, zeroUnless(which, components * table.count), scalar);
  forEachComponent(which & at.hasKnot, components, [&](LaneMask same, std::size_t component) {
    at.value.setIf(same, evalTable(table.segments[component], scalar));
  });
  return at.value;
}

/// Lanes of `which` whose component is unclipped.
HWY_INLINE LaneMask findUnclipped(const SimdMixture& mixture, LaneMask which, Int components) {
  if (!mixture.hasUnclipped)
    return LaneMask::none();
  return gather(mixture.isUnclipped.data(), zeroUnless(which, components)) == 1;
}

/// Calls visit(lanes, components, extinctions) for the components in the lanes of `which`
/// (MixtureField::forEachPart). Extinctions are 0 outside `lanes`. `weight`: clip weight.
template <typename Visit>
HWY_INLINE void forEachPart(const SimdMedium& medium, LaneMask which, const Float3& index,
                            Float scalar, Float weight, Visit&& visit) {
  const auto part = [&](LaneMask lanes, Int components, Float fraction) {
    const Float full = fraction * evalExtinction(medium.extinctions, lanes, components, scalar);
    const LaneMask unclipped = findUnclipped(*medium.mixture, lanes, components);
    visit(lanes, components, select(unclipped, full, weight * full));
  };
  LaneLabelWeights(medium.mixture->weights, index).forEach(which, part);
}

/// Extinction (mm^-1) of the components that the clip can remove, and of the unclipped ones.
struct LaneExtinctions {
  Float clipped, unclipped;
};
inline LaneExtinctions sumExtinctions(const SimdMedium& medium, LaneMask which, const Float3& index,
                                      Float scalar) {
  LaneExtinctions sums{0.0F, 0.0F};
  const auto add = [&](LaneMask lanes, Int components, Float fraction) {
    const Float part = fraction * evalExtinction(medium.extinctions, lanes, components, scalar);
    const LaneMask unclipped = findUnclipped(*medium.mixture, lanes, components);
    sums.unclipped = sums.unclipped + zeroUnless(unclipped, part);
    sums.clipped = sums.clipped + select(unclipped, 0.0F, part);
  };
  LaneLabelWeights(medium.mixture->merged, index).forEach(which, add);
  return sums;
}

/// Extinction at points, under the context's style. `isMixed`: the medium is a mixture.
template <bool isMixed>
HWY_INLINE LaneExtinctions evalExtinctions(const SimdMedium& medium, LaneMask which,
                                           const Float3& index, Float scalar) {
  LaneExtinctions all{0.0F, 0.0F};
  if constexpr (isMixed)
    all = sumExtinctions(medium, which, index, scalar);
  else
    all.clipped = evalExtinction(medium.extinctions, scalar);
  if (medium.context && medium.context->extinction != 1.0F) {
    const Float factor = select(isFocus(*medium.context, index), 1.0F, medium.context->extinction);
    all = {all.clipped * factor, all.unclipped * factor};
  }
  return all;
}

/// Clip weight for a mixture with clipped and unclipped components; else 1, as it then cancels.
inline Float mixtureClipWeight(const SimdMedium& medium, LaneMask which, const Float3& index) {
  return medium.mixture->hasUnclipped && medium.clipKind != SimdMedium::ClipKind::none
             ? clipWeight(medium, index, which)
             : Float(1.0F);
}

/// Samples one component per lane of `which` at a collision (MixtureField::sampleComponent); 0 in
/// the other lanes.
inline Int sampleComponents(const SimdMedium& medium, LaneMask which, const Float3& index,
                            Float scalar, Float uniform) {
  const Float weight = mixtureClipWeight(medium, which, index);
  Float sum = 0.0F;
  forEachPart(medium, which, index, scalar, weight,
              [&](LaneMask, Int, Float part) { sum = sum + part; });
  Float left = uniform * sum;
  LaneMask undecided = which;
  Int sampled = 0;
  forEachPart(medium, which, index, scalar, weight, [&](LaneMask, Int components, Float part) {
    const LaneMask some = undecided & (part > 0.0F);
    sampled = select(some, components, sampled); // the last component, if rounding skips all
    undecided = undecided.without(some & (left < part));
    left = left - part;
  });
  return sampled;
}
