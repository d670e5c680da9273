#pragma once
// Acquisitions that interleave.

#include "files/medical/DicomSeries.h"

namespace fenestra {

/// Joins groups of slices, in the order of a key, to phases: a group that continues the phase
/// before it, with an overlap of less than one slice distance, is part of it. Empty: there is only
/// one phase. Unless `isCertain`, also empty if the slices may well be one volume: phases are
/// sparser than the slice distance that the file states, as when odd slices are scanned first, or
/// all slices together have this distance (even spacing, if none is stated).
std::vector<DicomSlices> joinPhases(const std::vector<DicomSlices>& groups, bool isCertain);

} // namespace fenestra
