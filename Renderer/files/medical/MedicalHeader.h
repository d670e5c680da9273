#pragma once
// Place and form of a medical image's samples, read from its header before any library trusts it;
// in this process, not apart (Apart.h), since samples are the bulk of all input and go from the
// file to their place without a copy.

#include <bit>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace fenestra {

enum class MedicalFormat { nrrd, nifti, metaImage };

inline constexpr std::uint64_t niftiHeaderBytes = 348;

/// Format by extension, in either case: .nrrd .nhdr, .nii .nii.gz, .mha .mhd; nullopt: unknown.
std::optional<MedicalFormat> findMedicalFormat(const std::filesystem::path& path);

/// Place and form of stored samples.
struct StoredSamples {
  std::vector<std::filesystem::path> files; ///< regular files, in order
  std::uint64_t offset = 0;                 ///< first sample's byte in the first file
  std::uint64_t bytes = 0;                  ///< bytes from `offset` on, in all files
  bool isCompressed = false;                ///< or text: one byte may stand for several

  // Forms that SampleStream reads, from `offset` on in one file: samples as they are, or one zlib
  // or gzip stream.
  bool isRaw = false, isStream = false;
  std::optional<std::endian> order = {}; ///< byte order; nullopt: not stated
  bool isListFirst = false;              ///< a NRRD's fastest axis is the list of components
  bool hasSpacing = true;                ///< the header states the spacing
};

/// Throws Error (input) where the header is not of its format, names other than plain files, or has
/// values known to crash ITK's readers.
StoredSamples locateSamples(const std::filesystem::path& path, MedicalFormat format);

/// Bytes of `count` samples of `sampleBytes` each, and of the `skipped` ones before them. Throws
/// Error (input) if that is more than the stored samples can be: the stored bytes, times deflate's
/// greatest ratio if compressed.
std::uint64_t checkDeclaredBytes(const std::filesystem::path& path, const StoredSamples& stored,
                                 std::uint64_t count, std::uint64_t sampleBytes,
                                 std::uint64_t skipped = 0);

} // namespace fenestra
