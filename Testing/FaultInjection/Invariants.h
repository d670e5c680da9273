#pragma once
// Checks the invariants after a run with an injected fault.

#include "Requests.h"

namespace fenestra::core::faults {

/// Runs the request with `fault` in `workspace`; returns one line per violation. A crash inside a
/// library after a failed allocation is not a violation, but is reported in outcome.signal.
std::vector<std::string> checkRun(const Baseline& baseline, const Fault& fault,
                                  const Workspace& workspace, Outcome& outcome);

/// Lines of standard error that are not warnings.
std::vector<std::string> listErrorLines(const Outcome& outcome);

/// Innermost function on the stack of a crash that is not part of the C or C++ runtime; isFenestra:
/// it belongs to Fenestra.
struct Culprit {
  std::string function;
  bool isFenestra;
};

/// Exported name of a frame's function, or else its name in the symbol table of the module.
std::string findFunctionName(const Frame& frame);

Culprit findCulprit(const std::vector<Frame>& frames);

} // namespace fenestra::core::faults
