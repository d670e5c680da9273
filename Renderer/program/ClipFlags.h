#pragma once
// The flags that say what is removed from view, and how the focus differs from the rest.

#include "program/Flags.h"
#include "session/RenderRequest.h"

namespace fenestra {

/// Both throw Error (usage) for flags that contradict each other or do nothing.
ClipRequest clipRequest(const FlagValues& flags);
FocusRequest focusRequest(const FlagValues& flags);

} // namespace fenestra
