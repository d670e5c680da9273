#pragma once

namespace fenestra {

extern const char* const commitText; ///< "unknown": built outside git; "…-dirty": modified tree
extern const char* const commitDate; ///< year-month-day, UTC

} // namespace fenestra
