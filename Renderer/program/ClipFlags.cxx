#include "program/ClipFlags.h"

#include "base/Error.h"

#include <algorithm>

namespace fenestra {
namespace {

ClipMode clipMode(const std::string& word) {
  static const std::map<std::string, ClipMode> modes = {
      {"none", ClipMode::none},       {"plane", ClipMode::plane}, {"hole", ClipMode::hole},
      {"cutaway", ClipMode::cutaway}, {"ghost", ClipMode::ghost}, {"surface", ClipMode::surface}};
  return modes.at(word);
}

HoleShape holeShape(const std::string& word) {
  if (word == "box")
    return HoleShape::box;
  return word == "sphere" ? HoleShape::sphere : HoleShape::cylinder;
}

/// Flags used by some modes only.
struct ModeFlags {
  std::vector<const char*> names;
  std::vector<ClipMode> modes;
  const char* rule;
};

void refuseUnused(const FlagValues& flags, ClipMode mode, Boundary boundary) {
  using enum ClipMode;
  static const std::vector<ModeFlags> all = {
      {{"plane"}, {plane}, "only --clip plane uses it; add --clip plane, or drop it"},
      {{"hole", "holemargin"}, {hole}, "only --clip hole uses it; add --clip hole, or drop it"},
      {{"ghost"}, {ghost}, "only --clip ghost uses it; add --clip ghost, or drop it"},
      {{"boundary", "controlpoints", "smoothing"},
       {surface, ghost},
       "only --clip surface and ghost use it; drop it"},
      {{"offset", "soft"},
       {plane, hole, cutaway, surface, ghost},
       "without a clip there is nothing to change; drop it"}};
  for (const ModeFlags& some : all)
    for (const char* name : some.names)
      if (flags.differs(name) && std::ranges::find(some.modes, mode) == some.modes.end())
        throw usageError(std::string("--") + name + ": " + some.rule);
  for (const char* name : {"controlpoints", "smoothing"})
    if (boundary == Boundary::exact && flags.differs(name))
      throw usageError(std::string("--") + name + ": only --boundary spline uses it; drop it");
}

PlaneRequest planeRequest(const std::vector<double>& numbers) {
  const Vec3 normal(numbers[3], numbers[4], numbers[5]);
  if (normal.isZero(0.0))
    throw usageError("--plane: the normal NX,NY,NZ must not be zero");
  return {Vec3(numbers[0], numbers[1], numbers[2]), normal.stableNormalized()};
}

} // namespace

ClipRequest clipRequest(const FlagValues& flags) {
  ClipRequest clip;
  SurfaceOptions& surface = clip.surface;
  if (flags.differs("clip"))
    clip.mode = clipMode(*flags.word("clip"));
  if (const auto boundary = flags.word("boundary"))
    surface.boundary = *boundary == "exact" ? Boundary::exact : Boundary::spline;
  if (const auto n = flags.count("controlpoints"))
    surface.controlPoints = static_cast<int>(*n);
  surface.smoothing = flags.number("smoothing").value_or(surface.smoothing);
  if (const auto numbers = flags.numbers("plane", 6))
    clip.plane = planeRequest(*numbers);
  surface.hole = {holeShape(flags.word("hole").value_or("cylinder")),
                  flags.number("holemargin").value_or(surface.hole.margin)};
  clip.ghost = flags.number("ghost").value_or(clip.ghost);
  surface.offset = flags.number("offset").value_or(surface.offset);
  surface.edge.softness = flags.number("soft").value_or(surface.edge.softness);

  const bool hasFocus = flags.has("focus");
  const ClipMode mode = clip.modeWith(hasFocus);
  if (!hasFocus && isDepthClip(mode))
    throw usageError("--clip: " + *flags.text("clip") + " needs a focus; add --focus");
  if (mode == ClipMode::plane && !clip.plane && !hasFocus)
    throw usageError("--clip: plane needs --plane OX,OY,OZ,NX,NY,NZ, or a --focus to place it by");
  refuseUnused(flags, mode, surface.boundary);
  return clip;
}

FocusRequest focusRequest(const FlagValues& flags) {
  FocusRequest focus;
  if (const auto text = flags.text("margin"))
    focus.shaping.margins =
        *flags.numbers("margin", 1 + static_cast<std::size_t>(std::ranges::count(*text, ',')));
  for (const double margin : focus.shaping.margins)
    if (std::abs(margin) > 1000.0)
      throw usageError("--margin: must be from -1000 to 1000 mm");
  focus.shaping.smoothing = flags.number("labelsmoothing").value_or(focus.shaping.smoothing);
  focus.contextExtinction = flags.number("contextdensity").value_or(focus.contextExtinction);
  focus.contextSaturation = flags.number("contextsaturation").value_or(focus.contextSaturation);
  if (!flags.has("focus"))
    for (const char* name : {"margin", "labelsmoothing", "contextdensity", "contextsaturation"})
      if (flags.differs(name))
        throw usageError(std::string("--") + name + ": needs a focus; add --focus, or drop it");
  return focus;
}

} // namespace fenestra
