// Slicer scenes (.mrml), beside files that they may name.
#include "SceneInputs.h"
#include "SceneNeighbours.h"

namespace {

bool writeNeighbours() {
  for (const auto& [name, content] : fenestra::fuzzing::sceneNeighbours())
    fenestra::fuzzing::asFile(content, name);
  return true;
}

} // namespace

FENESTRA_FUZZ(input) {
  static const bool written = writeNeighbours();
  if (written)
    fenestra::fuzzing::loadScene(fenestra::fuzzing::asFile(input, "scene.mrml"));
}
