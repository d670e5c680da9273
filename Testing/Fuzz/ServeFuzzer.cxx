// One line of a server's input. Only looks are read, and nothing is written.
#include "Harness.h"

#include "program/ServeInput.h"

FENESTRA_FUZZ(Serve, input) {
  using namespace fenestra;
  FlagValues flags(renderSyntax.flags);
  flags.add("INPUT", "volume.nrrd");
  nlohmann::json id;
  const nlohmann::json change = parseChange(std::string(input), id).flags;
  checkChange(change, changedFlags(change, flags), Input("volume.nrrd"));
}
