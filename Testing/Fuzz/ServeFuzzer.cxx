// One input line of `fenestra serve`. Reads only files that define the appearance; writes nothing.
#include "Harness.h"

#include "io/JsonNode.h"
#include "program/ServeInput.h"

FENESTRA_FUZZ(Serve, input) {
  using namespace fenestra::core;
  OptionValues values(renderSyntax.options);
  values.add("INPUT", "volume.nrrd");
  const nlohmann::json change = parseJson(input, "a line");
  readId(change);
  checkChange(change, applyChange(change, values), Input("volume.nrrd"));
}
