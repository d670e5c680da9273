#pragma once
// Acquisitions that interleave.

#include "files/medical/DicomSeries.h"

namespace fenestra::core {

/// Joins groups of slices, in the order of a key, to phases: a group that continues the phase
/// before it, with an overlap of less than one slice distance, is part of it.
std::vector<DicomSlices> joinPhases(const std::vector<DicomSlices>& groups);

/// True if phases may well be parts of one volume: all slices together have the distance that the
/// file states, or even spacing if it states none, as when odd slices are scanned first; or phases
/// are sparser than that.
bool canBeOneVolume(const std::vector<DicomSlices>& phases);

} // namespace fenestra::core
