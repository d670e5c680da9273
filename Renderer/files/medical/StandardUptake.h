#pragma once
// Standardized uptake values (SUV) of PET.

#include "files/medical/DicomSeries.h"

namespace fenestra {

/// SUV by body weight, g/ml, per Bq/ml: weight over the injected dose, decayed to the time to which
/// the scan's values are corrected (DecayCorrection START: the series; ADMIN: the injection).
/// nullopt: the header does not state all of it; `missing` says what.
std::optional<double> computeSuvFactor(const DicomHeader& header, std::string& missing);

/// Changes slope and intercept of the slices so that voxels are SUV. If the first slice's header
/// does not suffice, leaves them with a warning.
void convertToSuv(DicomSlices& slices, const std::string& name, std::vector<Message>& warnings);

} // namespace fenestra
