#pragma once
// Reads raw samples, or inflates them from one zlib or gzip stream.

#include "files/medical/MedicalHeader.h"
#include "files/medical/SampleSource.h"

namespace fenestra::core {

/// Sets up `source` to read samples for which locateSamples set `isRaw` or `isStream`. `path` is
/// used in messages; `declared` is the result of checkDeclaredBytes. Reading throws Error (input)
/// if the samples end early. Finishing throws unless a compressed stream ends after exactly
/// `declared` bytes with the right checksum.
void openStream(const std::filesystem::path& path, const StoredSamples& stored,
                std::uint64_t declared, SampleSource& source);

} // namespace fenestra::core
