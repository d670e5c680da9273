#pragma once
// Flags of an organ preset: --preset liver stands for a focus, a look, a view and a clip in one.

#include "program/RenderFlags.h"
#include "session/Input.h"

namespace fenestra {

struct PresetFlags {
  FlagValues flags;
  /// Modality for which the transfer function was made; nullopt: it is not the preset's.
  std::optional<Modality> transferFor = {};
};

/// Flags of `fenestra render` merged with those of their preset, whose own name replaces "auto".
/// Focus: all segments that the preset knows, from the segmentation that a render would read;
/// without a segmentation, nothing is clipped. Given flags win; a given --clip wins over all that
/// the preset says of clipping modes. Throws Error: usage; input, also if the preset knows none of
/// the segments.
PresetFlags withPreset(const FlagValues& given, const Input& input);

/// Render options from given flags and their preset's.
RenderOptions renderOptions(const PresetFlags& flags);

} // namespace fenestra
