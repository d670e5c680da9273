#include "files/segments/SegmentationReader.h"

#include "base/Error.h"
#include "base/safe/Inputs.h"
#include "base/safe/ShownText.h"
#include "files/medical/MedicalImage.h"
#include "files/medical/SampleStore.h"
#include "files/segments/ClosedSurface.h"
#include "files/segments/LabelSearch.h"
#include "files/segments/SegmentMask.h"
#include "files/segments/SegmentTags.h"

#include <functional>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace fenestra {
namespace {

constexpr std::size_t mostSegments = 65536;

// ---- labels

using LabelStore = SampleStore<std::uint8_t, std::int16_t, std::int32_t>;

Segmentation::Labels toLabels(LabelStore&& samples, const std::string& source) {
  const SampleSurvey& s = samples.survey();
  if (!s.whole || !s.finite())
    throw inputError(
        source,
        "holds values that are not whole numbers, so it is no labelmap; name a segmentation");
  if (!samples.holdsAll())
    throw inputError(source, "holds label values beyond 32 bits; number its labels again");
  return samples.take();
}

/// Values of a labelmap other than 0.
std::set<std::int32_t> valuesOf(const Segmentation::Labels& labels, const std::string& source) {
  std::set<std::int32_t> values;
  std::visit(
      [&](const auto& voxels) {
        std::int32_t last = 0;
        for (const std::int32_t value : voxels)
          if (value != std::exchange(last, value) && value != 0 && values.insert(value).second &&
              values.size() > mostSegments)
            throw inputError(source, "holds more than 65536 different values, so it is no "
                                     "labelmap; name a segmentation");
      },
      labels);
  return values;
}

/// Segments of a labelmap, one per value, in ascending order.
std::vector<SegmentInfo> segmentsOf(const std::set<std::int32_t>& values, const LabelNames& names) {
  std::vector<SegmentInfo> segments;
  for (const std::int32_t value : values) {
    const std::string id = textOf("Segment_", value);
    SegmentInfo info{.id = id, .name = id, .labelValue = value};
    if (const auto named = names.find(value); named != names.end()) {
      info.name = named->second.name;
      info.color = named->second.color.value_or(info.color);
    }
    segments.push_back(std::move(info));
  }
  return segments;
}

void refuseLabels(const std::string& source, const std::optional<std::string>& labels) {
  if (labels)
    throw inputError(source, "names its segments itself; leave out --labels");
}

// ---- Slicer's header fields

/// Grid of the file's voxels. The oldest files keep the geometry of the whole reference image, in
/// RAS, and state in Segmentation_Extent which part of it their voxels are. (With this
/// offset the bladder of such a file lies at the same patient's bladder surface.)
Grid placed(const Grid& grid, const std::map<std::string, std::string>& fields,
            const std::string& source) {
  const auto extent = fields.find("Segmentation_Extent");
  if (extent == fields.end())
    return grid;
  std::vector<double> numbers; // i0 i1 j0 j1 k0 k1
  for (const std::string& word : words(extent->second))
    numbers.push_back(parsed<std::int32_t>(word).value_or(infinity));
  if (numbers.size() != 6 || std::ranges::count(numbers, infinity) > 0)
    throw inputError(source, "Segmentation_Extent: must be six whole numbers");
  const Vec3 first(numbers[0], numbers[2], numbers[4]);
  return {grid.size, Affine(lpsToRas) * grid.indexToWorld * translationBy(first)};
}

class SegmentFields {
public:
  SegmentFields(const std::map<std::string, std::string>& fields, const std::string& source)
      : m_fields(fields), m_source(source) {}

  std::vector<SegmentInfo> segments(std::size_t layerCount) const {
    for (const char* field :
         {"Segmentation_MasterRepresentation", "Segmentation_SourceRepresentation"})
      if (const auto it = m_fields.find(field);
          it != m_fields.end() && it->second.starts_with("Fractional"))
        throw inputError(m_source, field,
                         ": is a fractional labelmap, which is not read; export the segmentation "
                         "in Slicer as a binary labelmap (.seg.nrrd)");
    std::vector<SegmentInfo> segments;
    while (find(segments.size(), "ID") && segments.size() < mostSegments)
      segments.push_back(segment(segments.size(), layerCount));
    return segments;
  }

private:
  static std::string key(std::size_t n, const std::string& field) {
    return textOf("Segment", n, '_', field);
  }

  const std::string* find(std::size_t n, const std::string& field) const {
    const auto it = m_fields.find(key(n, field));
    return it == m_fields.end() ? nullptr : &it->second;
  }

  std::int32_t number(std::size_t n, const std::string& field, std::int32_t fallback) const {
    const std::string* text = find(n, field);
    if (!text)
      return fallback;
    const auto value = parsed<std::int32_t>(*text);
    if (!value)
      throw inputError(m_source, key(n, field), ": must be a whole number");
    return *value;
  }

  SegmentInfo segment(std::size_t n, std::size_t layerCount) const {
    SegmentInfo info;
    info.id = *find(n, "ID");
    const std::string* name = find(n, "Name");
    info.name = name ? *name : info.id;
    info.labelValue = number(n, "LabelValue", 1);
    if (info.labelValue == 0)
      throw inputError(m_source, key(n, "LabelValue"), ": 0 is the background; use another");
    // Older files state no layer: with several layers it is the segment's own.
    const std::int32_t layer =
        number(n, "Layer", layerCount == 1 ? 0 : static_cast<std::int32_t>(n));
    if (std::cmp_less(layer, 0) || std::cmp_greater_equal(layer, layerCount))
      throw inputError(m_source, key(n, "Layer"), ": is ", layer, ", but the file has ", layerCount,
                       " layers; save it again");
    info.layer = static_cast<std::size_t>(layer);
    info.color = color(n, info.color);
    if (const std::string* tags = find(n, "Tags"))
      readTerminology(*tags, info);
    return info;
  }

  /// Colour of segment n, as decoration: `fallback` if missing or malformed.
  Rgb color(std::size_t n, const Rgb& fallback) const {
    const std::string* text = find(n, "Color") ? find(n, "Color") : find(n, "DefaultColor");
    const auto numbers = text ? parseNumbers(*text) : std::nullopt;
    if (!numbers || numbers->size() < 3)
      return fallback;
    const Rgb rgb((*numbers)[0], (*numbers)[1], (*numbers)[2]);
    return (rgb >= 0.0).all() && (rgb <= 1.0).all() ? rgb : fallback;
  }

  const std::map<std::string, std::string>& m_fields;
  const std::string& m_source;
};

// ---- statistics

struct ValueStatistics {
  std::int64_t voxels = 0;
  VoxelExtent extent = {};
};

using StatisticsOfValues = std::map<std::int32_t, ValueStatistics>;

/// Adds one layer's voxels to the statistics of the values in `values`.
template <typename Label>
void countVoxels(const std::vector<Label>& labels, const Size3& size, std::size_t layer,
                 std::size_t layerCount, StatisticsOfValues& values) {
  std::size_t at = layer;
  std::int32_t last = 0; // labels come in runs
  ValueStatistics* counted = nullptr;
  for (std::int64_t z = 0; z < size.z(); ++z)
    for (std::int64_t y = 0; y < size.y(); ++y)
      for (std::int64_t x = 0; x < size.x(); ++x, at += layerCount) {
        const std::int32_t label = labels[at];
        if (label != std::exchange(last, label)) {
          const auto found = values.find(label);
          counted = found == values.end() ? nullptr : &found->second;
        }
        if (counted) {
          ++counted->voxels;
          counted->extent.add({{x, y, z}, {x, y, z}});
        }
      }
}

/// Bounds of whole voxels, along the world's axes.
Box worldBounds(const Grid& grid, const VoxelExtent& extent) {
  const Box voxels{extent.lower.cast<double>().array() - 0.5,
                   extent.upper.cast<double>().array() + 0.5};
  Box bounds{Vec3::Constant(infinity), Vec3::Constant(-infinity)};
  for (int i = 0; i < 8; ++i) {
    const Vec3 corner = grid.indexToWorld * voxels.corner(i);
    bounds.lower = bounds.lower.cwiseMin(corner);
    bounds.upper = bounds.upper.cwiseMax(corner);
  }
  return bounds;
}

// ---- messages

std::string listed(const std::vector<SegmentInfo>& segments) {
  const auto named = [](const SegmentInfo& segment) {
    const std::string id = shown(segment.id);
    return segment.name == segment.id ? id : textOf(id, " (", shown(segment.name), ')');
  };
  return joined(segments, ", ", named, 40);
}

} // namespace

Segmentation::Labels interleaved(Segmentation::Labels layers, std::size_t count) {
  if (count == 1)
    return layers;
  return std::visit(
      [count](const auto& labels) -> Segmentation::Labels {
        std::decay_t<decltype(labels)> together(labels.size());
        const std::size_t voxels = labels.size() / count;
        for (std::size_t layer = 0; layer < count; ++layer)
          for (std::size_t voxel = 0; voxel < voxels; ++voxel)
            together[voxel * count + layer] = labels[layer * voxels + voxel];
        return together;
      },
      layers);
}

Segmentation::Segmentation(std::string source, Grid grid, std::size_t layerCount, Labels labels,
                           std::vector<SegmentInfo> segments)
    : m_source(std::move(source)),
      m_grid(grid),
      m_layerCount(layerCount),
      m_labels(std::move(labels)),
      m_segments(std::move(segments)) {}

const SegmentInfo& Segmentation::find(const std::string& selector) const {
  using Matches = std::function<bool(const SegmentInfo&)>;
  const auto value = parsed<std::int32_t>(selector);
  for (const Matches& matches :
       {Matches([&](const SegmentInfo& s) { return s.id == selector; }),
        Matches([&](const SegmentInfo& s) { return s.name == selector; }),
        Matches([&](const SegmentInfo& s) { return value == s.labelValue; })}) {
    const auto found = std::ranges::find_if(m_segments, matches);
    if (found == m_segments.end())
      continue;
    std::vector<SegmentInfo> all;
    std::ranges::copy_if(m_segments, std::back_inserter(all), matches);
    if (all.size() > 1)
      throw inputError(m_source, "segment \"", shown(selector), "\" can be any of ", listed(all),
                       "; name one by its id");
    return *found;
  }
  throw inputError(m_source, "has no segment \"", shown(selector), "\"; it has ",
                   m_segments.empty() ? "none at all" : listed(m_segments));
}

std::vector<SegmentStatistics> Segmentation::statistics() const {
  std::vector<StatisticsOfValues> layers(m_layerCount);
  for (const SegmentInfo& segment : m_segments)
    layers[segment.layer][segment.labelValue] = {};
  std::visit(
      [&](const auto& labels) {
        for (std::size_t layer = 0; layer < m_layerCount; ++layer)
          countVoxels(labels, m_grid.size, layer, m_layerCount, layers[layer]);
      },
      m_labels);
  std::vector<SegmentStatistics> statistics;
  for (const SegmentInfo& segment : m_segments) {
    const ValueStatistics& value = layers[segment.layer].at(segment.labelValue);
    statistics.push_back({value.voxels, {}});
    if (value.voxels > 0)
      statistics.back().bounds = worldBounds(m_grid, value.extent);
  }
  return statistics;
}

Mask Segmentation::mask(const std::vector<std::string>& selectors, const Grid& volume,
                        const MaskShaping& shaping) const {
  if (shaping.margins.size() > 1 && shaping.margins.size() != selectors.size())
    throw usageError("--margin: give one for all segments of --focus, or one each");
  std::vector<SegmentInfo> chosen;
  for (const std::string& selector : selectors)
    chosen.push_back(find(selector));
  const auto maskOf = [&](const std::vector<SegmentInfo>& segments) {
    Mask mask;
    for (const SegmentInfo& segment : segments)
      mask.names.push_back(segment.name);
    fillMask(m_grid, m_layerCount, m_labels, segments, volume, mask);
    if (mask.count == 0)
      throw inputError(m_source, "the focus has no voxel (", listed(segments),
                       "); choose segments that are not empty");
    return mask;
  };
  if (shaping == MaskShaping())
    return maskOf(chosen);
  const auto shaped = [&](const std::vector<SegmentInfo>& segments, double margin) {
    const Mask mask = maskOf(segments);
    return grown(shaping.smoothing > 0.0 ? betweenSlices(mask) : mask, margin, volume);
  };
  std::vector<Mask> masks;
  if (shaping.margins.size() <= 1) // the union first: no gaps where segments touch
    masks.push_back(shaped(chosen, shaping.margins.empty() ? 0.0 : shaping.margins[0]));
  else
    for (std::size_t i = 0; i < chosen.size(); ++i)
      masks.push_back(shaped({chosen[i]}, shaping.margins[i]));
  Mask mask = smoothed(united(masks), shaping.smoothing, volume);
  if (mask.count == 0)
    throw inputError(m_source, "--margin and --labelsmoothing leave nothing of the focus (",
                     listed(chosen), "); choose a margin nearer to 0, or less smoothing");
  return mask;
}

std::vector<SegmentInfo> readSegmentInfos(const std::filesystem::path& path,
                                          const std::optional<std::string>& labels) {
  if (lowerExtension(path) == ".vtm")
    return readClosedSurfaceInfos(path);
  const std::string source = path.string();
  std::vector<SegmentInfo> segments;
  bool mayBeNamed = false;
  readMedicalImage(path, Components::any, [&](const MedicalImage& image, const SampleSource&) {
    segments = SegmentFields(image.fields, source).segments(image.components);
    mayBeNamed = segments.empty() && hasLabelNames(path, image.extensions, labels);
  });
  if (!mayBeNamed)
    return segments;
  const Segmentation named = readSegmentation(path, nullptr, labels);
  return named.namesFrom().empty() ? segments : named.segments();
}

Segmentation readSegmentation(const std::filesystem::path& path, const Grid* reference,
                              const std::optional<std::string>& wanted) {
  const std::string source = path.string();
  if (lowerExtension(path) == ".vtm") {
    refuseLabels(source, wanted);
    return readClosedSurfaces(path, reference);
  }
  MedicalImage image;
  Segmentation::Labels labels;
  readMedicalImage(path, Components::any, [&](const MedicalImage& read, const SampleSource& from) {
    LabelStore samples(from.count);
    readSamples(from, samples);
    labels = toLabels(std::move(samples), source);
    image = read;
  });
  if (image.frames)
    labels = interleaved(std::move(labels), image.components);
  auto segments = SegmentFields(image.fields, source).segments(image.components);
  if (segments.empty() && image.components > 1)
    throw inputError(source, "has ", image.components,
                     " components a voxel but names no segments; name a segmentation");
  FoundNames found;
  if (!segments.empty()) {
    refuseLabels(source, wanted);
  } else {
    const std::set<std::int32_t> values = valuesOf(labels, source);
    found = findLabelNames(path, values, image.extensions, wanted);
    segments = segmentsOf(values, found.names);
  }
  Segmentation segmentation(source, placed(image.grid, image.fields, source), image.components,
                            std::move(labels), std::move(segments));
  segmentation.setNamesFrom(std::move(found.source), std::move(found.warnings));
  return segmentation;
}

} // namespace fenestra
