#include "files/segments/SegmentationReader.h"

#include "base/Error.h"
#include "files/formats/TextHeader.h"
#include "files/medical/DicomReader.h"
#include "files/medical/MedicalImage.h"
#include "files/medical/NiftiForms.h"
#include "files/medical/SampleStore.h"
#include "files/segments/ClosedSurface.h"
#include "files/segments/DicomSegments.h"
#include "files/segments/LabelSearch.h"
#include "files/segments/MaskFolder.h"
#include "files/segments/MaskRuns.h"
#include "io/InputRegistry.h"
#include "io/JsonNode.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

namespace fenestra::core {
namespace {

using header::Fields;

constexpr std::size_t maxSegments = 65536;

// ---- labels

using LabelStore = SampleStore<std::uint8_t, std::int16_t, std::int32_t>;

Segmentation::Labels toLabels(LabelStore&& samples, const std::string& source) {
  const SampleStats& s = samples.stats();
  if (!s.isIntegral || !s.isFinite())
    throw inputError(
        ErrorCode::unsupportedFile, source,
        "has values that are not integers, so it is not a labelmap; give a segmentation");
  if (!samples.canHoldAll())
    throw inputError(ErrorCode::limitExceeded, source,
                     "has label values beyond 32 bits; renumber its labels");
  return samples.take();
}

/// Label values other than 0.
std::set<std::int32_t> collectValues(const Segmentation::Labels& labels,
                                     const std::string& source) {
  std::set<std::int32_t> values;
  std::visit(
      [&](const auto& voxels) {
        std::int32_t last = 0;
        for (const std::int32_t value : voxels)
          if (value != std::exchange(last, value) && value != 0 && values.insert(value).second &&
              values.size() > maxSegments)
            throw inputError(ErrorCode::limitExceeded, source,
                             "has more than 65536 different values, so it is not a "
                             "labelmap; give a segmentation");
      },
      labels);
  return values;
}

/// One segment per label value, in ascending order.
std::vector<SegmentInfo> makeSegments(const std::set<std::int32_t>& values,
                                      const LabelNames& names) {
  std::vector<SegmentInfo> segments;
  for (const std::int32_t value : values) {
    const std::string id = concat("Segment_", value);
    SegmentInfo info{.id = id, .name = id, .labelValue = value};
    if (const auto named = names.find(value); named != names.end()) {
      info.name = named->second.name;
      info.color = named->second.color.value_or(info.color);
    }
    segments.push_back(std::move(info));
  }
  return segments;
}

void rejectLabels(const std::string& source, const std::optional<std::string>& labels) {
  if (labels)
    throw inputError(ErrorCode::conflictingLabels, source, "already names its segments");
}

// ---- Slicer's header fields

/// Grid of the file's voxels. The oldest files store the geometry of the full reference image, in
/// RAS, and Segmentation_Extent states which part of it the voxels cover. (Verified: the bladder of
/// such a file then coincides with the same patient's bladder surface.)
Grid applyExtent(const Grid& grid, const Fields& fields, const std::string& source) {
  const auto extent = fields.find("Segmentation_Extent");
  if (extent == fields.end())
    return grid;
  std::vector<double> numbers; // i0 i1 j0 j1 k0 k1
  for (const std::string& word : splitWords(extent->second))
    numbers.push_back(parseNumber<std::int32_t>(word).value_or(infinity));
  if (numbers.size() != 6 || std::ranges::count(numbers, infinity) > 0)
    throw fieldError(source, "Segmentation_Extent", "must be six integers");
  const Vec3 first(numbers[0], numbers[2], numbers[4]);
  return {grid.size, Affine(lpsToRas) * grid.indexToWorld * makeTranslation(first)};
}

/// Fields of one segment: those that begin with `prefix`, like "Segment0_".
class SegmentFields {
public:
  SegmentFields(const Fields& fields, const std::string& source, std::string prefix)
      : m_fields(fields), m_source(source), m_prefix(std::move(prefix)) {}

  const std::string* find(const std::string& field) const {
    const auto it = m_fields.find(m_prefix + field);
    return it == m_fields.end() ? nullptr : &it->second;
  }

  /// Reads segment `n` of a file with `layerCount` layers; requires its ID field.
  SegmentInfo readSegment(std::size_t n, std::size_t layerCount) const {
    SegmentInfo info;
    info.id = *find("ID");
    const std::string* name = find("Name");
    info.name = name ? *name : info.id;
    info.labelValue = number("LabelValue", 1);
    if (info.labelValue == 0)
      throw fieldError(m_source, m_prefix + "LabelValue", "0 is the background; use another value");
    // Older files state no layer; if there are several, each segment has its own.
    const std::int32_t layer = number("Layer", layerCount == 1 ? 0 : static_cast<std::int32_t>(n));
    if (std::cmp_less(layer, 0) || std::cmp_greater_equal(layer, layerCount))
      throw fieldError(m_source, m_prefix + "Layer", "is ", layer, ", but the file has ",
                       layerCount, " layers; save it again");
    info.layer = static_cast<std::size_t>(layer);
    readColor(info.color);
    if (const std::string* tags = find("Tags"))
      info.parseTerminology(*tags);
    return info;
  }

private:
  std::int32_t number(const std::string& field, std::int32_t fallback) const {
    const std::string* text = find(field);
    const auto value = text ? parseNumber<std::int32_t>(*text) : fallback;
    if (!value)
      throw fieldError(m_source, m_prefix + field, "must be an integer");
    return *value;
  }

  /// Keeps `color` if the field is missing or malformed; the color is not essential.
  void readColor(Rgb& color) const {
    const std::string* text = find("Color") ? find("Color") : find("DefaultColor");
    const auto numbers = text ? parseNumbers(*text) : std::nullopt;
    if (!numbers || numbers->size() < 3)
      return;
    const Rgb rgb((*numbers)[0], (*numbers)[1], (*numbers)[2]);
    if ((rgb >= 0.0).all() && (rgb <= 1.0).all())
      color = rgb;
  }

  const Fields& m_fields;
  const std::string& m_source;
  std::string m_prefix;
};

/// Reads MITK's segments from a field: JSON, a list of groups (layers), each with its labels.
std::vector<SegmentInfo> readMitkSegments(const std::string& field, const std::string& text,
                                          const std::string& source, std::size_t layerCount) {
  const std::string place = concat(source, ": ", field);
  const nlohmann::json document = parseJson(text, place);
  std::vector<SegmentInfo> segments;
  std::size_t layer = 0;
  for (const JsonNode& group : JsonNode(document, place).elements()) {
    if (layer == layerCount)
      throw fieldError(source, field, "has more groups than the file has layers, ", layerCount);
    for (const JsonNode& label : group.at("labels").elements()) {
      const auto value = static_cast<std::int32_t>(label.at("value").number(1.0, 65535.0));
      SegmentInfo info{.id = concat("Segment_", layer, '_', value),
                       .name = label.at("name").text(),
                       .labelValue = value,
                       .layer = layer};
      if (const auto color = label.find("color"))
        if (const auto rgb = color->find("value"))
          info.color = rgb->triple(0.0, 1.0).array();
      segments.push_back(std::move(info));
    }
    ++layer;
  }
  return segments;
}

/// Reads the segments that the fields describe. Throws Error (input), also if they are fractional.
std::vector<SegmentInfo> readSegments(const Fields& fields, const std::string& source,
                                      std::size_t layerCount) {
  for (const char* field :
       {"Segmentation_MasterRepresentation", "Segmentation_SourceRepresentation"})
    if (header::findValue(fields, field).starts_with("Fractional"))
      throw fieldError(source, field,
                       "is a fractional labelmap, which is not supported; export the "
                       "segmentation in Slicer as a binary labelmap (.seg.nrrd)");
  for (const char* field : {"org_mitk_multilabel_segmentation_labelgroups",
                            "org.mitk.multilabel.segmentation.labelgroups"})
    if (const auto groups = fields.find(field); groups != fields.end())
      return readMitkSegments(field, groups->second, source, layerCount);
  std::vector<SegmentInfo> segments;
  while (segments.size() < maxSegments) {
    const SegmentFields segmentFields(fields, source, concat("Segment", segments.size(), '_'));
    if (!segmentFields.find("ID"))
      break;
    segments.push_back(segmentFields.readSegment(segments.size(), layerCount));
  }
  return segments;
}

/// True if the grid has spacing 1 and origin 0, the position of an array.
bool hasArrayPosition(const Grid& grid) {
  constexpr double tolerance = 1e-6; // mm
  const Affine& map = grid.indexToWorld;
  bool isUnit = map.translation().norm() <= tolerance;
  for (int axis = 0; axis < 3; ++axis)
    isUnit = isUnit && std::abs(std::abs(map.linear()(axis, axis)) - 1.0) <= tolerance &&
             std::abs(map.linear().col(axis).norm() - 1.0) <= tolerance;
  return isUnit;
}

/// Box of the centers of the outermost voxels, mm.
Box findCenterBounds(const Grid& grid) {
  Box bounds = Box::makeEmpty();
  for (int corner = 0; corner < 8; ++corner) {
    const auto last = [&](int axis) {
      return (corner >> axis & 1) != 0 ? static_cast<double>(grid.size[axis] - 1) : 0.0;
    };
    bounds.extend(grid.indexToWorld * Vec3(last(0), last(1), last(2)));
  }
  return bounds;
}

} // namespace

/// Format: "...|TerminologyEntry:LIST~CATEGORY~TYPE~MODIFIER~LIST~REGION~MODIFIER|...", each part
/// SCHEME^VALUE^MEANING (vtkSegment, vtkSlicerTerminologiesModuleLogic).
void SegmentInfo::parseTerminology(std::string_view tags) {
  constexpr std::string_view key = "TerminologyEntry:";
  const std::size_t at = tags.find(key);
  if (at == std::string_view::npos)
    return;
  tags.remove_prefix(at + key.size());
  const std::vector<std::string> parts = split(tags.substr(0, tags.find('|')), '~');
  for (const auto& [place, code] : {std::pair(1U, &category), {2U, &type}, {5U, &region}})
    if (const std::size_t meaning = place < parts.size() ? parts[place].rfind('^') : 0;
        meaning != std::string::npos && meaning > 1)
      *code = parts[place].substr(0, meaning);
}

std::vector<Message> checkPosition(const std::string& source, const Grid& labels,
                                   const Grid& volume) {
  const Box own = findCenterBounds(labels), other = findCenterBounds(volume);
  const double apart = std::max((own.lower - other.lower).norm(), (own.upper - other.upper).norm());
  if (labels.size != volume.size || apart < 0.5) // mm
    return {};
  return {makeMessage(ErrorCode::assumedGeometry, source, "has the size of the volume, but ",
                      hasArrayPosition(labels)
                          ? "spacing 1 and origin 0, as after the loss of its header"
                          : concat("lies up to ", toString(apart, 3), " mm apart from it"),
                      "; segments are shown where it says")};
}

Segmentation::Labels interleaveLayers(Segmentation::Labels layers, std::size_t count) {
  if (count == 1)
    return layers;
  return std::visit(
      [count](const auto& labels) -> Segmentation::Labels {
        std::decay_t<decltype(labels)> result(labels.size());
        const std::size_t voxels = labels.size() / count;
        for (std::size_t layer = 0; layer < count; ++layer)
          for (std::size_t voxel = 0; voxel < voxels; ++voxel)
            result[voxel * count + layer] = labels[layer * voxels + voxel];
        return result;
      },
      layers);
}

Segmentation makeLabelMap(const std::string& source, const Grid& grid, const SampleSource& samples,
                          const LabelNames& names) {
  LabelStore store(samples.count);
  readSamples(samples, store);
  Segmentation::Labels labels = toLabels(std::move(store), source);
  std::vector<SegmentInfo> segments = makeSegments(collectValues(labels, source), names);
  return {source, grid, 1, std::move(labels), std::move(segments)};
}

std::vector<SegmentInfo> readSegmentInfos(const std::filesystem::path& path,
                                          const std::optional<std::string>& labels) {
  if (isFolder(path))
    return readMaskFolderInfos(path);
  if (lowercaseExtension(path) == ".vtm")
    return readClosedSurfaceInfos(path);
  if (isDicomFile(path))
    return readDicomSegmentInfos(path);
  const std::string source = path.string();
  std::vector<SegmentInfo> segments;
  readMedicalImage(path, Components::any, [&](const MedicalImage& image, const SampleSource&) {
    segments = readSegments(image.fields, source, image.components);
  });
  if (!segments.empty())
    return segments;
  const Segmentation named = readSegmentation(path, nullptr, labels);
  const auto isNamed = [](const SegmentInfo& segment) { return segment.name != segment.id; };
  return std::ranges::any_of(named.segments(), isNamed) ? named.segments() : segments;
}

Segmentation readSegmentation(const std::filesystem::path& path, const Grid* reference,
                              const std::optional<std::string>& labelTable) {
  const std::string source = path.string();
  if (isFolder(path)) {
    rejectLabels(source, labelTable);
    return readMaskFolder(path, reference);
  }
  if (lowercaseExtension(path) == ".vtm") {
    rejectLabels(source, labelTable);
    return readClosedSurfaces(path, reference);
  }
  if (isDicomFile(path)) {
    rejectLabels(source, labelTable);
    return readDicomSegments(path, reference);
  }
  MedicalImage image;
  Segmentation::Labels labels;
  bool isMap = true; // else a map of probabilities
  const VolumeChoice choice = chooseFormByVolume(path, reference);
  const auto consume = [&](const MedicalImage& read, const SampleSource& from) {
    LabelStore samples(from.count);
    readSamples(from, samples);
    isMap = !isProbability(samples.stats()) || read.components > 1;
    if (isMap)
      labels = toLabels(std::move(samples), source);
    image = read;
  };
  readMedicalImage(path, Components::any, consume, choice);
  if (!isMap)
    std::tie(image.grid, labels) = labelMask(readMask(path, choice), 1);
  if (image.hasFrames)
    labels = interleaveLayers(std::move(labels), image.components);
  auto segments = readSegments(image.fields, source, image.components);
  if (segments.empty() && image.components > 1)
    throw inputError(ErrorCode::unsupportedFile, source, "has ", image.components,
                     " components per voxel but names no segments; give a segmentation");
  FoundNames found;
  if (!segments.empty()) {
    rejectLabels(source, labelTable);
  } else {
    const std::set<std::int32_t> values = collectValues(labels, source);
    found = findLabelNames(path, values, image.extensions, labelTable);
    segments = makeSegments(values, found.names);
  }
  Segmentation segmentation(source, applyExtent(image.grid, image.fields, source), image.components,
                            std::move(labels), std::move(segments));
  segmentation.setNamesSource(std::move(found.source));
  segmentation.addWarnings(image.warnings);
  segmentation.addWarnings(found.warnings);
  if (reference)
    segmentation.addWarnings(checkPosition(source, segmentation.grid(), *reference));
  return segmentation;
}

} // namespace fenestra::core
