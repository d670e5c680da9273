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
#include <functional>

namespace fenestra {
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

/// Slicer writes spaces in names as underscores, which is ambiguous; names stay as written.
void readColorTable(const std::string& text, TableBuilder& table) {
  forEachLine(text, [&](const std::string& place, std::string_view line) {
    const std::vector<std::string> parts = splitWords(line);
    table.add(place, parseInteger(parts[0]), parts.size() > 1 ? parts[1] : "",
              parseColor(parts, 2));
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

void readCsv(const std::string& text, TableBuilder& table) {
  std::size_t value = 0, name = 1;
  bool isFirst = true;
  for (CsvRecord& record : parseCsv(text, table.source())) {
    std::vector<std::string>& fields = record.fields;
    const std::string place = concat("line ", record.line);
    for (std::string& field : fields)
      field = trim(field, " \t\"");
    if (fields[0].starts_with('#'))
      continue;
    const auto findColumn = [&](std::initializer_list<std::string_view> titles) {
      return static_cast<std::size_t>(
          std::ranges::find_if(fields,
                               [&](const std::string& field) {
                                 return std::ranges::find(titles, toLower(field)) != titles.end();
                               }) -
          fields.begin());
    };
    if (std::exchange(isFirst, false) && !parseInteger(fields[0])) {
      value = findColumn({"label", "value", "id", "index", "labelvalue"});
      name = findColumn({"name", "label_name", "labelname", "structure", "segment"});
      if (value >= fields.size() || name >= fields.size())
        throw fieldError(table.source(), place,
                         "has no columns \"label\" and \"name\"; rename the columns");
      continue;
    }
    const auto field = [&](std::size_t i) { return i < fields.size() ? fields[i] : std::string(); };
    table.add(place, parseInteger(field(value)), field(name));
  }
}

void readJsonTable(std::string_view text, TableBuilder& table) {
  const nlohmann::json document = parseJson(text, table.source());
  const JsonNode root(document, table.source());
  if (root.isObject()) {
    for (const auto& [key, name] : root.members())
      table.add(concat('"', sanitize(key), '"'), parseInteger(key), name.text());
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
      {".ctbl", readColorTable},
      {".txt", readColorTable},
      {".label", readSnapTable},
      {".csv", readCsv},
      {".json", [](const std::string& text, TableBuilder& table) { readJsonTable(text, table); }}};
  const auto reader = readers.find(lowercaseExtension(path));
  if (reader == readers.end())
    throw inputError(ErrorCode::unsupportedFile, path.string(),
                     "has no extension of a label table; give a .ctbl, .txt, "
                     ".label, .json or .csv");
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

} // namespace fenestra
