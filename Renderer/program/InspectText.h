#pragma once
// Text of `fenestra inspect`.

#include "session/Inspection.h"

#include <string>

namespace fenestra {

/// Lines of at most 100 characters; a list that is cut says how much is missing.
std::string inspectionText(const Inspection& inspection);

} // namespace fenestra
