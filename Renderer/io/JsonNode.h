#pragma once
// JSON from untrusted files. Every error states its path in the document.

#include "base/Error.h"
#include "base/Vector.h"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fenestra::core {

/// Size limit of text files except Slicer's scenes, bytes. Parsed JSON takes about 25 times that.
inline constexpr std::uint64_t maxTextBytes = std::uint64_t{4} << 20;

/// Content of a text file. Throws Error (input) if it cannot be read or exceeds `maxBytes` bytes.
std::string readText(const std::filesystem::path& path, std::uint64_t maxBytes = maxTextBytes);

/// Limit of the number of values and keys of a JSON text.
inline constexpr int maxJsonNodes = 200'000;

/// Parses one JSON value. Throws Error (input) for invalid text, nesting deeper than 64, and more
/// than `maxNodes` values and keys.
nlohmann::json parseJson(std::string_view text, const std::string& source,
                         int maxNodes = maxJsonNodes);

/// JSON as the content of a file, or as one line if `indent` is -1; replaces invalid UTF-8.
std::string dumpJson(const nlohmann::ordered_json& json, int indent = 2);

/// View of a JSON value and its path in the document, such as "lights[2].radiance". The document
/// must outlive the view. Accessors throw Error (input) for a value of another type or range.
class JsonNode {
public:
  JsonNode(const nlohmann::json& document, std::string source)
      : JsonNode(document, std::move(source), "") {}

  const nlohmann::json& value() const { return *m_value; }
  bool isNumber() const { return m_value->is_number(); }
  bool isArray() const { return m_value->is_array(); }
  bool isObject() const { return m_value->is_object(); }
  bool boolean() const;
  std::string text() const;
  /// Index of the text in `words`, which has at least two elements.
  std::size_t choice(const std::vector<std::string>& words) const;
  double number() const;
  double number(double low, double high) const;
  /// An array of exactly `count` numbers from low to high.
  std::vector<double> numbers(std::size_t count, double low, double high) const;
  Vec3 triple(double low, double high) const {
    const auto v = numbers(3, low, high);
    return {v[0], v[1], v[2]};
  }

  /// Elements of an array.
  std::vector<JsonNode> elements() const;

  /// Member of an object. If the key is missing, find returns nullopt and at throws Error (input).
  std::optional<JsonNode> find(const std::string& key) const;
  JsonNode at(const std::string& key) const;
  /// Keys and values, in the keys' order.
  std::vector<std::pair<std::string, JsonNode>> members() const;
  void allowOnly(std::initializer_list<std::string_view> keys) const;

  /// Value as JSON text, on one line.
  std::string json() const;

  /// Error (input) that names the file and the path, then `hint`.
  Error error(const std::string& hint) const;

private:
  JsonNode(const nlohmann::json& value, std::string source, std::string path)
      : m_value(&value), m_source(std::move(source)), m_path(std::move(path)) {}

  /// Returns the value. Throws Error (input) unless `isValid`.
  const nlohmann::json& require(bool isValid, const char* hint) const;
  const nlohmann::json& object() const;
  std::string memberPath(const std::string& key) const {
    return m_path.empty() ? key : m_path + "." + key;
  }

  const nlohmann::json* m_value;
  std::string m_source, m_path;
};

} // namespace fenestra::core
