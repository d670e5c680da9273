// Label name tables; the first byte selects the format.
#include "Harness.h"

#include "files/segments/LabelNames.h"

FENESTRA_FUZZ(Labels, input) {
  using namespace fenestra::core;
  const std::string name = fuzzing::chooseName(
      input, std::array{"a.ctbl", "a.label", "a.json", "a.csv", "xml", "a.tsv", "a.txt"});
  const auto names = name == "xml"
                         ? parseLabelNamesXml(input, name)
                         : std::optional(readLabelNames(fuzzing::writeInput(input, name)));
  if (names && (names->empty() || names->contains(0)))
    throw std::logic_error("the table has no names, or names the background");
}
