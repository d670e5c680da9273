#pragma once
// Reads a NIfTI-1 file, plain or compressed. ITK's library silently turns samples that are not
// finite into zeros, and holds all samples twice; a child (Apart.h) would copy them once more.

#include "files/medical/NiftiHeader.h"

#include <cstddef>
#include <filesystem>
#include <string>

namespace fenestra {

/// Throws Error (input) as parseNiftiHeader does, and where the file is too short.
NiftiHeader readNiftiHeader(const std::filesystem::path& path);

/// Bytes of all header extensions, with their sizes and codes; at most 4 MiB. Throws Error (input)
/// where the file ends before.
std::string readNiftiExtensions(const std::filesystem::path& path, const NiftiHeader& header);

/// First `count` samples of the file. Throws Error (input) for more samples than the file can hold;
/// reading them throws where the file ends before.
SampleSource openNiftiSamples(const std::filesystem::path& path, const NiftiHeader& header,
                              std::size_t count);

} // namespace fenestra
