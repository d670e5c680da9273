#pragma once
// JSON from untrusted files, read so that every complaint names its place. For io's own sources.

#include "base/Error.h"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fenestra {

/// Bytes of a text file of ours, or of Slicer's but for its scenes: parsed, it takes some 25 times
/// as many.
inline constexpr std::uint64_t largestText = std::uint64_t{4} << 20;

/// The content of a text file. Throws Error (input) where it cannot be read or exceeds `most`
/// bytes.
std::string readText(const std::filesystem::path& path, std::uint64_t most = largestText);

/// Values and keys in such a file.
inline constexpr int mostJsonParts = 200'000;

/// Throws Error (input) for anything but one JSON value nested at most 64 deep, and for more than
/// `mostParts` values and keys in it.
nlohmann::json parseJson(std::string_view text, const std::string& source,
                         int mostParts = mostJsonParts);

/// A value and where it is, like "lights[2].radiance". A view: the document outlives it. Every
/// accessor throws Error (input) where the value is not what it asks for.
class JsonNode {
public:
  JsonNode(const nlohmann::json& document, std::string source)
      : JsonNode(document, std::move(source), "") {}

  bool isNumber() const { return m_value->is_number(); }
  bool isArray() const { return m_value->is_array(); }
  bool isObject() const { return m_value->is_object(); }
  bool boolean() const;
  std::string text() const;
  double number() const;
  double numberIn(double low, double high) const;
  /// An array of exactly `count` numbers from low to high.
  std::vector<double> numbers(std::size_t count, double low, double high) const;

  /// Of an array.
  std::vector<JsonNode> elements() const;

  /// Of an object.
  std::optional<JsonNode> find(const std::string& key) const;
  JsonNode at(const std::string& key) const;
  /// Keys and values, in the keys' order.
  std::vector<std::pair<std::string, JsonNode>> members() const;
  void allowOnly(std::initializer_list<std::string_view> keys) const;

  /// The value as JSON again, on one line.
  std::string json() const;

  /// Names the file and the place.
  Error error(const std::string& mend) const;

private:
  JsonNode(const nlohmann::json& value, std::string source, std::string place)
      : m_value(&value), m_source(std::move(source)), m_place(std::move(place)) {}

  const nlohmann::json* m_value;
  std::string m_source, m_place;
};

} // namespace fenestra
