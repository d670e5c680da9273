#pragma once
// Patterns that tell segments by name and terminology code, in presets and materials.

#include "io/JsonNode.h"

#include <string>
#include <vector>

namespace fenestra {

/// Pattern of names. A name matches if consecutive words of it match the words of the pattern, in
/// upper or lower case; `*` is any text in a word, `?` any character. Other signs, and changes to
/// upper case, separate words.
struct NamePattern {
  NamePattern(std::string text);
  NamePattern(const char* text) : NamePattern(std::string(text)) {}

  std::string text;
  std::vector<std::string> words; ///< in lower case

  /// `name`: its words (splitName).
  bool matches(const std::vector<std::string>& name) const;
  bool operator==(const NamePattern&) const = default;
};

struct SegmentPatterns {
  std::vector<NamePattern> names = {};
  std::vector<NamePattern> except = {}; ///< of names that are excluded, whatever else matches
  /// Terminology codes of a segment's type, like "SCT^39607008", or type~region, like
  /// "SCT^4147007~SCT^12738006".
  std::vector<std::string> codes = {};
};

/// Reads the members "names", "except" and "codes" of an object, each of which may be missing.
/// Throws Error (input).
SegmentPatterns readPatterns(const JsonNode& node);
/// Texts of the member `key`, of 1 to 200 bytes each; empty: there is no such member.
std::vector<std::string> readPatternStrings(const JsonNode& parent, const std::string& key);
/// A code as in SegmentPatterns::codes.
std::string readCode(const JsonNode& node);

/// First of the patterns that a name's words match; null: none.
const NamePattern* findPattern(const std::vector<NamePattern>& patterns,
                               const std::vector<std::string>& name);

} // namespace fenestra
