#include "base/InstructionSets.h"

#include "base/Error.h"
#include "base/SimdTargets.h"
#include "base/Text.h"

#include <hwy/targets.h>

namespace fenestra::core {
namespace {

/// Bits of the instruction sets that both program and machine support, before any choice by
/// useInstructionSet(); the lowest bit is the best set.
std::int64_t findSupportedSets() {
  static const std::int64_t supported = hwy::SupportedTargets() & HWY_TARGETS;
  return supported;
}

} // namespace

std::vector<std::string> instructionSets() {
  std::vector<std::string> names;
  for (std::int64_t left = findSupportedSets(); left != 0; left &= left - 1)
    names.emplace_back(hwy::TargetName(left & -left));
  return names;
}

std::string instructionSet() {
  const std::int64_t sets = hwy::SupportedTargets() & HWY_TARGETS;
  return hwy::TargetName(sets & -sets);
}

void useInstructionSet(const std::string& name) {
  for (std::int64_t left = findSupportedSets(); left != 0; left &= left - 1)
    if (name == hwy::TargetName(left & -left))
      return hwy::SetSupportedTargetsForTest(left & -left);
  throw requestError(ErrorCode::unknownName, "FENESTRA_INSTRUCTIONS", name,
                     " is not an instruction set of this machine; use one of " +
                         join(instructionSets(), ", "));
}

} // namespace fenestra::core
