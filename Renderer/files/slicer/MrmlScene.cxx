#include "files/slicer/MrmlScene.h"

#include "base/CheckAffine.h"
#include "files/appearance/TransferReader.h"
#include "files/medical/DicomSeries.h"
#include "files/medical/MedicalHeader.h"
#include "files/medical/VolumeReader.h"
#include "model/medium/VolumeProperty.h"

#include <set>

namespace fenestra::core {
namespace {

using Paths = std::vector<std::filesystem::path>;

/// Grid of a volume file, modified by its storage node as in vtkITKArchetypeImageSeriesReader.
Grid applyStorageSettings(const MrmlNode* storage, const Grid& fromFile) {
  if (!storage)
    return fromFile;
  Affine indexToWorld = fromFile.indexToWorld;
  if (!storage->boolean("UseOrientationFromFile", true)) {
    indexToWorld.linear() = Mat3::Diagonal(fromFile.spacing());
    indexToWorld.translation().setZero();
  } else if (storage->boolean("centerImage", false)) {
    const Vec3 middle = fromFile.indexBox().center();
    indexToWorld.translation() = -(fromFile.indexToWorld.linear() * middle);
  }
  return {fromFile.size, indexToWorld};
}

/// Grid of a node in world space.
Grid transformGrid(const MrmlScene& scene, const MrmlNode& node, const Affine& nodeToWorld,
                   const Grid& grid) {
  return {grid.size, checkAffine(nodeToWorld * grid.indexToWorld,
                                 scene.document.bindError(node, "its world transform ",
                                                          "; fix the transforms above it"))};
}

/// Names of the files that hold a node's data. Throws Error (input) if there are none.
std::vector<std::string> requireDataFiles(const MrmlScene& scene, const MrmlNode& node) {
  std::vector<std::string> names = listStorageFiles(scene, node);
  if (names.empty())
    throw scene.document.error(node, "has no file; save its data in Slicer, then the scene");
  return names;
}

/// File of the color table with which a label map is displayed; nullopt: none in the scene's files.
std::optional<std::string> findColorTable(const MrmlScene& scene, const MrmlNode& node) {
  const MrmlNode* display = isLabelMap(node) ? scene.document.follow(node, "display") : nullptr;
  const MrmlNode* colors = display ? scene.document.follow(*display, "color") : nullptr;
  const std::vector<std::string> files =
      colors ? listStorageFiles(scene, *colors) : std::vector<std::string>();
  return files.empty() || !scene.files.contains(files.front()) ? std::nullopt
                                                               : std::optional(files.front());
}

/// Returns read(file of the node, table of label names): `labels`, else the node's color table if
/// it is readable and names one of the values.
template <typename Read>
auto readWithColorTable(MrmlScene& scene, const MrmlNode& node,
                        const std::optional<std::string>& labels, Read&& read) {
  std::vector<std::string> names = requireDataFiles(scene, node);
  const std::optional<std::string> table = labels ? std::nullopt : findColorTable(scene, node);
  names.resize(1);
  if (table)
    try {
      return scene.files.read({names.front(), *table}, [&](const Paths& files) {
        return read(files[0], std::optional(files[1].string()));
      });
    } catch (const Error&) { // of the table, else it occurs again
    }
  return scene.files.read(names, [&](const Paths& files) { return read(files.front(), labels); });
}

Rgb readColor(const MrmlNode& node, const std::string& attribute, const Rgb& fallback) {
  return node.triple(attribute).value_or(fallback).array().max(0.0).min(1.0);
}

} // namespace

MrmlScene::MrmlScene(const std::filesystem::path& path)
    : files(path), document(files.sceneText(), files.source()) {
  for (const std::string& fileName : document.fileNames())
    files.registerInputs(fileName);
}

bool isLabelMap(const MrmlNode& node) {
  return node.tag == "LabelMapVolume" || (node.tag == "Volume" && node.boolean("labelMap", false));
}

bool isSegmentation(const MrmlNode& node) {
  return node.tag == "Segmentation" || isLabelMap(node);
}

bool isScalarVolume(const MrmlNode& node) {
  return node.tag == "Volume" && !isLabelMap(node);
}

bool isVolumeRendering(const MrmlNode& node) {
  static const std::set<std::string> tags = {"GPURayCastVolumeRendering",
                                             "CPURayCastVolumeRendering", "MultiVolumeRendering",
                                             "NCIRayCastVolumeRendering", "VolumeRendering"};
  return tags.contains(node.tag);
}

bool isVisible(const MrmlNode& display) {
  return display.boolean("visibility", true) && display.boolean("visibility3D", true);
}

std::string findLayoutName(const MrmlNode& viewOrCamera) {
  return viewOrCamera.text(viewOrCamera.find("layoutName") ? "layoutName" : "singletonTag");
}

std::vector<std::string> listStorageFiles(const MrmlScene& scene, const MrmlNode& node) {
  std::vector<std::string> names;
  const MrmlNode* storage = scene.document.follow(node, "storage");
  if (!storage)
    return names;
  std::set<std::string> known;
  const auto add = [&](const std::string& name) {
    if (!name.empty() && known.insert(name).second)
      names.push_back(name);
  };
  add(storage->text("fileName"));
  for (std::size_t n = 0; storage->find("fileListMember" + std::to_string(n)); ++n)
    add(storage->text("fileListMember" + std::to_string(n)));
  return names;
}

Volume readSceneVolume(MrmlScene& scene, const MrmlNode& node, const VolumeChoice& choice) {
  const Affine nodeToWorld = toWorld(scene, node);
  Volume volume = scene.files.read(requireDataFiles(scene, node), [&](const Paths& files) {
    // A volume file (with samples possibly in further files), else DICOM slices.
    return findMedicalFormat(files.front()) ? readVolume(files.front(), choice)
                                            : readDicomVolume(files, node.name, choice);
  });
  for (Message& warning : volume.warnings)
    warning = scene.files.translatePaths(warning);
  const Grid grid = applyStorageSettings(scene.document.follow(node, "storage"), volume.grid);
  volume.grid = transformGrid(scene, node, nodeToWorld, grid);
  volume.name = node.name.empty() ? scene.files.translatePaths(volume.name) : node.name;
  return volume;
}

Segmentation readSceneSegmentation(MrmlScene& scene, const MrmlNode& node, const Grid* volume,
                                   const std::optional<std::string>& labels) {
  const Affine nodeToWorld = toWorld(scene, node);
  std::optional<Grid> gridInNodeSpace;
  if (volume)
    gridInNodeSpace.emplace(volume->size, nodeToWorld.inverse() * volume->indexToWorld);
  const MrmlNode* storage = isLabelMap(node) ? scene.document.follow(node, "storage") : nullptr;
  Segmentation segmentation = readWithColorTable(
      scene, node, labels,
      [&](const std::filesystem::path& file, const std::optional<std::string>& names) {
        return readSegmentation(file, gridInNodeSpace ? &*gridInNodeSpace : nullptr, names);
      });
  segmentation.setGrid(
      transformGrid(scene, node, nodeToWorld, applyStorageSettings(storage, segmentation.grid())));
  return segmentation;
}

std::vector<SegmentInfo> readSceneSegmentInfos(MrmlScene& scene, const MrmlNode& node,
                                               const std::optional<std::string>& labels) {
  return readWithColorTable(
      scene, node, labels,
      [](const std::filesystem::path& file, const std::optional<std::string>& names) {
        return readSegmentInfos(file, names);
      });
}

std::map<std::string, bool> readSegmentVisibility(const MrmlScene& scene, const MrmlNode& node) {
  std::map<std::string, bool> visible;
  const MrmlNode* display = scene.document.follow(node, "display");
  if (!display)
    return visible;
  for (const std::string& segment : split(display->text("SegmentationDisplayProperties"), '|'))
    if (const std::vector<std::string> parts = splitWords(segment); !parts.empty()) // id, settings
      visible[decodeUrl(parts.front())] =
          std::none_of(parts.begin() + 1, parts.end(), [](const std::string& setting) {
            return setting == "Visible:false" || setting == "Visible3D:false";
          });
  return visible;
}

TransferFunction readInlineProperty(const MrmlDocument& document, const MrmlNode& property) {
  return parseTransferFunction(property.attributes, concat(document.source(), ": ", property.tag,
                                                           ' ', describeNode(property)));
}

std::vector<std::string> listPropertyNames(const MrmlDocument& document) {
  std::vector<std::string> names;
  for (const MrmlNode* node : document.findByTag("VolumeProperty"))
    names.push_back(node->name);
  return names;
}

TransferFunction readSceneProperty(MrmlScene& scene, const MrmlNode& property) {
  const std::vector<std::string> names = listStorageFiles(scene, property);
  const bool isInline = property.find("scalarOpacity") && property.find("colorTransfer");
  if (names.empty() && !isInline)
    throw scene.document.error(property, "has neither a file nor points",
                               ErrorCode::missingTransferPoints);
  if (names.empty())
    return readInlineProperty(scene.document, property);
  return scene.files.read(names,
                          [](const Paths& files) { return readTransferFunction(files.front()); });
}

std::optional<TransferFunction> convertSliceDisplay(const MrmlNode& rendering,
                                                    const MrmlNode& display,
                                                    const std::array<double, 2>& range) {
  const auto number = [&display](const char* attribute, double fallback) {
    return display.number(attribute).value_or(fallback);
  };
  const std::string colors = display.referenceId("color");
  if (!display.find("window") || !display.find("level") ||
      (!colors.empty() && colors != "vtkMRMLColorTableNodeGrey"))
    return std::nullopt;
  const double window = std::abs(number("window", 0.0));
  const double low = number("level", 0.0) - 0.5 * window;
  const double high = low + window;

  const bool usesWindow = rendering.boolean("ignoreVolumeDisplayNodeThreshold", false);
  const auto clamp = [&range](double x) { return std::clamp(x, range[0], range[1]); };
  const double from = clamp(usesWindow ? low : number("lowerThreshold", range[0]));
  const double to = std::max(from, clamp(usesWindow ? high : number("upperThreshold", range[1])));
  const double beyond = usesWindow ? 1.0 : 0.0;

  VolumeProperty property;
  property.scalarOpacity = {
      {range[0], 0.0}, {from, 0.0}, {to, 1.0}, {to, beyond}, {range[1], beyond}};
  const bool inverted = display.boolean("invertDisplayScalarRange", false);
  const Rgb first = Rgb::Constant(inverted ? 1.0 : 0.0);
  property.color = {{low, first}, {high, 1.0 - first}};
  property.shade = true;
  property.diffuse = 0.6;
  property.specular = 0.5;
  property.specularPower = 40.0;
  return tabulate(property, display.name);
}

ViewBackground readViewBackground(const MrmlNode& view) {
  const Rgb bottom = readColor(view, "backgroundColor", Rgb::Zero());
  return {bottom, readColor(view, "backgroundColor2", bottom)};
}

} // namespace fenestra::core
