#pragma once
// Loads a Slicer scene as a render does, with and without a focus.

#include "Approx.h"
#include "Harness.h"

#include "session/SceneInput.h"

namespace fenestra::fuzzing {

inline void loadScene(const std::filesystem::path& path) {
  SceneRequest request;
  request.input = path;
  const Volume volume = loadVolume(request).volume;
  const SceneSettings settings = loadSettings(request, volume);
  if (!allFinite(volume.grid.indexToWorld) ||
      (settings.crop && !allFinite(settings.crop->worldToBox)))
    throw std::logic_error("a place that is none");
  request.focus = {"A"};
  loadFocus(request, volume.grid);
}

} // namespace fenestra::fuzzing
