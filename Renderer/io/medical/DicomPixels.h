#pragma once
// The voxels of one DICOM slice. For io's own sources.

#include "io/medical/DicomHeader.h"

#include <filesystem>
#include <variant>
#include <vector>

namespace fenestra {

using DicomSamples = std::variant<std::vector<std::int32_t>, std::vector<double>>;

/// Throws Error (input) unless the header's numbers are those of an image, and its file can hold
/// it.
void checkDicomPixels(const std::filesystem::path& path, const DicomHeader& header);

/// Rescaled: std::int32_t, or double where that has fractions or is larger. Takes what
/// checkDicomPixels lets pass. What is compressed goes through GDCM's decompressors, and its
/// codestream must be of the size that the header says. Throws Error (input).
DicomSamples readDicomPixels(const std::filesystem::path& path, const DicomHeader& header);

} // namespace fenestra
