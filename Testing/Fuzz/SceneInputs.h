#pragma once
// Loads a Slicer scene as a render does, with a focus and without.

#include "Harness.h"

#include "scene/SceneInput.h"

namespace fenestra::fuzzing {

inline void loadScene(const std::filesystem::path& path) {
  SceneRequest request;
  request.input = path;
  const SceneInput input = loadInput(request);
  if (!input.volume.grid.indexToWorld.matrix().allFinite() ||
      (input.crop && !input.crop->worldToBox.matrix().allFinite()))
    throw std::logic_error("a place that is none");
  request.focus = {"A"};
  loadInput(request);
}

} // namespace fenestra::fuzzing
