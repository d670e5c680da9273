#pragma once
// Standardized uptake values (SUV) of PET.

#include "files/medical/DicomSeries.h"

namespace fenestra::core {

/// SUV by body weight, g/ml, per Bq/ml: weight over the injected dose, decayed to the time to which
/// the scan's values are corrected (DecayCorrection ADMIN: the injection; START: the series, or the
/// acquisition if that is earlier, since a processed series may state when it was processed).
/// `header`: its acquisition is the earliest of the series. nullopt: the header does not state all
/// of it, or nothing plausible; `fault` says what, like "lacks PatientWeight".
std::optional<double> computeSuvFactor(const DicomHeader& header, std::string& fault);

/// Changes slope and intercept of the slices, which are part of `series`, so that voxels are SUV.
/// Leaves values that are SUV (Units GML), and others if the first slice's header does not suffice.
/// A warning says that they are not SUV.
void convertToSuv(DicomSlices& slices, const DicomSeries& series, const std::string& name,
                  std::vector<Message>& warnings);

} // namespace fenestra::core
