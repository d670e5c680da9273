// Slicer scenes (.mrml), in a folder with files that they can reference.
#include "SceneFixtures.h"
#include "SceneInputs.h"

FENESTRA_FUZZ(Scene, input) {
  using namespace fenestra::core;
  fuzzing::writeSceneFixtures();
  fuzzing::loadScene(fuzzing::writeInput(input, "scene.mrml"));
}
