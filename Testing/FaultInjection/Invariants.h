#pragma once
// Invariants after a run with a fault.

#include "Requests.h"

namespace fenestra::faults {

/// Runs the subject with `fault` at `place`; returns the violations, one line each. A crash inside
/// a library for lack of memory is no violation: outcome.signal reports it.
std::vector<std::string> checkRun(const Baseline& baseline, const Fault& fault,
                                  const Workspace& workspace, Outcome& outcome);

/// Lines of standard error that are not warnings.
std::vector<std::string> errorLines(const Outcome& outcome);

/// Innermost function on a crash's stack that is not of the C or C++ runtime; isOurs: the function
/// belongs to the project.
struct Culprit {
  std::string function;
  bool isOurs;
};

/// Exported name of a frame's function, else the name in the module's own symbol table.
std::string functionName(const Frame& frame);

Culprit findCulprit(const std::vector<Frame>& frames);

} // namespace fenestra::faults
