#pragma once
// Scalars from the stored voxels of a DICOM slice.

#include "files/medical/DicomHeader.h"

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

namespace fenestra {

using DicomSamples = std::variant<std::vector<std::int32_t>, std::vector<double>>;

/// Throws Error (input) unless the header describes an image that its file can hold.
void checkDicomPixels(const std::filesystem::path& path, const DicomHeader& header);

/// Scalars after slope and intercept: std::int32_t, or double for fractions and larger values.
/// `header` has passed checkDicomPixels; `voxels` come from DicomFiles::voxels.
DicomSamples rescaledVoxels(const DicomHeader& header, const std::string& voxels);

} // namespace fenestra
