#pragma once
// --paper: the conditions of the paper's images, for comparison with it.

#include "program/Options.h"

namespace fenestra::core {

/// Help text: the options that it stands for.
std::string describePaperConditions();

/// Adds the options that --paper stands for, if it is given, except those that are given themselves
/// (`isGiven`) or would have no effect with the given ones. Returns `values` otherwise.
OptionValues addPaperConditions(OptionValues values,
                                const std::function<bool(const std::string& name)>& isGiven);

/// True for an option that --paper stands for.
bool isPaperCondition(const std::string& name);

} // namespace fenestra::core
