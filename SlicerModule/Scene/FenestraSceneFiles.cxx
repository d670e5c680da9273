#include "FenestraSceneFiles.h"

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <memory>
#include <sstream>

namespace SlicerExport {
namespace {

std::string formatMatrix(const Matrix& matrix) {
  std::ostringstream text;
  text.precision(17);
  for (std::size_t i = 0; i < matrix.size(); ++i)
    text << (i == 0 ? "" : " ") << matrix[i];
  return text.str();
}

void writeText(const std::string& text, const std::filesystem::path& file) {
  std::ofstream out(file, std::ios::binary);
  out << text;
  out.close();
  if (!out)
    throw makeWriteError(file);
}

/// Text of a scene, one node per line. Values never come from users, so nothing needs escaping.
class Nodes {
public:
  using Attributes = std::vector<std::pair<std::string, std::string>>;

  void add(const std::string& tag, const std::string& id, const Attributes& attributes) {
    m_text << " <" << tag << " id=\"" << id << "\" name=\"" << id << '"';
    for (const auto& [name, value] : attributes)
      if (!value.empty())
        m_text << ' ' << name << "=\"" << value << '"';
    m_text << "></" << tag << ">\n";
  }
  /// Returns the reference to the transform; empty for the identity.
  std::string addTransform(const std::string& id, const Matrix& toWorld) {
    if (toWorld == identity)
      return {};
    add("LinearTransform", id, {{"matrixTransformToParent", formatMatrix(toWorld)}});
    return "transform:" + id + ";";
  }
  std::string text() const {
    return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<MRML version=\"Slicer 5.2\" "
           "userTags=\"\">\n" +
           m_text.str() + "</MRML>\n";
  }

private:
  std::ostringstream m_text;
};

void addVolume(Nodes& nodes, const Contents& contents) {
  std::string references = nodes.addTransform("VolumeToWorld", contents.volumeToWorld);
  references += "storage:VolumeStorage;";
  if (!contents.property.empty() || !contents.crop.empty()) {
    std::string rendering;
    if (!contents.property.empty()) {
      nodes.add("VolumePropertyStorage", "PropertyStorage",
                {{"fileName", "property" + contents.propertyExtension}});
      nodes.add("VolumeProperty", "Property", {{"references", "storage:PropertyStorage;"}});
      rendering = "volumeProperty:Property;";
    }
    if (!contents.crop.empty())
      rendering += "roi:Roi;";
    nodes.add("GPURayCastVolumeRendering", "Rendering",
              {{"visibility", "true"},
               {"croppingEnabled", contents.crop.empty() ? "0" : "1"},
               {"references", rendering}});
    references += "display:Rendering;";
  }
  nodes.add("VolumeArchetypeStorage", "VolumeStorage",
            {{"fileName", "volume.nrrd"}, {"UseOrientationFromFile", "1"}});
  nodes.add("Volume", "Volume", {{"references", references}});
}

std::string makeSceneText(const Contents& contents) {
  Nodes nodes;
  if (!contents.crop.empty()) {
    const std::string transform = nodes.addTransform("RoiToWorld", contents.crop.front().toWorld);
    nodes.add("MarkupsROIJsonStorage", "RoiStorage", {{"fileName", "roi.mrk.json"}});
    nodes.add("MarkupsROI", "Roi", {{"references", transform + "storage:RoiStorage;"}});
  }
  addVolume(nodes, contents);
  std::string references = "volume:Volume;";
  const Segmentation& segmentation = contents.segmentation;
  if (!segmentation.segments.empty()) {
    const std::string transform = nodes.addTransform("SegmentationToWorld", segmentation.toWorld);
    nodes.add("SegmentationStorage", "SegmentationStorage",
              {{"fileName", "segmentation.seg.nrrd"}});
    nodes.add("Segmentation", "Segmentation",
              {{"references", transform + "storage:SegmentationStorage;"}});
    references += "segmentation:Segmentation;";
  }
  nodes.add("FenestraRender", "Render", {{"references", references}});
  return nodes.text();
}

/// Replaces line ends, which would end an NRRD field.
std::string toOneLine(std::string text) {
  for (char& c : text)
    if (c == '\n' || c == '\r')
      c = ' ';
  return text;
}

/// Color with six digits, as Slicer saves it: the saved scene then renders bit for bit the same.
std::string formatColor(const std::array<double, 3>& color) {
  std::ostringstream text;
  text << color[0] << ' ' << color[1] << ' ' << color[2];
  return text.str();
}

Image makeSegmentationImage(const Segmentation& segmentation) {
  Image image = composeLayers(segmentation.layers);
  image.fields["Segmentation_MasterRepresentation"] = "Binary labelmap";
  std::ostringstream extent;
  for (std::size_t axis = 0; axis < 3; ++axis)
    extent << (axis == 0 ? "" : " ") << 0 << ' ' << image.size[axis] - 1;
  for (std::size_t i = 0; i < segmentation.segments.size(); ++i) {
    const Segment& segment = segmentation.segments[i];
    const std::string prefix = "Segment" + std::to_string(i) + "_";
    image.fields[prefix + "ID"] = toOneLine(segment.id);
    image.fields[prefix + "Name"] = toOneLine(segment.name);
    image.fields[prefix + "LabelValue"] = std::to_string(segment.label);
    image.fields[prefix + "Layer"] = std::to_string(segment.layer);
    image.fields[prefix + "Extent"] = extent.str();
    image.fields[prefix + "Color"] = formatColor(segment.color);
    if (!segment.tags.empty())
      image.fields[prefix + "Tags"] = toOneLine(segment.tags);
  }
  return image;
}

/// Copies a layer's labels into its component of a larger image, whose first voxel has grid index
/// `begin`; `out`: that component of the first voxel.
template <typename From, typename To>
void copyLayer(const Layer& layer, const Image& box, const std::array<long, 3>& begin, To* out) {
  const auto* in = static_cast<const From*>(layer.labels.data.get());
  std::array<std::size_t, 3> shift{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    shift[axis] = static_cast<std::size_t>(layer.begin[axis] - begin[axis]);
  const auto& size = layer.labels.size;
  for (std::size_t k = 0; k < size[2]; ++k)
    for (std::size_t j = 0; j < size[1]; ++j) {
      const std::size_t row = (k + shift[2]) * box.size[1] + j + shift[1];
      To* to = out + (row * box.size[0] + shift[0]) * box.components;
      for (std::size_t i = 0; i < size[0]; ++i)
        to[i * box.components] = static_cast<To>(*in++);
    }
}

template <typename To>
void copyLayerAs(const Layer& layer, const Image& box, const std::array<long, 3>& begin, To* out) {
  const std::string& type = layer.labels.type;
  if (type == "uint8")
    copyLayer<std::uint8_t>(layer, box, begin, out);
  else if (type == "int8")
    copyLayer<std::int8_t>(layer, box, begin, out);
  else if (type == "int16")
    copyLayer<std::int16_t>(layer, box, begin, out);
  else if (type == "uint16")
    copyLayer<std::uint16_t>(layer, box, begin, out);
  else if (type == "int32")
    copyLayer<std::int32_t>(layer, box, begin, out);
  else
    throw FileError("segmentation: labels must be integers, but are " + type +
                    "; create its binary labelmap again");
}

template <typename To>
std::shared_ptr<const void> composeData(const std::vector<Layer>& layers, const Image& box,
                                        const std::array<long, 3>& begin) {
  const auto data = std::make_shared<std::vector<To>>(box.bytes() / sizeof(To));
  for (std::size_t i = 0; i < layers.size(); ++i)
    copyLayerAs(layers[i], box, begin, data->data() + i);
  return {data, data->data()};
}

} // namespace

Image composeLayers(const std::vector<Layer>& layers) {
  if (layers.empty())
    return {};
  if (layers.size() == 1)
    return layers.front().labels;
  std::array<long, 3> begin = layers.front().begin;
  std::array<long, 3> end = begin;
  bool areBytes = true;
  for (const Layer& layer : layers)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      begin[axis] = std::min(begin[axis], layer.begin[axis]);
      end[axis] =
          std::max(end[axis], layer.begin[axis] + static_cast<long>(layer.labels.size[axis]));
      areBytes = areBytes && layer.labels.type == "uint8";
    }
  Image box = layers.front().labels;
  box.type = areBytes ? "uint8" : "int32";
  box.components = layers.size();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.size[axis] = static_cast<std::size_t>(end[axis] - begin[axis]);
    const auto shift = static_cast<double>(begin[axis] - layers.front().begin[axis]);
    for (std::size_t row = 0; row < 3; ++row)
      box.ijkToRas[4 * row + 3] += shift * box.ijkToRas[4 * row + axis];
  }
  box.data = areBytes ? composeData<std::uint8_t>(layers, box, begin)
                      : composeData<std::int32_t>(layers, box, begin);
  return box;
}

void writeSegmentNames(std::vector<Segment> segments, const std::filesystem::path& file) {
  Layer layer;
  layer.labels.type = "uint8";
  layer.labels.size = {1, 1, 1};
  layer.labels.data = std::make_shared<const std::uint8_t>(std::uint8_t(0));
  int label = 0;
  for (Segment& segment : segments) {
    segment.label = ++label;
    segment.layer = 0;
  }
  writeNrrd(makeSegmentationImage({{layer}, std::move(segments), identity}), file);
}

void Writer::writeOrLink(const Image& image, const std::string& key, WrittenFile& last,
                         const std::filesystem::path& file) {
  std::error_code failed;
  if (!key.empty() && key == last.key)
    std::filesystem::create_hard_link(last.file, file, failed);
  if (key.empty() || key != last.key || failed) {
    writeNrrd(image, file);
    last.key.clear();
    const std::filesystem::path copy = m_folder / ("kept-" + file.filename().string());
    std::filesystem::remove(copy, failed);
    std::filesystem::create_hard_link(file, copy, failed);
    if (!failed)
      last = {key, copy};
  }
}

void createFolder(const std::filesystem::path& folder) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed)
    throw FileError(folder.string() + ": cannot be created: " + failed.message());
}

std::filesystem::path Writer::write(const Contents& contents) {
  const std::filesystem::path folder = m_folder / std::to_string(++m_written);
  createFolder(folder);
  writeOrLink(contents.volume, contents.volumeKey, m_volume, folder / "volume.nrrd");
  if (!contents.segmentation.segments.empty())
    writeOrLink(makeSegmentationImage(contents.segmentation), contents.segmentationKey,
                m_segmentation, folder / "segmentation.seg.nrrd");
  if (!contents.property.empty())
    writeText(contents.property, folder / ("property" + contents.propertyExtension));
  if (!contents.crop.empty())
    writeText(contents.crop.front().markup, folder / "roi.mrk.json");
  writeText(makeSceneText(contents), folder / "scene.mrml");
  return folder / "scene.mrml";
}

} // namespace SlicerExport
