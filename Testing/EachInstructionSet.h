#pragma once
// Fixture for tests of SIMD code on each of the machine's instruction sets.

#include "base/InstructionSets.h"

#include <gtest/gtest.h>

namespace fenestra::core::testing {

/// Selects the instruction set with this index, best first; skips if the machine has fewer.
class InstructionSetTest : public ::testing::TestWithParam<std::size_t> {
protected:
  void SetUp() override {
    const std::vector<std::string> available = instructionSets();
    if (GetParam() >= available.size())
      GTEST_SKIP() << "this machine has fewer instruction sets";
    useInstructionSet(available[GetParam()]);
  }
  void TearDown() override { useInstructionSet(instructionSets().front()); }
};

inline const auto allInstructionSets = ::testing::Range<std::size_t>(0, 4);

} // namespace fenestra::core::testing
