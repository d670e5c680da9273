#include "program/SlicerModule.h"

#include "base/TextStream.h"
#include "program/Version.h"

#include <pugixml.hpp>

namespace fenestra {
namespace {

void addText(pugi::xml_node parent, const char* name, const std::string& text) {
  parent.append_child(name).text().set(text.c_str());
}

/// Label: the flag's own name, so that a panel's field can be matched to a flag.
std::string labelOf(const std::string& name) {
  std::string label = name;
  label[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(label[0])));
  return label;
}

pugi::xml_node addParameters(pugi::xml_node module, const char* label, const char* description) {
  pugi::xml_node group = module.append_child("parameters");
  addText(group, "label", label);
  addText(group, "description", description);
  return group;
}

/// Slicer's type of a flag. Slicer always passes numbers and words, so such flags need a default.
const char* typeOf(const Flag& flag) {
  const bool optional = *flag.standard == 0;
  switch (flag.takes.kind) {
  case Takes::Kind::labels:
  case Takes::Kind::picture:
    return "image";
  case Takes::Kind::surface:
  case Takes::Kind::report:
    return "file";
  case Takes::Kind::list:
    return "string-vector";
  case Takes::Kind::numbers:
    return "double-vector";
  case Takes::Kind::number:
    return optional ? "string" : "double";
  case Takes::Kind::whole:
    return optional ? "string" : "integer";
  case Takes::Kind::word:
    return optional ? "string" : "string-enumeration";
  case Takes::Kind::text:
  case Takes::Kind::slicersOwn:
    break;
  }
  return "string";
}

/// Adds a slider if the range is narrow enough to set by hand.
void addConstraints(pugi::xml_node parameter, const Flag& flag, const std::string& type) {
  constexpr double widest = 1e6;
  const bool whole = type == "integer";
  const auto [kind, least, greatest, words] = flag.takes;
  if ((!whole && type != "double") || greatest - least > widest)
    return;
  pugi::xml_node constraints = parameter.append_child("constraints");
  addText(constraints, "minimum", shortNumber(least));
  addText(constraints, "maximum", shortNumber(greatest));
  addText(constraints, "step", whole ? "1" : "0.01");
}

void addFlag(pugi::xml_node group, const Flag& flag) {
  const std::string type = typeOf(flag);
  pugi::xml_node parameter = group.append_child(type.c_str());
  if (flag.takes.kind == Takes::Kind::labels)
    parameter.append_attribute("type") = "label";
  if (flag.takes.kind == Takes::Kind::picture) {
    parameter.append_attribute("type") = "vector";
    parameter.append_attribute("fileExtensions") = ".nrrd";
  }
  if (flag.takes.kind == Takes::Kind::surface)
    parameter.append_attribute("fileExtensions") = ".vtp,.ply,.stl";
  if (flag.takes.kind == Takes::Kind::report)
    parameter.append_attribute("fileExtensions") = ".json";
  addText(parameter, "name", flag.name);
  addText(parameter, "longflag", flag.name);
  addText(parameter, "label", labelOf(flag.name));
  addText(parameter, "description", flag.text);
  if (flag.takes.kind == Takes::Kind::labels)
    addText(parameter, "channel", "input");
  if (isWritten(flag))
    addText(parameter, "channel", "output");
  if (*flag.standard != 0)
    addText(parameter, "default", flag.standard);
  addConstraints(parameter, flag, type);
  if (type == "string-enumeration")
    for (const std::string& word : splitAt(flag.takes.words, '|'))
      addText(parameter, "element", word);
}

void addInput(pugi::xml_node group, const Positional& input) {
  pugi::xml_node image = group.append_child("image");
  image.append_attribute("type") = "scalar";
  addText(image, "name", "inputVolume");
  addText(image, "label", "Volume");
  addText(image, "description", input.text);
  addText(image, "channel", "input");
  addText(image, "index", "0");
}

void addReturnValues(pugi::xml_node module) {
  pugi::xml_node group = addParameters(module, "Reached", "What the render reached");
  for (const ReturnValue& value : returnValues) {
    pugi::xml_node parameter = group.append_child(value.type);
    addText(parameter, "name", value.name);
    addText(parameter, "label", labelOf(value.name));
    addText(parameter, "description", value.text);
    addText(parameter, "channel", "output");
  }
}

} // namespace

std::string slicerDescription(const CommandSyntax& syntax) {
  pugi::xml_document document;
  pugi::xml_node declaration = document.append_child(pugi::node_declaration);
  declaration.append_attribute("version") = "1.0";
  declaration.append_attribute("encoding") = "utf-8";
  pugi::xml_node module = document.append_child("executable");
  addText(module, "category", "Rendering");
  addText(module, "title", "Fenestra (command line)");
  addText(module, "description", syntax.summary);
  addText(module, "version", versionText);
  addText(module, "contributor", "The Fenestra developers");
  std::string groupName;
  pugi::xml_node group;
  for (const Flag& flag : syntax.flags) {
    if (flag.takes.kind == Takes::Kind::slicersOwn)
      continue;
    if (flag.group != groupName) {
      const bool first = groupName.empty();
      groupName = flag.group;
      group = addParameters(module, flag.group, flag.group);
      if (first)
        addInput(group, syntax.positionals.front());
    }
    addFlag(group, flag);
  }
  addReturnValues(module);
  TextWriter text;
  document.save(text, "  ");
  return text.str();
}

std::string returnValuesText(const std::vector<double>& values) {
  TextWriter lines;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (std::isfinite(values[i]))
      lines << returnValues[i].name << " = " << values[i] << '\n';
  return lines.str();
}

} // namespace fenestra
