#pragma once
// Loads a Slicer scene as a render does, with and without a focus.

#include "Approx.h"
#include "Harness.h"

#include "scene/Input.h"

namespace fenestra::core::fuzzing {

inline void loadScene(const std::filesystem::path& path) {
  const Input input(path);
  const Volume volume = input.volume({})->volume;
  const SceneSettings settings = input.settings({}, true); // including the camera
  input.transfer({}, {volume.minimum, volume.maximum});
  if (!allFinite(volume.grid.indexToWorld) ||
      (settings.crop && !allFinite(settings.crop->worldToBox)))
    throw std::logic_error("a transform is not finite");
  input.segments({}, volume.grid)->segmentation.makeFocusMask({"A"}, volume.grid);
}

} // namespace fenestra::core::fuzzing
