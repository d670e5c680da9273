#pragma once
// Invariants after a run with a fault.

#include "Requests.h"

namespace fenestra::faults {

/// Runs the subject with the fault in the place; returns the violations, one line each. A death
/// inside a library for want of memory is no violation: outcome.signal reports it.
std::vector<std::string> judge(const Subject& subject, const Fault& fault, const Place& place,
                               Outcome& outcome);

/// Lines of standard error that are not warnings.
std::vector<std::string> errorLines(const Outcome& outcome);

/// Innermost function of a crash outside the language's own libraries; isOurs: a function of the
/// project.
struct Culprit {
  std::string function;
  bool isOurs;
};

/// Exported name of a frame's function, else the name in the module's own symbol table.
std::string functionOf(const Frame& frame);

Culprit culprit(const std::vector<Frame>& frames);

} // namespace fenestra::faults
