#pragma once
// Corrupts a file at several levels: numbers, attributes, lines, blocks and bytes.

#include <random>
#include <string>

namespace fenestra::core::faults {

/// Corrupted bytes. The same bytes and random state give the same result on all machines.
std::string corrupt(std::string bytes, std::mt19937_64& random);

} // namespace fenestra::core::faults
