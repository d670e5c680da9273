#pragma once
// SIMD instruction sets that the program is compiled for (base/SimdTargets.h). One is selected at
// run time. Names are Highway's: AVX3 (AVX-512), AVX2, SSE4, SCALAR (no SIMD).

#include <string>
#include <vector>

namespace fenestra::core {

/// Instruction sets that both the program and this machine support, best first.
std::vector<std::string> instructionSets();
/// Instruction set in use: the best, unless another was pinned.
std::string instructionSet();
/// Pins one of instructionSets() for the process; the command line does so for the environment
/// variable FENESTRA_INSTRUCTIONS. Throws Error (request) for any other name. Must not be called
/// while SIMD code runs.
void useInstructionSet(const std::string& name);

} // namespace fenestra::core
