// Lights.
#include "Harness.h"

#include "io/LightReader.h"

FENESTRA_FUZZ(input) {
  fenestra::parseLights(input, "lights.json");
}
