#pragma once
// Tests of lanes on each of the machine's instruction sets.

#include "base/InstructionSets.h"

#include <gtest/gtest.h>

namespace fenestra::testing {

/// Pins the instruction set of that number, the best first; skips where the machine has fewer.
class InstructionSetTest : public ::testing::TestWithParam<std::size_t> {
protected:
  void SetUp() override {
    const std::vector<std::string> available = instructionSets();
    if (GetParam() >= available.size())
      GTEST_SKIP() << "this machine has fewer";
    useInstructionSet(available[GetParam()]);
  }
  void TearDown() override { useInstructionSet(instructionSets().front()); }
};

inline const auto allInstructionSets = ::testing::Range<std::size_t>(0, 4);

} // namespace fenestra::testing
