#pragma once
// Locates the samples of a medical image from its header, before any library trusts that header.
// Header fields that would not be applied, such as units and rescaling, are rejected or reported.
// Unlike DICOM, these formats are read in this process, not in the sandbox (Sandbox.h): samples are
// the bulk of all input, and a pipe would copy them once more.

#include <bit>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace fenestra::core {

enum class MedicalFormat { nrrd, nifti, mgh, metaImage, vtk };

/// Format by file extension, case-insensitive: .nrrd .nhdr; .nii .nii.gz, or .hdr and .img, perhaps
/// with .gz (NIfTI or Analyze); .mgz .mgh .mgh.gz; .mha .mhd; .vti; nullopt: unknown.
std::optional<MedicalFormat> findMedicalFormat(const std::filesystem::path& path);

/// Files of a NIfTI or Analyze image: twice the same, or .hdr and .img, whichever is named.
struct NiftiFiles {
  std::filesystem::path header, samples;
};
NiftiFiles findNiftiFiles(const std::filesystem::path& path);

/// Location and encoding of stored samples.
struct StoredSamples {
  std::vector<std::filesystem::path> files; ///< regular files, in order
  std::uint64_t offset = 0;                 ///< byte offset of the first sample in the first file
  std::uint64_t bytes = 0;                  ///< bytes from `offset` on, in all files
  bool isCompressed = false;                ///< or text: one byte may expand to several

  // Encodings that SampleStream reads, starting at `offset` in a single file: raw samples, or one
  // zlib or gzip stream.
  bool isRaw = false, isStream = false;
  std::optional<std::endian> order = {}; ///< byte order; nullopt: not stated
  bool isListFirst = false;              ///< the fastest axis of a NRRD is the list of components
  bool isListLast = false;               ///< its slowest axis is
  bool hasList = false;                  ///< it is a list, not a vector or color
  bool hasSpacing = true;                ///< the header states the voxel spacing
  bool hasAxes = true;                   ///< it states the anatomical directions of the axes
};

/// Throws Error (input) if the header does not match its format, names anything but plain files, or
/// has values known to crash ITK's readers. Not for VTK images (VtkImage.h).
StoredSamples locateSamples(const std::filesystem::path& path, MedicalFormat format);

/// Returns the size in bytes of `count` samples of `sampleBytes` each, plus `skipped` bytes before
/// them. Throws Error (input) if it exceeds the stored bytes (times deflate's maximum ratio, if
/// compressed).
std::uint64_t checkDeclaredBytes(const std::filesystem::path& path, const StoredSamples& stored,
                                 std::uint64_t count, std::uint64_t sampleBytes,
                                 std::uint64_t skipped = 0);

} // namespace fenestra::core
