#pragma once
// Flags of clipping, and of how focus and context differ.

#include "program/Flags.h"
#include "session/RenderRequest.h"

namespace fenestra {

/// Both throw Error (usage) for flags that contradict each other or have no effect.
ClipRequest clipRequest(const FlagValues& flags);
FocusRequest focusRequest(const FlagValues& flags);

} // namespace fenestra
