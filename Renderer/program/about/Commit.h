#pragma once

namespace fenestra::core {

extern const char* const commitText; ///< "unknown": built outside git; "…-dirty": modified tree
extern const char* const commitDate; ///< year-month-day, UTC

} // namespace fenestra::core
