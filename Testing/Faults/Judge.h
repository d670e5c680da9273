#pragma once
// What must hold after a run, whatever went wrong in it.

#include "Requests.h"

namespace fenestra::faults {

/// Runs the subject with the fault in the place and says what is wrong, a line each; nothing where
/// all holds. A death inside a library for want of memory is not wrong: the outcome's signal tells.
std::vector<std::string> judge(const Subject& subject, const Fault& fault, const Place& place,
                               Outcome& outcome);

/// What standard error has beside warnings.
std::vector<std::string> errorLines(const Outcome& outcome);

/// The innermost function of a death that is no part of the language's own libraries, and whether
/// it is the project's.
struct Culprit {
  std::string function;
  bool isOurs;
};

/// The exported name, else what the module's own table says.
std::string functionOf(const Frame& frame);

Culprit culprit(const std::vector<Frame>& frames);

} // namespace fenestra::faults
