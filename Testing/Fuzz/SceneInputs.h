#pragma once
// Loads a Slicer scene as a render does, with and without a focus.

#include "Harness.h"

#include "session/SceneInput.h"

namespace fenestra::fuzzing {

inline void loadScene(const std::filesystem::path& path) {
  SceneRequest request;
  request.input = path;
  const Volume volume = loadVolume(request).volume;
  const SceneSettings settings = loadSettings(request, volume);
  if (!volume.grid.indexToWorld.allFinite() ||
      (settings.crop && !settings.crop->worldToBox.allFinite()))
    throw std::logic_error("a place that is none");
  request.focus = {"A"};
  loadFocus(request, volume.grid);
}

} // namespace fenestra::fuzzing
