// Slicer scenes (.mrml), beside the files that a scene may name.
#include "SceneFixtures.h"
#include "SceneInputs.h"

FENESTRA_FUZZ(PreparedScene, input) {
  using namespace fenestra;
  fuzzing::writeSceneFixtures();
  fuzzing::loadScene(fuzzing::writeInput(input, "scene.mrml"));
}
