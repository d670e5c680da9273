#pragma once

#include "fenestra/Error.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace fenestra {
inline namespace v1 {

/// Kind of scan. Samples of CT are Hounsfield units, those of PET standardized uptake values.
enum class Modality { unknown, ct, mr, ultrasound, pet };

struct VolumeDescription {
  std::string name = "volume"; ///< in messages
  Modality modality = Modality::unknown;
  bool hasContrastAgent = false;
};

/// Scalar volume in memory. Immutable; copies share the voxels.
class FENESTRA_EXPORT Volume {
public:
  /// Copies the samples, once, into the smallest of uint8, int16, uint16 and float that holds all
  /// of them: 64-bit and double samples that do not fit are rounded to float. NaN and -infinity
  /// become the smallest finite sample, +infinity the largest, with a warning. Throws Error (input)
  /// for a size below 1, a singular affine, or no finite sample.
  Volume(const Samples& samples, const Affine& indexToWorld,
         const VolumeDescription& description = {});

  std::array<std::int64_t, 3> size() const;
  Affine indexToWorld() const;
  /// Smallest and largest sample.
  std::array<double, 2> range() const;
  const std::string& name() const;
  Modality modality() const;
  std::vector<Warning> warnings() const;

  struct Data;
  explicit Volume(std::shared_ptr<const Data> data);
  const std::shared_ptr<const Data>& data() const { return m_data; }

private:
  std::shared_ptr<const Data> m_data;
};

/// Which part of an input is read, and how.
struct ReadOptions {
  std::optional<std::string> volume = {}; ///< of several: node of a scene, or series of a folder
  std::optional<std::size_t> frame = {}; ///< of several, from 0; nullopt: the first, with a warning
  std::optional<Vector3> spacing = {};   ///< mm, of files that state none
  /// Formats whose libraries crash on damaged files (DICOM, PNG, TIFF, HDF5) are read in a process
  /// of their own, the program fenestra-reader beside this library. True: in this process.
  bool isInProcess = false;
};

/// Reads a volume file (NRRD, NIfTI, MetaImage, FreeSurfer, VTK), or a folder of DICOM files or of
/// PNG or TIFF slices. Throws Error.
FENESTRA_EXPORT Volume readVolume(const std::string& path, const ReadOptions& options = {});

} // namespace v1
} // namespace fenestra
