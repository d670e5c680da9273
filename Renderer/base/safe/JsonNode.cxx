#include "base/safe/JsonNode.h"

#include "base/safe/Inputs.h"
#include "base/safe/ShownText.h"
#include "base/safe/SystemCalls.h"

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <span>

namespace fenestra {
namespace {

constexpr int deepest = 64;

std::string shortNumber(double x) {
  std::string text = nlohmann::json(x).dump();
  return text.ends_with(".0") ? text.substr(0, text.size() - 2) : text;
}

} // namespace

std::string readText(const std::filesystem::path& path, std::uint64_t most) {
  requireFile(path, "name a file in it", most);
  std::string text(static_cast<std::size_t>(std::filesystem::file_size(path)), '\0');
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file.read(text.data(), static_cast<std::streamsize>(text.size())))
    throw readError(path, errno, "check its permissions");
  return text;
}

nlohmann::json parseJson(std::string_view text, const std::string& source, int mostParts) {
  using Event = nlohmann::json::parse_event_t;
  int parts = 0;
  const auto count = [&](int depth, Event event, const nlohmann::json&) {
    const bool opens = event == Event::object_start || event == Event::array_start;
    if (opens && depth >= deepest)
      throw inputError(source, "is nested deeper than ", deepest,
                       " levels; Fenestra writes no such file");
    if ((opens || event == Event::key || event == Event::value) && ++parts > mostParts)
      throw inputError(source, "holds more than ", mostParts,
                       " values; Fenestra writes no such file");
    return true;
  };
  try {
    return nlohmann::json::parse(text, count);
  } catch (const nlohmann::json::parse_error& error) {
    throw inputError(source, "is not JSON at byte ", error.byte,
                     "; check its brackets, commas and quotes");
  } catch (const nlohmann::json::exception&) {
    throw inputError(source, "holds a number that is too large; write a smaller one");
  }
}

std::string jsonText(const nlohmann::ordered_json& json, int indent) {
  return json.dump(indent, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

Error JsonNode::error(const std::string& hint) const {
  return inputError(m_source, m_place.empty() ? hint : m_place + ": " + hint);
}

const nlohmann::json& JsonNode::checked(bool isRight, const char* hint) const {
  if (!isRight)
    throw error(hint);
  return *m_value;
}

const nlohmann::json& JsonNode::object() const {
  return checked(m_value->is_object(), "must be an object, {…}");
}

bool JsonNode::boolean() const {
  return checked(m_value->is_boolean(), "must be true or false").get<bool>();
}

std::string JsonNode::text() const {
  return checked(m_value->is_string(), "must be a string").get<std::string>();
}

std::size_t JsonNode::oneOf(const std::vector<std::string>& words) const {
  const auto found = std::find(words.begin(), words.end(), text());
  if (found != words.end())
    return static_cast<std::size_t>(found - words.begin());
  const auto quoted = [](const std::string& word) { return "\"" + word + "\""; };
  const std::span but(words.begin(), words.end() - 1);
  throw error("must be " + join(but, ", ", quoted) + " or " + quoted(words.back()));
}

double JsonNode::number() const {
  return checked(m_value->is_number(), "must be a number").get<double>();
}

double JsonNode::numberIn(double low, double high) const {
  const double x = number();
  if (!(x >= low && x <= high))
    throw error("is " + shortNumber(x) + "; it must be from " + shortNumber(low) + " to " +
                shortNumber(high));
  return x;
}

std::vector<double> JsonNode::numbers(std::size_t count, double low, double high) const {
  if (m_value->is_array() && m_value->size() != count)
    throw error(concat("must have ", count, " numbers, not ", m_value->size()));
  std::vector<double> result;
  for (const JsonNode& node : elements())
    result.push_back(node.numberIn(low, high));
  return result;
}

std::vector<JsonNode> JsonNode::elements() const {
  std::vector<JsonNode> nodes;
  for (const nlohmann::json& value : checked(m_value->is_array(), "must be an array"))
    nodes.push_back({value, m_source, concat(m_place, '[', nodes.size(), ']')});
  return nodes;
}

std::optional<JsonNode> JsonNode::find(const std::string& key) const {
  const auto it = object().find(key);
  if (it == m_value->end())
    return std::nullopt;
  return JsonNode(*it, m_source, placeOf(key));
}

JsonNode JsonNode::at(const std::string& key) const {
  const auto node = find(key);
  if (!node)
    throw error("has no \"" + key + "\"; add it");
  return *node;
}

std::vector<std::pair<std::string, JsonNode>> JsonNode::members() const {
  std::vector<std::pair<std::string, JsonNode>> nodes;
  for (const auto& [key, value] : object().items())
    nodes.emplace_back(key, JsonNode(value, m_source, placeOf(shown(key))));
  return nodes;
}

std::string JsonNode::json() const {
  return m_value->dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

void JsonNode::allowOnly(std::initializer_list<std::string_view> keys) const {
  for (const auto& [key, value] : object().items())
    if (std::find(keys.begin(), keys.end(), key) == keys.end()) {
      const std::string shown =
          nlohmann::json(key).dump(-1, ' ', true); // one line, whatever the key holds
      throw error("unknown key " + shown.substr(0, 80) + "; known ones are " + join(keys, ", "));
    }
}

} // namespace fenestra
