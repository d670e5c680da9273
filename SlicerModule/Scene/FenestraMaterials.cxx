#include "FenestraMaterials.h"

#include "FenestraFlags.h"

#include <algorithm>
#include <sstream>

namespace SlicerExport {
namespace {

std::string trim(const std::string& text) {
  constexpr const char* blanks = " \t\r\n";
  const std::size_t first = text.find_first_not_of(blanks);
  return first == std::string::npos ? std::string()
                                    : text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

} // namespace

std::string MaterialChange::field(const std::string& key) const {
  const auto found = fields.find(key);
  return found == fields.end() ? std::string() : found->second;
}

void MaterialChange::set(const std::string& key, const std::string& value) {
  if (value.empty())
    fields.erase(key);
  else
    fields[key] = value;
}

MaterialChange parseMaterialChange(const std::string& text) {
  const std::size_t colon = text.rfind(':');
  MaterialChange change;
  if (colon == std::string::npos)
    return change;
  change.segment = trim(text.substr(0, colon));
  std::istringstream fields(text.substr(colon + 1));
  for (std::string field; std::getline(fields, field, ',');)
    if (const std::size_t equals = field.find('='); equals != std::string::npos)
      change.set(trim(field.substr(0, equals)), trim(field.substr(equals + 1)));
  return change;
}

std::string toText(const MaterialChange& change) {
  std::string text = change.segment;
  const char* separator = ": ";
  for (const auto& [key, value] : change.fields) {
    text += separator + key + "=" + value;
    separator = ", ";
  }
  return text;
}

std::map<std::string, std::string> filterMaterialFlags(const std::vector<Segment>& segments,
                                                       std::map<std::string, std::string> flags) {
  const auto isListed = [&segments](const std::string& text) {
    const std::string selector = parseMaterialChange(text).segment;
    return std::any_of(segments.begin(), segments.end(), [&selector](const Segment& one) {
      return one.id == selector || one.name == selector || std::to_string(one.label) == selector;
    });
  };
  if (segments.empty())
    flags.erase("materials");
  const auto changes = flags.find("material");
  if (changes == flags.end())
    return flags;
  std::vector<std::string> remaining;
  for (const std::string& text : splitList(changes->second))
    if (isListed(text))
      remaining.push_back(text);
  changes->second = joinList(remaining);
  if (remaining.empty())
    flags.erase(changes);
  return flags;
}

} // namespace SlicerExport
