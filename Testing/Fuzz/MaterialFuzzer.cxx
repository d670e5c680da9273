// Materials (.json), or, if the input has no brace, a change of one segment.
#include "Harness.h"

#include "files/appearance/MaterialReader.h"

FENESTRA_FUZZ(Materials, input) {
  static const fenestra::core::MaterialTable base = fenestra::core::parseMaterials(
      R"({"version": 1, "materials": {"fog": {"albedo": [1, 1, 1], "g": -0.5}}})", "beneath");
  if (input.find('{') != input.npos)
    fenestra::core::parseMaterials(input, "materials.json", base);
  else
    fenestra::core::parseMaterialChange(std::string(input), base);
}
