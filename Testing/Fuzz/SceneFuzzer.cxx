// Slicer scenes (.mrml), beside the files that a scene may name.
#include "SceneInputs.h"
#include "SceneNeighbours.h"

FENESTRA_FUZZ(PreparedScene, input) {
  using namespace fenestra;
  fuzzing::writeSceneNeighbours();
  fuzzing::loadScene(fuzzing::asFile(input, "scene.mrml"));
}
