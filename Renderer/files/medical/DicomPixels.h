#pragma once
// From the stored voxels of one DICOM slice to scalars. For io's own sources.

#include "files/medical/DicomHeader.h"

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

namespace fenestra {

using DicomSamples = std::variant<std::vector<std::int32_t>, std::vector<double>>;

/// Throws Error (input) unless the header's numbers are those of an image, and its file can hold
/// it.
void checkDicomPixels(const std::filesystem::path& path, const DicomHeader& header);

/// Rescaled: std::int32_t, or double where that has fractions or is larger. Takes a header that
/// checkDicomPixels lets pass, and what DicomFiles::voxels gives for it.
DicomSamples rescaledVoxels(const DicomHeader& header, const std::string& voxels);

} // namespace fenestra
