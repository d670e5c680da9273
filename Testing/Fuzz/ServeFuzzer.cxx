// One line of a server's input. Only looks are read, and nothing is written.
#include "Harness.h"

#include "io/JsonNode.h"
#include "program/ServeInput.h"

FENESTRA_FUZZ(Serve, input) {
  using namespace fenestra;
  OptionValues flags(renderSyntax.flags);
  flags.add("INPUT", "volume.nrrd");
  const nlohmann::json change = parseJson(input, "a line");
  idOf(change);
  checkChange(change, applyChange(change, flags), Input("volume.nrrd"));
}
