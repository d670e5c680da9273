#pragma once
// JSON from untrusted files; every error names its place.

#include "base/Error.h"
#include "base/Vector.h"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fenestra {

/// Largest text file, bytes, but for Slicer's scenes. Parsed JSON takes some 25 times as many.
inline constexpr std::uint64_t maxTextBytes = std::uint64_t{4} << 20;

/// The content of a text file. Throws Error (input) where it cannot be read or exceeds `most`
/// bytes.
std::string readText(const std::filesystem::path& path, std::uint64_t maxBytes = maxTextBytes);

/// Most values and keys of a JSON text.
inline constexpr int maxJsonNodes = 200'000;

/// Parses one JSON value. Throws Error (input) for other text, for nesting deeper than 64, and for
/// more than `maxNodes` values and keys.
nlohmann::json parseJson(std::string_view text, const std::string& source,
                         int maxNodes = maxJsonNodes);

/// JSON as a file's content, or a line with `indent` -1; bytes that are not UTF-8 are replaced.
std::string dumpJson(const nlohmann::ordered_json& json, int indent = 2);

/// View of a JSON value, with its place in the document, like "lights[2].radiance". The document
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
  /// Index of the text among `words`, at least two.
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

  /// Member of an object. Missing key: find returns nullopt, at throws Error (input).
  std::optional<JsonNode> find(const std::string& key) const;
  JsonNode at(const std::string& key) const;
  /// Keys and values, in the keys' order.
  std::vector<std::pair<std::string, JsonNode>> members() const;
  void allowOnly(std::initializer_list<std::string_view> keys) const;

  /// Value as JSON text, on one line.
  std::string json() const;

  /// Error (input) that names the file and the place, then says `mend`.
  Error error(const std::string& hint) const;

private:
  JsonNode(const nlohmann::json& value, std::string source, std::string place)
      : m_value(&value), m_source(std::move(source)), m_path(std::move(place)) {}

  /// Returns the value. Throws Error (input) unless `isRight`.
  const nlohmann::json& require(bool isValid, const char* hint) const;
  const nlohmann::json& object() const;
  std::string memberPath(const std::string& key) const {
    return m_path.empty() ? key : m_path + "." + key;
  }

  const nlohmann::json* m_value;
  std::string m_source, m_path;
};

} // namespace fenestra
