#include "program/SlicerModule.h"

#include "base/TextStream.h"
#include "program/about/Version.h"

#include <pugixml.hpp>

namespace fenestra::core {
namespace {

void addText(pugi::xml_node parent, const char* name, const std::string& text) {
  parent.append_child(name).text().set(text.c_str());
}

/// Label of a panel's field: the option's name, so that users can match them.
std::string makeLabel(const std::string& name) {
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

/// Slicer's type of an option. Slicer always passes numbers and enumerations, so without a default
/// they become texts.
std::string findSlicerType(const ValueSpec& spec) {
  const bool isPassed = spec.least > -infinity || !spec.choices.empty();
  return isPassed && spec.defaultValue.empty() ? "string" : spec.type;
}

/// Adds a slider if the range is narrow enough for one.
void addConstraints(pugi::xml_node parameter, const ValueSpec& spec) {
  constexpr double widest = 1e6;
  if (findSlicerType(spec) == "string" || spec.defaultValue.empty() ||
      spec.greatest - spec.least > widest)
    return;
  pugi::xml_node constraints = parameter.append_child("constraints");
  addText(constraints, "minimum", toString(spec.least));
  addText(constraints, "maximum", toString(spec.greatest));
  addText(constraints, "step", spec.type == "integer" ? "1" : "0.01");
}

void addOption(pugi::xml_node group, const Option& option) {
  const ValueSpec& spec = option.spec;
  pugi::xml_node parameter = group.append_child(findSlicerType(spec).c_str());
  if (!spec.image.empty())
    parameter.append_attribute("type") = spec.image.c_str();
  if (!spec.extensions.empty())
    parameter.append_attribute("fileExtensions") = spec.extensions.c_str();
  addText(parameter, "name", option.oneWord);
  addText(parameter, "longflag", option.oneWord);
  addText(parameter, "label", makeLabel(option.oneWord));
  addText(parameter, "description", option.help());
  if (!spec.channel.empty())
    addText(parameter, "channel", spec.channel);
  if (!spec.defaultValue.empty())
    addText(parameter, "default", spec.defaultValue);
  addConstraints(parameter, spec);
  if (findSlicerType(spec) == spec.type)
    for (const std::string& word : spec.choices)
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
  pugi::xml_node group = addParameters(module, "Results", "Measured values of the render");
  for (const ReturnValue& value : returnValues) {
    pugi::xml_node parameter = group.append_child("double");
    addText(parameter, "name", value.name);
    addText(parameter, "label", makeLabel(value.name));
    addText(parameter, "description", value.description);
    addText(parameter, "channel", "output");
  }
}

} // namespace

std::string makeSlicerXml(const CommandSyntax& syntax) {
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
  for (const Option& option : syntax.options) {
    if (option.spec.type.empty())
      continue;
    if (option.group != groupName) {
      const bool first = groupName.empty();
      groupName = option.group;
      group = addParameters(module, option.group, option.group);
      if (first)
        addInput(group, syntax.positionals.front());
    }
    addOption(group, option);
  }
  addReturnValues(module);
  TextWriter text;
  document.save(text, "  ");
  return text.str();
}

std::string formatReturnValues(const std::vector<double>& values) {
  std::string lines;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (std::isfinite(values[i]))
      lines += concat(returnValues[i].name, " = ", toString(values[i]), "\n");
  return lines;
}

} // namespace fenestra::core
