// Lights (.json).
#include "Harness.h"

#include "files/appearance/LightReader.h"

FENESTRA_FUZZ(Lights, input) {
  fenestra::core::parseLights(input, "lights.json");
}
