// Lights (.json).
#include "Harness.h"

#include "files/appearance/LightReader.h"

FENESTRA_FUZZ(Lights, input) {
  fenestra::parseLights(input, "lights.json");
}
