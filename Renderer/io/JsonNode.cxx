#include "io/JsonNode.h"

#include "io/InputRegistry.h"
#include "io/MessageText.h"
#include "io/platform/SystemErrors.h"

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <span>

namespace fenestra::core {
namespace {

constexpr int maxDepth = 64;

std::string formatNumber(double x) {
  std::string text = nlohmann::json(x).dump();
  return text.ends_with(".0") ? text.substr(0, text.size() - 2) : text;
}

} // namespace

std::string readText(const std::filesystem::path& path, std::uint64_t maxBytes) {
  requireFile(path, "name a file in it", maxBytes);
  std::string text(static_cast<std::size_t>(std::filesystem::file_size(path)), '\0');
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file.read(text.data(), static_cast<std::streamsize>(text.size())))
    throw readError(path, errno, "check its permissions");
  return text;
}

nlohmann::json parseJson(std::string_view text, const std::string& source, int maxNodes) {
  using Event = nlohmann::json::parse_event_t;
  int nodes = 0;
  const auto count = [&](int depth, Event event, const nlohmann::json&) {
    const bool isContainer = event == Event::object_start || event == Event::array_start;
    if (isContainer && depth >= maxDepth)
      throw inputError(ErrorCode::limitExceeded, source, "is nested deeper than ", maxDepth,
                       " levels; simplify it");
    if ((isContainer || event == Event::key || event == Event::value) && ++nodes > maxNodes)
      throw inputError(ErrorCode::limitExceeded, source, "contains more than ", maxNodes,
                       " values and keys; use a smaller file");
    return true;
  };
  try {
    return nlohmann::json::parse(text, count);
  } catch (const nlohmann::json::parse_error& error) {
    throw inputError(ErrorCode::damagedFile, source, "is not valid JSON at byte ", error.byte,
                     "; check its brackets, commas and quotes");
  } catch (const nlohmann::json::exception&) {
    throw inputError(ErrorCode::limitExceeded, source,
                     "contains a number that is too large; use a smaller one");
  }
}

std::string dumpJson(const nlohmann::ordered_json& json, int indent) {
  return json.dump(indent, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

Error JsonNode::error(const std::string& hint) const {
  return m_path.empty() ? inputError(m_source, hint) : fieldError(m_source, m_path, hint);
}

const nlohmann::json& JsonNode::require(bool isValid, const char* hint) const {
  if (!isValid)
    throw error(hint);
  return *m_value;
}

const nlohmann::json& JsonNode::object() const {
  return require(m_value->is_object(), "must be an object, {…}");
}

bool JsonNode::boolean() const {
  return require(m_value->is_boolean(), "must be true or false").get<bool>();
}

std::string JsonNode::text() const {
  return require(m_value->is_string(), "must be a string").get<std::string>();
}

std::size_t JsonNode::choice(const std::vector<std::string>& words) const {
  const auto found = std::find(words.begin(), words.end(), text());
  if (found != words.end())
    return static_cast<std::size_t>(found - words.begin());
  const auto quoted = [](const std::string& word) { return "\"" + word + "\""; };
  const std::span allButLast(words.begin(), words.end() - 1);
  throw error("must be " + join(allButLast, ", ", quoted) + " or " + quoted(words.back()));
}

double JsonNode::number() const {
  return require(m_value->is_number(), "must be a number").get<double>();
}

double JsonNode::number(double low, double high) const {
  const double x = number();
  if (!(x >= low && x <= high))
    throw error("is " + formatNumber(x) + "; it must be from " + formatNumber(low) + " to " +
                formatNumber(high));
  return x;
}

std::vector<double> JsonNode::numbers(std::size_t count, double low, double high) const {
  if (m_value->is_array() && m_value->size() != count)
    throw error(concat("must have ", count, " numbers, not ", m_value->size()));
  std::vector<double> result;
  for (const JsonNode& node : elements())
    result.push_back(node.number(low, high));
  return result;
}

std::vector<JsonNode> JsonNode::elements() const {
  std::vector<JsonNode> nodes;
  for (const nlohmann::json& value : require(m_value->is_array(), "must be an array"))
    nodes.push_back({value, m_source, concat(m_path, '[', nodes.size(), ']')});
  return nodes;
}

std::optional<JsonNode> JsonNode::find(const std::string& key) const {
  const auto it = object().find(key);
  if (it == m_value->end())
    return std::nullopt;
  return JsonNode(*it, m_source, memberPath(key));
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
    nodes.emplace_back(key, JsonNode(value, m_source, memberPath(sanitize(key))));
  return nodes;
}

std::string JsonNode::json() const {
  return m_value->dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

void JsonNode::allowOnly(std::initializer_list<std::string_view> keys) const {
  for (const auto& [key, value] : object().items())
    if (std::find(keys.begin(), keys.end(), key) == keys.end()) {
      const std::string quotedKey = nlohmann::json(key).dump(-1, ' ', true); // any key on one line
      throw error("unknown key " + quotedKey.substr(0, 80) + "; known ones are " +
                  join(keys, ", "));
    }
}

} // namespace fenestra::core
