#include "program/SlicerModule.h"

#include "base/TextStream.h"
#include "program/about/Version.h"

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

pugi::xml_node addParameters(pugi::xml_node module, const std::string& label,
                             const std::string& description) {
  pugi::xml_node group = module.append_child("parameters");
  addText(group, "label", label);
  addText(group, "description", description);
  return group;
}

/// Slicer's type of a flag. Slicer always passes numbers and words, so that such a flag without a
/// default is a text.
std::string typeOf(const ValueSpec& takes) {
  const bool isPassed = takes.least > -infinity || !takes.choices.empty();
  return isPassed && takes.defaultValue.empty() ? "string" : takes.type;
}

/// Adds a slider if the range is narrow enough to set by hand.
void addConstraints(pugi::xml_node parameter, const ValueSpec& takes) {
  constexpr double widest = 1e6;
  if (typeOf(takes) == "string" || takes.defaultValue.empty() ||
      takes.greatest - takes.least > widest)
    return;
  pugi::xml_node constraints = parameter.append_child("constraints");
  addText(constraints, "minimum", toString(takes.least));
  addText(constraints, "maximum", toString(takes.greatest));
  addText(constraints, "step", takes.type == "integer" ? "1" : "0.01");
}

void addFlag(pugi::xml_node group, const Option& flag) {
  const ValueSpec& takes = flag.spec;
  pugi::xml_node parameter = group.append_child(typeOf(takes).c_str());
  if (!takes.image.empty())
    parameter.append_attribute("type") = takes.image.c_str();
  if (!takes.extensions.empty())
    parameter.append_attribute("fileExtensions") = takes.extensions.c_str();
  addText(parameter, "name", flag.name);
  addText(parameter, "longflag", flag.name);
  addText(parameter, "label", labelOf(flag.name));
  addText(parameter, "description", flag.help());
  if (!takes.channel.empty())
    addText(parameter, "channel", takes.channel);
  if (!takes.defaultValue.empty())
    addText(parameter, "default", takes.defaultValue);
  addConstraints(parameter, takes);
  for (const std::string& word : takes.choices)
    addText(parameter, "element", word);
}

void addInput(pugi::xml_node group, const Positional& input) {
  pugi::xml_node image = group.append_child("image");
  image.append_attribute("type") = "scalar";
  addText(image, "name", "inputVolume");
  addText(image, "label", "Volume");
  addText(image, "description", input.description);
  addText(image, "channel", "input");
  addText(image, "index", "0");
}

void addReturnValues(pugi::xml_node module) {
  pugi::xml_node group = addParameters(module, "Reached", "What the render reached");
  for (const ReturnValue& value : returnValues) {
    pugi::xml_node parameter = group.append_child("double");
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
  for (const Option& flag : syntax.options) {
    if (flag.spec.type.empty())
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
  std::string lines;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (std::isfinite(values[i]))
      lines += concat(returnValues[i].name, " = ", toString(values[i]), "\n");
  return lines;
}

} // namespace fenestra
