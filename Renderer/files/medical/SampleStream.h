#pragma once
// Bytes of samples, as stored, or inflated from one zlib or gzip stream.

#include "files/medical/MedicalHeader.h"
#include "files/medical/SampleSource.h"

namespace fenestra {

/// Lets `source` read samples that locateSamples found to be `isRaw` or `isStream`. `path` is for
/// messages; `declared` bytes have passed checkDeclaredBytes. Reading throws Error (input) where
/// the samples end before; finishing, unless a compressed stream ends at `declared` bytes, with the
/// right checksum.
void openStream(const std::filesystem::path& path, const StoredSamples& stored,
                std::uint64_t declared, SampleSource& source);

} // namespace fenestra
