#pragma once
// Instruction sets that lanes are compiled for (base/SimdTargets.h): one is chosen at run time, by
// Highway's names: AVX3 (AVX-512), AVX2, SSE4, SCALAR (none needed).

#include <string>
#include <vector>

namespace fenestra {

/// Instruction sets of both program and machine, the best first.
std::vector<std::string> instructionSets();
/// Instruction set in use: the best, unless another was pinned.
std::string instructionSet();
/// Pins one of instructionSets(), for the whole process (the command line does it on behalf of the
/// environment variable FENESTRA_INSTRUCTIONS); throws Error (usage) for any other name. Must not
/// be called while lanes compute.
void useInstructionSet(const std::string& name);

} // namespace fenestra
