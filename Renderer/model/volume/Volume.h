#pragma once
// The scalar volume: voxels in their storage type (model/volume/Field.h: the field between them).
// Voxels are never converted: code that reads them is a template on their type, and
// integrator/render/Render.h dispatches on it once.

#include "base/Error.h"
#include "base/LargePages.h"
#include "model/volume/Grid.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace fenestra::core {

/// Kind of scan. CT scalars are Hounsfield units, those of PET standardized uptake values (SUV,
/// g/ml) if the file allows it; MR and ultrasound have no standard unit.
enum class Modality { ct, mr, us, pt };

/// Storage types, x fastest. Readers convert every file type to the smallest of these that holds
/// all its values (64-bit and double values that do not fit are rounded to float).
using Voxels = std::variant<LargeArray<std::uint8_t>, LargeArray<std::int16_t>,
                            LargeArray<std::uint16_t>, LargeArray<float>>;

/// Every voxel is finite: readers replace NaN and -infinity by the volume's smallest finite value,
/// and +infinity by its largest, and add a warning.
struct Volume {
  Grid grid;
  Voxels voxels;
  double minimum = 0.0; ///< smallest voxel value
  double maximum = 0.0;
  std::string name; ///< file name, for messages
  std::vector<Message> warnings;
  std::optional<Modality> modality = {}; ///< stated by the file; empty: not stated, or another one
  bool hasContrastAgent = false;         ///< the file states a contrast agent
  std::size_t frameCount = 1;            ///< of the input; the volume is one of them
};

/// Computes minimum and maximum from the voxels.
inline void computeRange(Volume& volume) {
  const auto compute = [&volume](const auto& voxels) {
    if (voxels.empty())
      return;
    const auto [low, high] = std::ranges::minmax(voxels);
    volume.minimum = static_cast<double>(low);
    volume.maximum = static_cast<double>(high);
  };
  std::visit(compute, volume.voxels);
}

} // namespace fenestra::core
