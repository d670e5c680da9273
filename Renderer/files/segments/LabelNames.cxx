#include "files/segments/LabelNames.h"

#include "base/Error.h"
#include "base/Text.h"
#include "files/formats/Csv.h"
#include "io/EmbeddedResources.h"
#include "io/InputRegistry.h"
#include "io/JsonNode.h"
#include "io/MessageText.h"

#include <pugixml.hpp>

#include <algorithm>
#include <charconv>
#include <functional>

namespace fenestra::core {
namespace {

/// Collects names; its errors state the source and the place in the table.
class TableBuilder {
public:
  explicit TableBuilder(std::string source) : m_source(std::move(source)) {}

  void add(const std::string& place, std::optional<std::int64_t> value, std::string name,
           std::optional<Rgb> color = {}) {
    if (!value || *value < std::numeric_limits<std::int32_t>::min() ||
        *value > std::numeric_limits<std::int32_t>::max())
      throw fieldError(m_source, place, "must begin with a 32-bit integer");
    if (*value == 0)
      return;
    if (name.empty())
      throw fieldError(m_source, place, "has no name; name the value, or remove it");
    const auto key = static_cast<std::int32_t>(*value);
    if (color && !((*color >= 0.0).all() && (*color <= 1.0).all()))
      color.reset();
    const auto [entry, isNew] = m_names.insert({key, {std::move(name), color}});
    if (!isNew)
      throw fieldError(m_source, place, "names the value ", key, ", which already is \"",
                       sanitize(entry->second.name), "\"; remove one of them");
  }

  LabelNames take() {
    if (m_names.empty())
      throw inputError(m_source, "names no value; give a label table");
    return std::move(m_names);
  }

  const std::string& source() const { return m_source; }

private:
  std::string m_source;
  LabelNames m_names;
};

/// Calls `use` with the place and the text of each line that is neither empty nor a comment.
void forEachLine(const std::string& text,
                 const std::function<void(const std::string& place, std::string_view line)>& use) {
  std::size_t number = 0;
  for (const std::string& line : split(text, '\n')) {
    ++number;
    const std::string_view content = trim(line);
    if (!content.empty() && content.front() != '#')
      use(concat("line ", number), content);
  }
}

/// Color of three byte values, starting at `first`; nullopt: malformed.
std::optional<Rgb> parseColor(const std::vector<std::string>& parts, std::size_t first) {
  Rgb color;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto byte =
        first + i < parts.size() ? parseNumber<double>(parts[first + i]) : std::optional<double>();
    if (!byte)
      return std::nullopt;
    color[static_cast<int>(i)] = *byte / 255.0;
  }
  return color;
}

/// Slicer writes spaces in names as underscores, which is ambiguous; names stay as written. Some
/// tools write spaces: the name then ends before the four numbers of the color.
void readColorTable(const std::string& text, TableBuilder& table) {
  constexpr std::size_t fewest = 6; // value, name, color
  forEachLine(text, [&](const std::string& place, std::string_view line) {
    const std::vector<std::string> parts = splitWords(line);
    std::size_t end = std::min<std::size_t>(parts.size(), 2);
    if (parts.size() > fewest && parseColor(parts, parts.size() - 4))
      end = parts.size() - 4;
    const std::vector<std::string> words(parts.begin() + 1,
                                         parts.begin() + static_cast<std::ptrdiff_t>(end));
    table.add(place, parseInteger(parts[0]), join(words, " "), parseColor(parts, end));
  });
}

void readSnapTable(const std::string& text, TableBuilder& table) {
  forEachLine(text, [&](const std::string& place, std::string_view line) {
    const std::size_t open = line.find('"'), close = line.rfind('"');
    const std::vector<std::string> parts = splitWords(line.substr(0, open));
    const bool isQuoted = open != std::string_view::npos && close > open;
    table.add(place, parts.empty() ? std::nullopt : parseInteger(parts[0]),
              isQuoted ? std::string(line.substr(open + 1, close - open - 1)) : "",
              parseColor(parts, 1));
  });
}

/// Color "#rrggbb"; nullopt: malformed.
std::optional<Rgb> parseHexColor(std::string_view text) {
  if (text.size() != 7 || text.front() != '#')
    return std::nullopt;
  Rgb color;
  for (int i = 0; i < 3; ++i) {
    unsigned byte = 0;
    const std::string_view digits = text.substr(1 + 2 * static_cast<std::size_t>(i), 2);
    const char* const end = digits.data() + digits.size();
    if (std::from_chars(digits.data(), end, byte, 16).ptr != end)
      return std::nullopt;
    color[i] = byte / 255.0;
  }
  return color;
}

/// Rows of a table whose first line may name its columns.
class TableColumns {
public:
  /// True if the first row, with lower-case fields, is a line of titles.
  bool readTitles(const std::string& source, const std::string& place,
                  const std::vector<std::string>& titles) {
    if (parseInteger(titles[0]))
      return false;
    const auto find = [&](std::initializer_list<std::string_view> names) {
      return static_cast<std::size_t>(std::ranges::find_first_of(titles, names) - titles.begin());
    };
    m_value = find({"label", "value", "id", "index", "labelvalue"});
    m_name = find({"name", "label_name", "labelname", "structure", "segment"});
    m_color = find({"color", "color_r"});
    if (m_value >= titles.size() || m_name >= titles.size())
      throw fieldError(source, place, "has no columns \"label\" and \"name\"; rename the columns");
    return true;
  }

  void addRow(const std::string& place, const std::vector<std::string>& fields,
              TableBuilder& table) const {
    const auto field = [&](std::size_t i) { return i < fields.size() ? fields[i] : std::string(); };
    const auto hex = parseHexColor(field(m_color));
    table.add(place, parseInteger(field(m_value)), field(m_name),
              hex ? hex : parseColor(fields, m_color));
  }

private:
  std::size_t m_value = 0, m_name = 1;
  std::size_t m_color = std::string::npos; ///< hexadecimal, or the first of three columns
};

void addRows(const std::vector<CsvRecord>& rows, TableBuilder& table) {
  TableColumns columns;
  bool isFirst = true;
  for (const CsvRecord& row : rows) {
    std::vector<std::string> fields, titles;
    for (const std::string& field : row.fields) {
      fields.emplace_back(trim(field, " \t\""));
      titles.push_back(toLower(fields.back()));
    }
    const std::string place = concat("line ", row.line);
    if (!fields[0].starts_with('#') &&
        !(std::exchange(isFirst, false) && columns.readTitles(table.source(), place, titles)))
      columns.addRow(place, fields, table);
  }
}

void readCsv(const std::string& text, TableBuilder& table) {
  addRows(parseCsv(text, table.source()), table);
}

/// BIDS: index, name, abbreviation, color.
void readTsv(const std::string& text, TableBuilder& table) {
  std::vector<CsvRecord> rows;
  std::size_t number = 0;
  for (const std::string& line : split(text, '\n'))
    if (++number; !trim(line).empty())
      rows.push_back({number, split(trim(line, "\r"), '\t')});
  addRows(rows, table);
}

/// Label description of ITK-SNAP, by its names in quotes, or a color table.
void readLines(const std::string& text, TableBuilder& table) {
  bool hasQuotes = false;
  forEachLine(text, [&](const std::string&, std::string_view line) {
    hasQuotes |= line.ends_with('"') && splitWords(line).size() >= 8;
  });
  hasQuotes ? readSnapTable(text, table) : readColorTable(text, table);
}

/// Entry of a JSON object: value and name in either order, as Medical Segmentation Decathlon and
/// nnU-Net write them. Regions of nnU-Net, which join several values, are left out.
void addMember(const std::string& key, const JsonNode& value, TableBuilder& table) {
  const std::string place = concat('"', sanitize(key), '"');
  if (value.isNumber() && !parseInteger(key))
    table.add(place, static_cast<std::int64_t>(value.number(-2147483648.0, 2147483647.0)), key);
  else if (!value.isArray())
    table.add(place, parseInteger(key), value.text());
}

void readJsonTable(std::string_view text, TableBuilder& table) {
  const nlohmann::json document = parseJson(text, table.source());
  const JsonNode root(document, table.source());
  if (root.isObject()) {
    const auto labels = root.find("labels"); // dataset.json of nnU-Net and of the Decathlon
    for (const auto& [key, value] : (labels && labels->isObject() ? *labels : root).members())
      addMember(key, value, table);
    return;
  }
  std::size_t number = 0;
  for (const JsonNode& entry : root.elements())
    table.add(concat('[', number++, ']'),
              static_cast<std::int64_t>(entry.at("label").number(-2147483648.0, 2147483647.0)),
              entry.at("name").text());
}

} // namespace

LabelNames readLabelNames(const std::filesystem::path& path) {
  using Read = void (*)(const std::string&, TableBuilder&);
  static const std::map<std::string, Read> readers = {
      {".ctbl", readLines},
      {".txt", readLines},
      {".label", readSnapTable},
      {".csv", readCsv},
      {".tsv", readTsv},
      {".json", [](const std::string& text, TableBuilder& table) { readJsonTable(text, table); }}};
  const auto reader = readers.find(lowercaseExtension(path));
  if (reader == readers.end())
    throw inputError(ErrorCode::unsupportedFile, path.string(),
                     "has no extension of a label table; give a .ctbl, .txt, "
                     ".label, .json, .csv or .tsv");
  TableBuilder table(path.string());
  reader->second(readText(path), table);
  return table.take();
}

std::optional<LabelNames> findBuiltInLabelNames(const std::string& name) {
  const std::string_view text = findResource("labels/" + name + ".json");
  if (text.empty())
    return std::nullopt;
  TableBuilder table(name);
  readJsonTable(text, table);
  return table.take();
}

std::vector<std::string> listBuiltInLabelTables() {
  std::vector<std::string> tables;
  for (const std::string& file : listResources("labels/"))
    tables.push_back(std::filesystem::path(file).stem().string());
  return tables;
}

std::optional<LabelNames> parseLabelNamesXml(std::string_view xml, const std::string& source) {
  const std::size_t begin = xml.find('<');
  if (begin == xml.npos || xml.find("<LabelTable>") == xml.npos)
    return std::nullopt;
  pugi::xml_document document;
  const std::size_t end = xml.rfind('>') + 1;
  if (!document.load_buffer(xml.data() + begin, end - begin))
    throw inputError(ErrorCode::damagedFile, source,
                     "the label table in its header extension is damaged; write it again");
  TableBuilder table(source);
  for (const pugi::xpath_node& found : document.select_nodes("//LabelTable/Label")) {
    const pugi::xml_node label = found.node();
    const auto component = [&](const char* key) { return label.attribute(key).as_double(-1.0); };
    table.add("label table in its header extension", parseInteger(label.attribute("Key").value()),
              std::string(trim(label.child_value())),
              Rgb(component("Red"), component("Green"), component("Blue")));
  }
  return table.take();
}

} // namespace fenestra::core
