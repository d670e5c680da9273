// Lights.
#include "Harness.h"

#include "io/looks/LightReader.h"

FENESTRA_FUZZ(Lights, input) {
  fenestra::parseLights(input, "lights.json");
}
