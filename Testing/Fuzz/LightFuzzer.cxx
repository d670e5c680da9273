// Lights.
#include "Harness.h"

#include "files/looks/LightReader.h"

FENESTRA_FUZZ(Lights, input) {
  fenestra::parseLights(input, "lights.json");
}
