#pragma once
// Damages a file as people, programs and disks do: in its numbers, attributes, lines, blocks and
// bytes.

#include <random>
#include <string>

namespace fenestra::faults {

/// Damaged bytes; a function of the bytes and the random numbers only.
std::string corrupt(std::string bytes, std::mt19937_64& random);

} // namespace fenestra::faults
