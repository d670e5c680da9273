#include "program/InspectionText.h"

#include "base/Text.h"
#include "io/MessageText.h"
#include "program/ShellCommand.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

namespace fenestra::core {
namespace {

using Json = nlohmann::ordered_json;
using Row = std::vector<std::string>;

constexpr std::size_t width = 100, longestName = 36, longestId = 48, longestFile = 90; // characters
constexpr std::size_t maxNodes = 20, maxSegments = 100; ///< listed individually

bool isCharacterStart(char c) { // in UTF-8
  return (static_cast<unsigned char>(c) & 0xc0U) != 0x80U;
}

std::size_t countCharacters(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), isCharacterStart));
}

/// `text`, shortened with "..." to at most `most` characters.
std::string shorten(std::string text, std::size_t most) {
  text = toOneLine(std::move(text));
  if (countCharacters(text) <= most)
    return text;
  std::size_t end = 0;
  for (std::size_t count = 0; end < text.size(); ++end)
    if (isCharacterStart(text[end]) && ++count > most - 3)
      break;
  return text.substr(0, end) + "...";
}

/// Joins the texts that are not empty.
std::string joinNonEmpty(Row texts, const char* between = ", ") {
  std::erase(texts, "");
  return join(texts, between);
}

std::string formatNumber(double x, const char* format = "%.6g") {
  char text[32];
  std::snprintf(text, sizeof text, format, x == 0.0 ? 0.0 : x); // not -0
  return text;
}

// ---- members of the report

/// Member that is a text, shortened; empty: null.
std::string formatTextMember(const Json& object, const char* key, std::size_t most) {
  const Json& member = object[key];
  return member.is_null() ? "" : shorten(member, most);
}

/// Name of a file in full, of a node shortened.
std::string formatNodeName(const Json& node) {
  return formatTextMember(node, "name", node["id"].is_null() ? longestFile : longestName);
}

/// "name (id)", or only one of them.
std::string formatNameAndId(const Json& node) {
  const std::string id = formatTextMember(node, "id", longestId);
  return joinNonEmpty({formatNodeName(node), id.empty() ? "" : "(" + id + ")"}, " ");
}

std::string toHex(const Json& color) {
  std::string text = "#";
  for (const Json& part : color) {
    char byte[16];
    std::snprintf(byte, sizeof byte, "%02lx", std::lround(255.0 * part.get<double>()));
    text += byte;
  }
  return text;
}

std::string formatColors(const Json& background) {
  const std::string bottom = toHex(background["bottom"]), top = toHex(background["top"]);
  return bottom == top ? bottom : bottom + " (bottom) to " + top + " (top)";
}

std::string formatFiles(const Json& list) {
  if (list.empty())
    return "";
  const auto missing = std::count_if(list.begin(), list.end(),
                                     [](const Json& file) { return file["there"] == false; });
  std::string names = formatTextMember(list[0], "name", longestFile - 10);
  if (list.size() > 1)
    names += concat(" and ", list.size() - 1, " more");
  if (missing > 0)
    names += list.size() == 1 ? " (missing)" : concat(" (", missing, " missing)");
  return names;
}

/// Text, numbers, colors of a background, or files; empty: null or anything else.
std::string formatValue(const std::string& key, const Json& member) {
  static const std::map<std::string, const char*> separators = {{"size", " x "},
                                                                {"spacing", " x "},
                                                                {"edges", " x "},
                                                                {"range", " to "},
                                                                {"transforms", ", "}};
  if (member.is_string())
    return shorten(member, longestId);
  if (member.is_number())
    return formatNumber(member);
  if (member.is_object())
    return formatColors(member);
  if (key == "files")
    return formatFiles(member);
  Row items;
  if (member.is_array())
    for (const Json& item : member)
      items.push_back(formatValue("", item));
  const auto separator = separators.find(key);
  return joinNonEmpty(items, separator == separators.end() ? "," : separator->second);
}

/// Replaces "{key}" in `words` by that member, and "{}" by name and id; empty: one of them is null
/// or missing.
std::string fillTemplate(std::string_view words, const Json& object) {
  std::string text;
  for (auto open = words.find('{'); open != words.npos; open = words.find('{')) {
    const auto close = words.find('}', open);
    const std::string key(words.substr(open + 1, close - open - 1));
    const std::string member =
        key.empty() ? formatNameAndId(object) : formatValue(key, object.value(key, Json()));
    if (member.empty())
      return "";
    text.append(words.substr(0, open)).append(member);
    words.remove_prefix(close + 1);
  }
  return text.append(words);
}

/// Template for a part of the report, whatever its kind. Applies if all its members exist and, if
/// there is a `key`, that member has this value.
struct Phrase {
  const char* words;
  const char* key = nullptr;
  Json value = {};
};

/// Description of a node or part of a render, without name and id.
std::string describe(const Json& part) {
  static const Phrase phrases[] = {
      {"label map", "kind", "labelMap"},
      {"hidden", "shown", false},
      {"without a volume", "volume", nullptr},
      {"of {volume}"},
      {"names from {namesFrom}"},
      {"property {property}"},
      {"follows the slice display", "followsDisplay", true},
      {"cropped by {roi}", "cropping", true},
      {"cropping off, {roi}", "cropping", false},
      {"layout {layout}"},
      {"{technique}"},
      {"background {background}"},
      {"perspective, angle {angle} degrees"},
      {"orthographic, scale {scale} mm"},
      {"position {position}, target {target}, up {up}"},
      {"linear", "linear", true},
      {"{files}"},
      {"{size} voxels of {spacing} mm"},
      {"{size} voxels without a spacing", "spacing", nullptr},
      {"{voxelType} from {range}, center {center}"},
      {"one of {frames} frames"},
      {"transformed by {transforms}"},
      {"{}", "source", "volumeProperty"},
      {"the window of {}, which the rendering follows", "source", "volumeDisplay"},
      {"preset {name}, chosen by the volume's range", "source", "preset"},
      {"built for the volume's range", "source", "range"},
      {"{edges} mm around {center}"},
      {"under {transform}"},
  };
  Row texts;
  for (const auto& [words, key, value] : phrases)
    if (!key || (part.contains(key) && part[key] == value))
      texts.push_back(fillTemplate(words, part));
  return joinNonEmpty(texts);
}

// ---- lines

/// Title and lines; empty without lines.
std::string formatSection(const char* title, const std::string& lines) {
  return lines.empty() ? "" : std::string("\n") + title + "\n" + lines;
}

std::string formatLine(const std::string& text) {
  return text.substr(0, text.find_last_not_of(' ') + 1) + "\n";
}

/// Wrapped text; the first line begins with `label`, the others are indented by its width.
std::string formatParagraph(const std::string& label, const std::string& text) {
  const std::string lines = wrapLines(toOneLine(text), width - countCharacters(label));
  return label + replaceAll(lines, "\n", "\n" + std::string(countCharacters(label), ' ')) + "\n";
}

/// Pads the cells of each column to the same width; column i is aligned right if right[i] is '>'.
std::vector<std::string> alignColumns(std::vector<Row> rows, const std::string& right = "") {
  for (std::size_t i = 0; i < (rows.empty() ? 0 : rows[0].size()); ++i) {
    std::size_t columns = 0;
    for (const Row& row : rows)
      columns = std::max(columns, countCharacters(row[i]));
    for (Row& row : rows)
      row[i].insert(i < right.size() && right[i] == '>' ? 0 : row[i].size(),
                    columns - countCharacters(row[i]), ' ');
  }
  Row lines;
  for (const Row& row : rows)
    lines.push_back(joinNonEmpty(row, "  "));
  return lines;
}

std::string formatTable(const std::string& indent, const std::vector<Row>& rows,
                        const std::string& right) {
  return join(alignColumns(rows, right), "",
              [&indent](const std::string& row) { return formatLine(indent + row); });
}

// ---- sections

/// Cells of a segment's material: name, color, kind, and why it was chosen.
Row formatMaterial(const Json& material) {
  const Json& color = material["color"];
  const std::string colors = color.is_null() ? "as it is"
                             : color[0].is_array()
                                 ? toHex(color[0][1]) + " to " + toHex(color.back()[1])
                                 : toHex(color);
  return {material["name"].is_null() ? "-" : formatTextMember(material, "name", 24), colors,
          material["kind"], formatTextMember(material, "why", 48)};
}

std::string formatSegments(const Json& segments) {
  std::vector<Row> rows = {
      {"value", "layer", "color", "voxels", "ml", "id", "name", "material", "seen", "kind", "why"}};
  const std::size_t count = std::min(segments.size(), maxSegments);
  for (std::size_t i = 0; i < count; ++i) {
    const Json& segment = segments[i];
    rows.push_back(
        {segment["labelValue"].dump(), segment["layer"].dump(), toHex(segment["color"]),
         segment["voxels"].dump(), formatNumber(segment["milliliters"], "%.2f"),
         formatTextMember(segment, "id", 40),
         formatTextMember(segment, "name", 64) + (segment["shown"] == true ? "" : " (hidden)")});
    std::ranges::move(formatMaterial(segment["material"]), std::back_inserter(rows.back()));
  }
  if (segments.size() > count) {
    rows.push_back(Row(rows.front().size()));
    rows.back()[0] = "...";
    rows.back()[5] = concat(segments.size() - count, " more (--json lists them all)");
  }
  return formatTable("      ", rows, ">> >>");
}

/// Lines "* name  id  description"; a long description gets a line of its own. The asterisk marks
/// nodes that a render uses.
std::string formatNodes(const Json& nodes) {
  const std::size_t count = std::min(nodes.size(), maxNodes);
  std::vector<Row> names;
  for (std::size_t i = 0; i < count; ++i)
    names.push_back({(nodes[i]["used"] == true ? "* " : "  ") + formatNodeName(nodes[i]),
                     formatTextMember(nodes[i], "id", longestId)});
  const Row heads = alignColumns(names);
  std::string lines;
  for (std::size_t i = 0; i < count; ++i) {
    const Json& node = nodes[i];
    const std::string more = describe(node), full = heads[i] + "  " + more;
    lines += countCharacters(full) <= width
                 ? formatLine(full)
                 : formatLine(heads[i]) + formatParagraph("      ", more);
    if (!node["problem"].is_null())
      lines += formatParagraph("      problem: ", node["problem"]);
    if (node.contains("segments") && !node["segments"].empty())
      lines += formatSegments(node["segments"]);
  }
  if (nodes.size() > count)
    lines += "  and " + std::to_string(nodes.size() - count) + " more (--json lists them all)\n";
  return lines;
}

std::string formatSeries(const Json& series) {
  std::vector<Row> rows = {{"number", "files", "modality", "description", "part", "uid"}};
  for (const Json& one : series)
    rows.push_back({formatTextMember(one, "number", 8), one["files"].dump(),
                    formatTextMember(one, "modality", 8), formatTextMember(one, "description", 24),
                    formatTextMember(one, "part", 24), formatTextMember(one, "uid", 64)});
  return series.empty() ? "" : formatTable("  ", rows, ">>");
}

std::string formatOthers(const Json& others) {
  Row tags;
  for (const auto& [tag, count] : others.items())
    tags.push_back(shorten(tag, longestName) + (count > 1 ? " (" + count.dump() + ")" : ""));
  return tags.empty() ? "" : formatParagraph("  ", joinNonEmpty(tags));
}

std::string formatList(const Json& list) {
  return join(list, "", [](const Json& line) { return formatParagraph("  - ", line); });
}

std::string formatRender(const Json& use) {
  std::string lines;
  const auto add = [&](const char* label, const char* key, auto&& words) {
    if (const Json& part = use[key]; !part.empty()) // null is empty
      lines += formatParagraph(label, words(part));
  };
  const auto withName = [](const Json& part) {
    return fillTemplate("{}: ", part) + describe(part);
  };
  add("  volume        ", "volume", withName);
  add("  appearance    ", "look", describe);
  add("  crop          ", "crop", withName);
  add("  camera        ", "camera", [&](const Json& camera) {
    return (formatNameAndId(camera).empty() ? "framed: " : "") + withName(camera);
  });
  add("  background    ", "background",
      [](const Json& part) { return formatColors(part) + fillTemplate(", of {view}", part); });
  add("  segmentation  ", "segmentationProblem",
      [](const std::string& problem) { return "undecided: " + problem; });
  add("  segmentation  ", "segmentation",
      [](const std::string& segmentation) { return segmentation + ", with --focus"; });
  add("  as rendered   ", "stored",
      [](const Row& arguments) { return joinNonEmpty(arguments, " "); });
  return lines;
}

} // namespace

std::string formatInspection(const Inspection& inspection) {
  const std::map<std::string, const char*> kinds = {{"scene", "Slicer scene"},
                                                    {"volume", "volume"},
                                                    {"segmentation", "segmentation or label map"},
                                                    {"dicom", "DICOM files"}};
  const bool refused = !inspection["refused"].is_null();
  std::string text = formatParagraph("", inspection["input"].get<std::string>() + ": " +
                                             kinds.at(inspection["kind"]) +
                                             fillTemplate(", version {version}", inspection));
  text += formatSection("DICOM series", formatSeries(inspection["series"]));
  for (const auto& [key, title] : {std::pair("volumes", "Volumes"),
                                   {"segmentations", "Segmentations"},
                                   {"volumeRenderings", "Volume renderings"},
                                   {"volumeProperties", "Volume properties"},
                                   {"rois", "Regions of interest"},
                                   {"views", "Views"},
                                   {"cameras", "Cameras"},
                                   {"transforms", "Transforms"}})
    text += formatSection(title, formatNodes(inspection[key]));
  text += formatSection("Other nodes", formatOthers(inspection["others"]));
  if (refused)
    text += "\n" +
            formatParagraph("", "A render would fail: " + inspection["refused"].get<std::string>());
  if (const Json& use = inspection["render"]; !use.is_null())
    text +=
        formatSection(refused ? "It would use, as far as can be determined" : "A render would use",
                      formatRender(use));
  text += formatSection("Example", join(inspection["examples"], "", formatExample));
  return text + formatSection("Warnings", formatList(inspection["warnings"])) +
         formatSection("Ignored", formatList(inspection["ignored"]));
}

} // namespace fenestra::core
