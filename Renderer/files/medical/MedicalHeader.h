#pragma once
// What the header of a medical image says about where its samples are, read before any library
// trusts it; in this process (not as Apart.h), for samples are the bulk of all that is read and go
// from the file to their place without a copy. For io's own sources.

#include <bit>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace fenestra {

enum class MedicalFormat { nrrd, nifti, metaImage };

/// By extension, in either case: .nrrd .nhdr, .nii .nii.gz, .mha .mhd; nothing where it is unknown.
std::optional<MedicalFormat> medicalFormat(const std::filesystem::path& path);

/// Where samples are stored, and how.
struct StoredSamples {
  std::vector<std::filesystem::path> files; ///< regular files, in order
  std::uint64_t offset = 0;                 ///< of the first sample's byte in the first file
  std::uint64_t bytes = 0;                  ///< from there on, in all files
  bool compressed = false;                  ///< or written as text: a byte may stand for more

  // What SampleStream reads, from `offset` on in one file: as they are, or one zlib or gzip stream.
  bool isRaw = false, isStream = false;
  std::optional<std::endian> order = {}; ///< of the bytes in a sample, where the header says
  bool isListFirst = false;              ///< a NRRD's fastest axis is the list of components
  bool hasSpacing = true;                ///< false where the header says nothing of it
};

/// Throws Error (input) where the header is not of its format, points to something other than plain
/// files, or states what ITK's readers are known not to survive.
StoredSamples locateSamples(const std::filesystem::path& path, MedicalFormat format);

/// Throws Error (input) unless the samples can be `declared` bytes: exactly checked for stored
/// ones, by deflate's greatest ratio for compressed ones.
void checkCapacity(const std::filesystem::path& path, const StoredSamples& stored,
                   std::uint64_t declared);

} // namespace fenestra
