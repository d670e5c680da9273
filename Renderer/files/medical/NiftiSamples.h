#pragma once
// Reads files of the formats of NiftiHeader.h and MghHeader.h, plain or compressed. ITK's reader
// silently replaces non-finite samples by zeros and holds all samples twice. A sandboxed child
// (Sandbox.h) would copy them once more.

#include "files/medical/MedicalHeader.h"
#include "files/medical/NiftiHeader.h"

#include <cstddef>
#include <filesystem>
#include <string>

namespace fenestra::core {

/// Throws Error (input) as parseNiftiHeader does, and if the file is too short.
NiftiHeader readNiftiHeader(const std::filesystem::path& path, const VolumeChoice& choice = {});

/// Throws Error (input) as parseMghHeader does, and if the file is too short.
NiftiHeader readMghHeader(const std::filesystem::path& path);

/// Raw bytes of all header extensions, including their sizes and codes; at most 4 MiB. Throws Error
/// (input) if the file is too short.
std::string readNiftiExtensions(const std::filesystem::path& path, const NiftiHeader& header);

/// Source of the first `count` samples. `stored`: by locateSamples. Throws Error (input) if the
/// file cannot hold that many; reading throws if the file turns out to be too short.
SampleSource openNiftiSamples(const std::filesystem::path& path, const StoredSamples& stored,
                              const NiftiHeader& header, std::size_t count);

} // namespace fenestra::core
