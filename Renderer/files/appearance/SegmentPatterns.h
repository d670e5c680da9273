#pragma once
// Patterns that match segments by name and terminology code, for presets and materials.

#include "io/JsonNode.h"

#include <string>
#include <vector>

namespace fenestra::core {

/// Pattern for names. A name matches if the pattern's words match consecutive words of the name,
/// case-insensitively. `*` stands for any text within a word, `?` for any character. Other
/// punctuation, and a capital after a small letter, separate words.
struct NamePattern {
  NamePattern(std::string text);
  NamePattern(const char* text) : NamePattern(std::string(text)) {}

  std::string text;
  std::vector<std::string> words; ///< in lower case

  /// `name`: the words of the name (splitName).
  bool matches(const std::vector<std::string>& name) const;
  bool operator==(const NamePattern&) const = default;
};

struct SegmentPatterns {
  std::vector<NamePattern> names = {};
  std::vector<NamePattern> except = {}; ///< names to exclude, whatever else matches
  /// Terminology codes of a segment's type, like "SCT^39607008", or type~region, like
  /// "SCT^4147007~SCT^12738006".
  std::vector<std::string> codes = {};
};

/// Reads the optional members "names", "except" and "codes" of an object. Throws Error (input).
SegmentPatterns readPatterns(const JsonNode& node);
/// Strings of the member `key`, 1 to 200 bytes each; empty: there is no such member.
std::vector<std::string> readPatternStrings(const JsonNode& parent, const std::string& key);
/// Reads a code as in SegmentPatterns::codes.
std::string readCode(const JsonNode& node);

/// First pattern that matches a name's words; null: none.
const NamePattern* findPattern(const std::vector<NamePattern>& patterns,
                               const std::vector<std::string>& name);

} // namespace fenestra::core
