#pragma once
// Flags that come with an organ preset: --preset liver stands for a focus, a look, a view and a
// clip in one.

#include "program/RenderFlags.h"

namespace fenestra {

struct PresetFlags {
  FlagValues flags;
  /// What the transfer function was made for, where it is the preset's.
  std::optional<Modality> transferFor = {};
};

/// Flags of `fenestra render` with those of their preset, whose own name stands for "auto" then:
/// as a focus all segments that the preset knows, from the segmentation that a render would read;
/// without a segmentation, nothing is clipped. Flags that are given win, as does a mode of clipping
/// over all the preset says of modes. Throws Error (usage or input), where the segments are
/// other ones, too.
PresetFlags withPreset(const FlagValues& given);

/// What a render does by the given flags and their preset's.
RenderOptions renderOptions(const PresetFlags& flags);

} // namespace fenestra
