#pragma once
// Damages a file as hands, programs and disks do: in its numbers, attributes, lines, blocks and
// bytes.

#include <random>
#include <string>

namespace fenestra::faults {

/// A function of the bytes and the numbers drawn alone.
std::string mutated(std::string bytes, std::mt19937_64& random);

} // namespace fenestra::faults
