#include "base/safe/ShownText.h"
#include "program/Help.h"
#include "program/InspectReport.h"

#include <algorithm>
#include <cstdio>

namespace fenestra {
namespace {

constexpr std::size_t width = 100; ///< characters in a line
constexpr std::size_t longestName = 36, longestId = 48, longestFile = 90;
constexpr std::size_t mostNodes = 20, mostSegments = 100; ///< listed one by one

// ---- words
// ---------------------------------------------------------------------------------------

bool startsCharacter(char c) { // in UTF-8
  return (static_cast<unsigned char>(c) & 0xc0U) != 0x80U;
}

std::size_t characters(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), startsCharacter));
}

/// `text`, or its first characters and "...": at most `most` characters.
std::string clipped(std::string text, std::size_t most) {
  text = oneLine(std::move(text));
  if (characters(text) <= most)
    return text;
  std::size_t end = 0;
  for (std::size_t count = 0; end < text.size(); ++end)
    if (startsCharacter(text[end]) && ++count > most - 3)
      break;
  return text.substr(0, end) + "...";
}

std::string number(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", x == 0.0 ? 0.0 : x); // no -0
  return text;
}

template <typename Numbers>
std::string joined(const Numbers& vector, const char* between) {
  std::string text;
  for (int i = 0; i < vector.size(); ++i)
    text += (i == 0 ? "" : between) + number(static_cast<double>(vector[i]));
  return text;
}

std::string hex(const Rgb& color) {
  const auto byte = [&color](int c) {
    return static_cast<unsigned>(std::lround(255.0 * color[c]));
  };
  char text[16];
  std::snprintf(text, sizeof text, "#%02x%02x%02x", byte(0), byte(1), byte(2));
  return text;
}

std::string grid(const Size3& size, const Vec3& spacing) {
  return joined(size, " x ") + " voxels of " + joined(spacing, " x ") + " mm";
}

/// Shown name: a file's in full, a node's clipped.
std::string nameOf(const std::string& name, const std::string& id) {
  return clipped(name, id.empty() ? longestFile : longestName);
}

std::string named(const std::string& name, const std::string& id) {
  const std::string shown = nameOf(name, id);
  return id.empty() ? shown : shown + (shown.empty() ? "(" : " (") + clipped(id, longestId) + ")";
}

std::string colors(const Rgb& bottom, const Rgb& top) {
  return bottom == top ? hex(bottom) : hex(bottom) + " below to " + hex(top) + " above";
}

std::string pose(const CameraPose& pose) {
  const bool perspective = pose.projection == Projection::perspective;
  return std::string(perspective ? "perspective, angle " : "orthographic, scale ") +
         number(perspective ? pose.angle : pose.scale) + (perspective ? " degrees" : " mm") +
         ", position " + joined(pose.position, ",") + ", target " + joined(pose.target, ",") +
         ", up " + joined(pose.up, ",");
}

// ---- the page
// ------------------------------------------------------------------------------------

using Row = std::vector<std::string>;

/// `text` and blanks, `columns` characters wide; `right`: blanks first.
std::string padded(const std::string& text, std::size_t columns, bool right) {
  const std::string blanks(columns - std::min(columns, characters(text)), ' ');
  return right ? blanks + text : text + blanks;
}

class Page {
public:
  void blank() { m_text += '\n'; }

  void heading(const std::string& text) { m_text += "\n" + text + "\n"; }

  /// Adds wrapped text; the first line starts with `label`, the others are indented by its width.
  void paragraph(const std::string& label, const std::string& text) {
    const std::string lines = wrapped(oneLine(text), width - characters(label));
    const std::string margin(characters(label), ' ');
    m_text += label;
    for (const char c : lines) {
      m_text += c;
      m_text += c == '\n' ? margin : "";
    }
    m_text += '\n';
  }

  /// Adds rows; each column is as wide as its widest cell. Column i is aligned right if right[i] is
  /// '>'.
  void table(const std::string& indent, const std::vector<Row>& rows, const std::string& right) {
    std::vector<std::size_t> columns;
    for (const Row& row : rows)
      for (std::size_t i = 0; i < row.size(); ++i) {
        columns.resize(std::max(columns.size(), row.size()));
        columns[i] = std::max(columns[i], characters(row[i]));
      }
    for (const Row& row : rows) {
      std::string line = indent;
      for (std::size_t i = 0; i < row.size(); ++i)
        line +=
            (i == 0 ? "" : "  ") + padded(row[i], columns[i], i < right.size() && right[i] == '>');
      m_text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
    }
  }

  std::string text() && { return std::move(m_text); }

private:
  std::string m_text;
};

/// Node in a list, the remark behind its name and id, and the rows below.
struct Entry {
  const NodeSummary* node;
  std::string remark = {};
  std::vector<Row> rows = {};
};

std::string filesOf(const NodeSummary& node) {
  if (node.files.empty())
    return "";
  const auto missing = std::count_if(node.files.begin(), node.files.end(),
                                     [](const FileSummary& file) { return !file.there; });
  std::string text = clipped(node.files.front().name, longestFile - 10);
  if (node.files.size() > 1)
    text += " and " + std::to_string(node.files.size() - 1) + " more";
  if (missing > 0)
    text += node.files.size() == 1 ? " (missing)" : " (" + std::to_string(missing) + " missing)";
  return text;
}

void addRemark(std::string& remark, const std::string& more) {
  if (!more.empty())
    remark += (remark.empty() ? "" : ", ") + more;
}

/// Adds lines "* name  id  remark"; a remark that is too long has a line of its own. An asterisk
/// marks nodes that a render uses.
void listNodes(Page& page, const std::string& heading, const std::vector<Entry>& entries) {
  if (entries.empty())
    return;
  page.heading(heading);
  std::size_t nameColumns = 0;
  std::size_t idColumns = 0;
  const std::size_t count = std::min(entries.size(), mostNodes);
  for (std::size_t i = 0; i < count; ++i) {
    nameColumns =
        std::max(nameColumns, characters(nameOf(entries[i].node->name, entries[i].node->id)));
    idColumns = std::max(idColumns, characters(clipped(entries[i].node->id, longestId)));
  }
  for (std::size_t i = 0; i < count; ++i) {
    const Entry& entry = entries[i];
    const NodeSummary& node = *entry.node;
    const std::string head = std::string(node.used ? "* " : "  ") +
                             padded(nameOf(node.name, node.id), nameColumns, false) + "  " +
                             padded(clipped(node.id, longestId), idColumns, false) + "  ";
    std::string remark = entry.remark;
    addRemark(remark, node.transform.empty() ? "" : "under " + clipped(node.transform, longestId));
    const bool fits = characters(head) + characters(remark) <= width;
    page.table("", {{fits ? head + remark : head}}, "");
    if (!fits)
      page.paragraph("      ", remark);
    if (!node.problem.empty())
      page.paragraph("      problem: ", node.problem);
    page.table("      ", entry.rows, ">> >>");
  }
  if (entries.size() > count)
    page.paragraph("  ", "and " + std::to_string(entries.size() - count) +
                             " more (--json lists them all)");
}

// ---- lists
// ---------------------------------------------------------------------------------------

std::vector<Row> segmentRows(const SegmentationSummary& segmentation) {
  std::vector<Row> rows;
  if (segmentation.segments.empty())
    return rows;
  rows.push_back({"value", "layer", "color", "voxels", "ml", "id", "name"});
  for (const SegmentSummary& segment : segmentation.segments) {
    if (rows.size() > mostSegments)
      break;
    char milliliters[32];
    std::snprintf(milliliters, sizeof milliliters, "%.2f", segment.milliliters);
    rows.push_back({std::to_string(segment.labelValue), std::to_string(segment.layer),
                    hex(segment.color), std::to_string(segment.voxels), milliliters,
                    clipped(segment.id, 20),
                    clipped(segment.name, 24) + (segment.shown ? "" : " (hidden)")});
  }
  if (segmentation.segments.size() >= rows.size())
    rows.push_back({"...", "", "", "", "",
                    std::to_string(segmentation.segments.size() - rows.size() + 1) +
                        " more (--json lists them all)"});
  return rows;
}

Entry segmentationEntry(const SegmentationSummary& segmentation) {
  Entry entry{.node = &segmentation.node, .remark = segmentation.isLabelMap ? "label map" : ""};
  addRemark(entry.remark, segmentation.shown ? "" : "hidden");
  addRemark(entry.remark, filesOf(segmentation.node));
  if (segmentation.node.problem.empty())
    addRemark(entry.remark, grid(segmentation.size, segmentation.spacing));
  entry.rows = segmentRows(segmentation);
  return entry;
}

Entry renderingEntry(const RenderingSummary& rendering) {
  Entry entry{.node = &rendering.node, .remark = rendering.shown ? "" : "hidden"};
  addRemark(entry.remark, rendering.volume.empty() ? "of no volume" : "of " + rendering.volume);
  if (!rendering.property.empty())
    addRemark(entry.remark, "by " + rendering.property);
  if (rendering.followsDisplay)
    addRemark(entry.remark, "follows the slice display");
  if (!rendering.roi.empty())
    addRemark(entry.remark,
              (rendering.cropping ? "cropped by " : "cropping off, ") + rendering.roi);
  entry.remark = oneLine(entry.remark);
  return entry;
}

Entry viewEntry(const ViewSummary& view) {
  Entry entry{.node = &view.node};
  addRemark(entry.remark, view.layout.empty() ? "" : "layout " + clipped(view.layout, longestName));
  addRemark(entry.remark, clipped(view.technique, longestName));
  addRemark(entry.remark, "background " + colors(view.bottom, view.top));
  return entry;
}

Entry cameraEntry(const CameraSummary& camera) {
  Entry entry{.node = &camera.node};
  addRemark(entry.remark,
            camera.layout.empty() ? "" : "layout " + clipped(camera.layout, longestName));
  addRemark(entry.remark, camera.pose ? pose(*camera.pose) : "");
  return entry;
}

Entry transformEntry(const TransformSummary& transform) {
  Entry entry{.node = &transform.node, .remark = transform.toWorld ? "linear" : ""};
  addRemark(entry.remark, filesOf(transform.node));
  return entry;
}

template <typename Items, typename ToEntry>
std::vector<Entry> entries(const Items& items, ToEntry&& toEntry) {
  std::vector<Entry> result;
  for (const auto& item : items)
    result.push_back(toEntry(item));
  return result;
}

Entry nodeEntry(const NodeSummary& node) {
  return {.node = &node, .remark = filesOf(node)};
}

void listSeries(Page& page, const std::vector<SeriesSummary>& series) {
  if (series.empty())
    return;
  page.heading("DICOM series");
  std::vector<Row> rows = {{"number", "files", "modality", "description", "uid"}};
  for (const SeriesSummary& one : series)
    rows.push_back({clipped(one.number, 8), std::to_string(one.files), clipped(one.modality, 8),
                    clipped(one.description, 24), clipped(one.uid, 64)});
  page.table("  ", rows, ">>");
}

void listOthers(Page& page, const std::map<std::string, std::size_t>& others) {
  std::string text;
  for (const auto& [tag, count] : others)
    text += (text.empty() ? "" : ", ") + clipped(tag, longestName) +
            (count > 1 ? " (" + std::to_string(count) + ")" : "");
  if (others.empty())
    return;
  page.heading("Other nodes");
  page.paragraph("  ", text);
}

// ---- the render
// ----------------------------------------------------------------------------------

std::string lookText(const LookUse& look) {
  switch (look.source) {
  case LookSource::volumeProperty:
    return named(look.name, look.id);
  case LookSource::volumeDisplay:
    return "the window of " + named(look.name, look.id) + ", which the rendering follows";
  case LookSource::preset:
    return "preset " + look.name + ", by the volume's range";
  case LookSource::range:
    break;
  }
  return "made for the volume's range";
}

std::string volumeText(const VolumeUse& volume) {
  std::string text = named(volume.name, volume.id) + ": " + grid(volume.size, volume.spacing) +
                     ", " + volume.voxelType + " from " + number(volume.minimum) + " to " +
                     number(volume.maximum) + ", centre " + joined(volume.center, ",");
  for (const std::string& transform : volume.transforms)
    text += ", moved by " + clipped(transform, longestId);
  return text;
}

void showUse(Page& page, const RenderUse& use) {
  if (use.volume)
    page.paragraph("  volume        ", volumeText(*use.volume));
  if (use.look)
    page.paragraph("  look          ", lookText(*use.look));
  if (use.crop)
    page.paragraph("  crop          ", named(use.crop->name, use.crop->id) + ": " +
                                           joined(use.crop->edges, " x ") + " mm around " +
                                           joined(use.crop->center, ","));
  if (use.camera) {
    const std::string name = named(use.camera->name, use.camera->id);
    page.paragraph("  camera        ",
                   (name.empty() ? "framed" : name) + ": " + pose(use.camera->pose));
  }
  if (use.background)
    page.paragraph("  background    ", colors(use.background->bottom, use.background->top) +
                                           ", of " + clipped(use.background->view, longestId));
  if (!use.segmentationProblem.empty())
    page.paragraph("  segmentation  ", "open: " + use.segmentationProblem);
  else if (!use.segmentation.empty())
    page.paragraph("  segmentation  ", use.segmentation + ", with --focus");
  std::string stored;
  for (const std::string& argument : use.stored)
    stored += (stored.empty() ? "" : " ") + argument;
  if (!stored.empty())
    page.paragraph("  as rendered   ", stored);
}

bool isEmpty(const RenderUse& use) {
  return !use.volume && !use.look && !use.crop && !use.camera && !use.background &&
         use.segmentation.empty() && use.segmentationProblem.empty() && use.stored.empty();
}

void showRender(Page& page, const Inspection& inspection) {
  const bool refused = !inspection.refused.empty();
  if (refused) {
    page.blank();
    page.paragraph("", "A render would be refused: " + inspection.refused);
  }
  if (!inspection.render || isEmpty(*inspection.render))
    return;
  page.heading(refused ? "It would use, as far as that can be read" : "A render would use");
  showUse(page, *inspection.render);
}

void showLines(Page& page, const std::string& heading, const std::vector<std::string>& lines) {
  if (lines.empty())
    return;
  page.heading(heading);
  for (const std::string& line : lines)
    page.paragraph("  - ", line);
}

} // namespace

std::string inspectionText(const Inspection& inspection, const std::string& input) {
  static constexpr const char* kinds[] = {"Slicer scene", "volume", "segmentation or label map",
                                          "DICOM folder"};
  Page page;
  page.paragraph("", input + ": " + kinds[static_cast<std::size_t>(inspection.kind)] +
                         (inspection.version.empty() ? "" : ", version " + inspection.version));
  listNodes(page, "Volumes", entries(inspection.volumes, nodeEntry));
  listSeries(page, inspection.series);
  listNodes(page, "Segmentations", entries(inspection.segmentations, segmentationEntry));
  listNodes(page, "Volume renderings", entries(inspection.renderings, renderingEntry));
  listNodes(page, "Volume properties", entries(inspection.properties, nodeEntry));
  listNodes(page, "Regions of interest", entries(inspection.rois, nodeEntry));
  listNodes(page, "Views", entries(inspection.views, viewEntry));
  listNodes(page, "Cameras", entries(inspection.cameras, cameraEntry));
  listNodes(page, "Transforms", entries(inspection.transforms, transformEntry));
  listOthers(page, inspection.others);
  showRender(page, inspection);
  showLines(page, "Warnings", inspection.warnings);
  showLines(page, "Ignored", inspection.ignored);
  return std::move(page).text();
}

} // namespace fenestra
