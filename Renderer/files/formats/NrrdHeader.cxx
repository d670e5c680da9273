#include "files/formats/NrrdHeader.h"

#include "files/formats/TextHeader.h"

#include <cmath>
#include <numeric>
#include <utility>

namespace fenestra::core {

using namespace header;

namespace {

/// Maximum number of lines, including a list of files: teem, ITK's NRRD library, compares each key
/// with all others.
constexpr int maxLines = 10'000;
/// Maximum length of a line and of a path, bytes: teem may copy them into a message of 1024.
constexpr std::size_t maxLineBytes = 500, maxPathBytes = 900;

/// Key of the field `name`, as in NrrdHeaderText.
std::string toKey(std::string_view name) {
  std::string key = toLower(name);
  std::erase(key, ' ');
  return key;
}

/// Checks dimension and sizes. ITK stores sizes in 32 bits. Teem has room for 16 axes, and writes
/// beyond it if there are more sizes.
void checkNrrdSizes(const std::filesystem::path& path, const Fields& fields) {
  const auto axes = parseInteger(findValue(fields, "dimension"));
  if (!axes || *axes < 1 || *axes > 10)
    throw fieldError(path, "dimension", "must be an integer from 1 to 10");
  if (!fields.contains("sizes"))
    throw damagedError(path, "NRRD");
  for (const std::string& word : splitWords(fields.at("sizes")))
    if (const auto size = parseInteger(word); !size || *size < 1 || *size > INT32_MAX)
      throw fieldError(path, "sizes", "each must be an integer from 1 to 2147483647");
}

/// Number of axes that ITK places in space: all but lists, vectors and colors.
std::size_t countSpatialAxes(const Fields& fields) {
  if (!fields.contains("kinds"))
    return splitWords(fields.at("sizes")).size();
  std::size_t count = 0;
  for (const std::string& kind : splitWords(fields.at("kinds")))
    for (const char* known : {"domain", "space", "time", "???", "none"})
      count += toLower(kind) == known;
  return count;
}

/// Checks space directions; ITK replaces missing ones by 1 mm.
void checkNrrdVectors(const std::filesystem::path& path, const Fields& fields) {
  auto vectors = parseNrrdVectors(findValue(fields, "spacedirections"));
  if (vectors)
    std::erase(*vectors, std::vector<double>());
  const auto isUsable = [](const std::vector<double>& v) {
    constexpr double maxSpacing = 1e9; // mm; limit of every spacing
    const double length = std::sqrt(std::inner_product(v.begin(), v.end(), v.begin(), 0.0));
    return length >= 1.0 / maxSpacing && length <= maxSpacing;
  };
  if (!vectors || !std::all_of(vectors->begin(), vectors->end(), isUsable))
    throw fieldError(path, "space directions",
                     "each must be a vector of 1e-9 to 1e9 mm, or none; fix the header");
  if (!vectors->empty() && vectors->size() < std::min<std::size_t>(countSpatialAxes(fields), 3))
    throw fieldError(path, "space directions", "has ", vectors->size(),
                     " vectors; write one per spatial axis");
}

/// Checks each unit of the field `name`, a text in quotes.
void checkNrrdUnits(const std::filesystem::path& path, const Fields& fields, const char* name) {
  const std::vector<std::string> parts = split(findValue(fields, toKey(name)), '"');
  for (std::size_t i = 1; i < parts.size(); i += 2) // odd parts are within quotes
    checkMillimeters(path, name, parts[i]);
}

/// Checks spacings, axis mins and axis maxs. With a space, teem expects space directions instead.
/// Without spacings, ITK uses the axis mins and a spacing of 1 mm.
void checkNrrdAxes(const std::filesystem::path& path, const Fields& fields) {
  const bool hasSpace = fields.contains("space") || fields.contains("spacedimension");
  for (const auto& [name, hint] : {std::pair("spacings", "write space directions"),
                                   {"axis mins", "write space directions and space origin"},
                                   {"axis maxs", "write space directions and space origin"},
                                   {"units", "write space units"}})
    if (hasSpace && fields.contains(toKey(name)))
      throw fieldError(path, name, "cannot be combined with a space; ", hint);
  for (const char* name : {"axis mins", "axis maxs"})
    if (fields.contains(toKey(name)) && !fields.contains("spacings"))
      throw fieldError(path, name,
                       "requires spacings; add them, or a space with its directions and origin");
}

void checkNrrdKinds(const std::filesystem::path& path, const Fields& fields) {
  const std::string name = toLower(findValue(fields, "space"));
  const bool hasTime = name.ends_with("-time") || name.ends_with("st"); // RAST and similar
  if (name.empty() || hasTime || findNrrdFrameAxis(fields))
    return;
  if (const std::size_t count = countSpatialAxes(fields); count > 3)
    throw fieldError(path, "kinds", count,
                     " spatial axes in a space of three dimensions; extract one frame");
}

/// Checks the geometry. Refuses NaN, for which ITK silently uses its default.
void checkNrrdGeometry(const std::filesystem::path& path, const Fields& fields) {
  for (const char* name : {"space directions", "space origin", "spacings"})
    if (toLower(findValue(fields, toKey(name))).find("nan") != std::string::npos)
      throw fieldError(path, name, "is not a number; fix the header");
  checkNrrdVectors(path, fields);
  checkNrrdAxes(path, fields);
  checkNrrdKinds(path, fields);
  checkNrrdUnits(path, fields, "space units");
  checkNrrdUnits(path, fields, "units");
}

/// Lines of a NRRD header, short enough for teem's messages.
class NrrdLines {
public:
  explicit NrrdLines(const std::filesystem::path& path) : m_path(path), m_lines(path) {}

  std::optional<std::string_view> next() {
    const auto line = m_lines.next();
    if (!line)
      return std::nullopt;
    if (++m_count > maxLines)
      throw fieldError(m_path, "header", "has more than ", maxLines,
                       " lines; remove some of its key:=value lines");
    if (hasControlCharacter(*line))
      throw damagedError(m_path, "NRRD");
    if (line->size() > maxLineBytes && !isKeyValue(*line))
      throw fieldError(m_path, "header", "line ", m_count, " has more than ", maxLineBytes,
                       " bytes and is not key:=value; shorten it");
    return line;
  }

  /// True for "key:=value", a text of any length that an application defines. A ": " before the
  /// ":=" makes the line a field, as in teem.
  static bool isKeyValue(std::string_view line) {
    return line.substr(0, line.find(": ")).find(":=") != std::string_view::npos;
  }

  /// Offset in the file of the byte after the lines read so far.
  std::uint64_t position() const { return m_lines.position(); }

private:
  const std::filesystem::path& m_path;
  HeaderLines m_lines;
  int m_count = 0;
};

Fields readNrrdFields(const std::filesystem::path& path, NrrdLines& lines) {
  const auto magic = lines.next();
  if (!magic || !magic->starts_with("NRRD000") || magic->size() != 8)
    throw damagedError(path, "NRRD");
  Fields fields;
  for (auto line = lines.next(); line && !line->empty(); line = lines.next()) {
    const std::size_t colon = line->find(": ");
    if (colon == std::string_view::npos || line->starts_with('#') || NrrdLines::isKeyValue(*line))
      continue;
    const std::string key = toKey(line->substr(0, colon));
    const auto [field, isNew] = fields.emplace(key, trim(line->substr(colon + 2)));
    if (!isNew) // teem would use one of the two values
      throw fieldError(path, key.substr(0, 40), "occurs twice; remove one");
    if (key == "datafile" && field->second.starts_with("LIST"))
      break; // the file names follow
  }
  return fields;
}

} // namespace

void checkNrrdPath(const std::filesystem::path& path) {
  if (path.string().size() > maxPathBytes)
    throw inputError(ErrorCode::limitExceeded, path, "has a path of more than ", maxPathBytes,
                     " bytes; move it to a folder with a shorter path");
}

/// Teem copies each number's text into 1024 bytes, whatever its length.
void checkNrrdNumbers(const std::filesystem::path& path, std::uint64_t offset,
                      const std::filesystem::path& header) {
  std::ifstream file(path, std::ios::binary);
  file.seekg(static_cast<std::streamoff>(offset));
  std::size_t length = 0; // characters of the current number
  for (char c = 0; file.get(c);) {
    length = std::isspace(static_cast<unsigned char>(c)) ? 0 : length + 1;
    if (length > maxLineBytes)
      throw fieldError(header, "samples", "a number has more than ", maxLineBytes,
                       " characters; write the file again");
  }
}

std::optional<std::vector<std::vector<double>>> parseNrrdVectors(std::string_view text) {
  std::vector<std::vector<double>> vectors;
  for (text = trim(text); !text.empty(); text = trim(text)) {
    std::vector<double>& vector = vectors.emplace_back();
    if (text.front() != '(') { // "none"
      text.remove_prefix(std::min(text.find_first_of(" \t("), text.size()));
      continue;
    }
    const std::size_t close = text.find(')');
    if (close == std::string_view::npos)
      return std::nullopt;
    std::string inside(text.substr(1, close - 1));
    std::replace(inside.begin(), inside.end(), ',', ' ');
    std::erase(inside, '+');
    auto numbers = parseNumbers(inside);
    if (!numbers || numbers->empty())
      return std::nullopt;
    vector = *std::move(numbers);
    text.remove_prefix(close + 1);
  }
  return vectors;
}

std::optional<std::size_t> findNrrdFrameAxis(const std::map<std::string, std::string>& fields) {
  constexpr std::size_t axes = 4;
  const std::vector<std::string> kinds = splitWords(toLower(findValue(fields, "kinds")));
  const auto vectors = parseNrrdVectors(findValue(fields, "spacedirections"));
  if (parseInteger(findValue(fields, "dimension")) != axes || !vectors ||
      (!kinds.empty() && kinds.size() != axes) || (!vectors->empty() && vectors->size() != axes))
    return std::nullopt;
  const auto hasSpatialPart = [](const std::vector<double>& vector) {
    const auto end = vector.begin() + std::min<std::ptrdiff_t>(3, std::ssize(vector));
    return std::any_of(vector.begin(), end, [](double x) { return x != 0.0; });
  };
  std::optional<std::size_t> found;
  for (std::size_t axis = 0; axis < axes; ++axis) {
    const std::string kind = kinds.empty() ? "???" : kinds[axis];
    const bool isUnknown = kind == "???" || kind == "none" || kind == "domain" || kind == "space";
    const bool isPlaced = vectors->empty() || hasSpatialPart((*vectors)[axis]);
    if (kind != "time" && !(isUnknown && !isPlaced))
      continue;
    if (found)
      return std::nullopt;
    found = axis;
  }
  return found;
}

bool hasNrrdSpacing(const NrrdHeaderText& header) {
  return header.fields.contains("spacings") ||
         findValue(header.fields, "spacedirections").find('(') != std::string::npos;
}

NrrdHeaderText readNrrdHeader(const std::filesystem::path& path) {
  checkNrrdPath(path);
  NrrdLines lines(path);
  NrrdHeaderText header;
  header.fields = readNrrdFields(path, lines);
  checkNrrdSizes(path, header.fields);
  checkNrrdGeometry(path, header.fields);
  header.end = lines.position();
  if (findValue(header.fields, "datafile").starts_with("LIST"))
    for (auto line = lines.next(); line; line = lines.next()) {
      if (trim(*line).empty()) // teem would take it as a file name
        throw fieldError(path, "data file", "its LIST has an empty line; remove it");
      header.files.emplace_back(trim(*line));
    }
  return header;
}

} // namespace fenestra::core
