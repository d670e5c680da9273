#pragma once
// The report of `fenestra inspect` as text.

#include "scene/Inspection.h"

#include <string>

namespace fenestra::core {

/// Lines of at most 100 characters; a truncated list states how much is missing. `inspection`: from
/// inspectInput(), with the advice of composeReport().
std::string formatInspection(const Inspection& inspection);

} // namespace fenestra::core
