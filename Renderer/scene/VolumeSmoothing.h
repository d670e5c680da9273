#pragma once
// Stages that reduce noise in the volume, and their report.

#include "model/filtering/SmoothingRequest.h"
#include "scene/StageStop.h"
#include "scene/Stages.h"

namespace fenestra::core {

/// What was done to the volume.
struct SmoothingReport {
  double noise = 0.0;         ///< standard deviation, scalar units
  double strength = 0.0;      ///< of the filter, scalar units; 0: little noise, unchanged volume
  bool isReused = false;      ///< another row of a batch had smoothed the same volume
  bool isLogarithmic = false; ///< both numbers, and the filter, apply to log(1 + scalar - minimum)
  bool isHounsfield = false;  ///< the scalar units are HU
  std::int64_t islands = 0;   ///< that were removed
  double islandVolume = 0.0;  ///< of all of them, mm^3

  bool isApplied() const { return strength > 0.0; }
};

/// Contrast that spheres in a liver have after smoothing, percent of that before. Measured, only
/// for CT, by SmoothingBenchmark: CT of 33 HU noise, voxels of 0.94 x 0.94 x 2.5 mm, contrasts of
/// -20, -40 and 60 HU.
struct LesionContrast {
  int diameter; ///< mm
  int percent;
};
inline constexpr LesionContrast lesionContrasts[] = {{4, 47}, {6, 73}, {8, 90}};

struct SmoothedVolume {
  std::optional<VolumeInput> input = {}; ///< empty: the volume is unchanged
  SmoothingReport report = {};
  std::vector<Message> warnings = {};
};

/// Modality of a volume, for its filter: that of its file, else CT by its range, ultrasound by the
/// preset's modality or the name of the transfer function, else MR.
Modality findModality(const Volume& volume, const std::optional<Modality>& transferModality,
                      const std::string& transferName);

/// Non-local means with the noise of the request, else with estimated noise; then noise below 3 HU
/// or, for other modalities, 0.3 % of the range leaves the volume unchanged, as does, with
/// a warning, a machine with less memory than three volumes need. In a batch, uses the result of an
/// earlier row for the same volume and request, bit for bit the same (io/SharedSlot). Throws as
/// requireRunning, soon after the flag was set.
SmoothedVolume smoothVolume(const VolumeHandle& volume, const SmoothingRequest& request,
                            Modality modality, const StageStop& stop);

/// Removes islands of opacity that are smaller than TransferChoice::islands, which must be set,
/// except those with a voxel in the focus.
SmoothedVolume dropIslands(const VolumeHandle& volume, const Handle<TransferChoice>& transfer,
                           const FocusHandle& focus);

/// Greatest scalar up to which the medium is transparent; nullopt: it begins opaque.
std::optional<double> findOnset(const TransferFunction& transfer);

/// One line for headers and comments of images, such as "smoothed by non-local means: ..." or "not
/// smoothed".
std::string describe(const SmoothingReport& report);

} // namespace fenestra::core
