#include "scene/Inspection.h"

#include "base/Color.h"
#include "files/medical/DicomSeries.h"
#include "files/medical/ImageStack.h"
#include "files/segments/MaskFolder.h"
#include "io/InputRegistry.h"
#include "scene/DefaultTransfer.h"
#include "scene/InspectionParts.h"
#include "scene/SegmentMaterials.h"

#include <algorithm>
#include <cctype>

namespace fenestra::core {
namespace {

constexpr std::array voxelTypes = {"uint8", "int16", "uint16", "float"}; ///< by Voxels::index()

/// True if most pairs of adjacent voxels above the minimum are equal. In the available data this
/// held for at least 59 % of the pairs of a label map, and for at most 8 % of a scan.
bool isLikelyLabelMap(const Volume& volume) {
  constexpr double threshold = 0.5;
  if (volume.minimum < 0.0 || std::holds_alternative<LargeArray<float>>(volume.voxels))
    return false;
  const auto areMostEqual = [&](const auto& voxels) {
    const auto isMinimum = [&](auto voxel) { return static_cast<double>(voxel) == volume.minimum; };
    std::size_t pairs = 0, equal = 0;
    for (std::size_t i = 1; i < voxels.size(); ++i)
      if (!isMinimum(voxels[i]) || !isMinimum(voxels[i - 1])) {
        ++pairs;
        equal += voxels[i] == voxels[i - 1];
      }
    return static_cast<double>(equal) > threshold * static_cast<double>(pairs);
  };
  return std::visit(areMostEqual, volume.voxels);
}

bool hasSegmentationName(const std::filesystem::path& path) {
  return path.filename().string().find(".seg.") != std::string::npos;
}

/// Properties of a volume that outlive its voxels, which are released before segmentations are
/// read.
struct FileVolume {
  std::optional<Grid> grid = {};     ///< empty: unreadable
  std::optional<Error> failure = {}; ///< of the render, perhaps after the volume was read
  bool isLikelyLabelMap = false;
};

/// Reports what a render uses of the input, with its warnings or its error.
FileVolume inspectVolume(const RenderRequest& request, const Input& input, Json& report) {
  FileVolume result;
  const auto add = [&](const Volume& volume, const std::vector<Message>& warnings) {
    report["render"] = makeRenderReport();
    report["render"]["volume"] = volumeJson(volume);
    report["render"]["look"] = defaultTransferJson(volume);
    report["warnings"] = warnings;
    result.grid = volume.grid;
    result.isLikelyLabelMap = isLikelyLabelMap(volume);
  };
  try {
    const PreparedScene scene(request, input);
    add(scene.volume(), scene.warnings());
    report["render"]["camera"] = poseJson(scene.camera().pose());
  } catch (const Error& error) {
    result.failure = error;
    report["refused"] = error.message();
    Json unused;
    if (const auto read = tryRead(
            [&] { return input.volume(input.chooseForm(request.volume, request.segmentation)); },
            unused))
      add((*read)->volume, (*read)->volume.warnings);
  }
  return result;
}

/// Display-encoded color; with several knots, [scalar, color] per knot; null: none.
Json colorJson(const std::optional<ColorFunction>& color) {
  if (!color)
    return nullptr;
  if (color->knots().size() == 1)
    return encodeSrgb(color->knots().front().value);
  Json knots;
  for (const auto& [scalar, value] : color->knots())
    knots.push_back({scalar, encodeSrgb(value)});
  return knots;
}

/// As in material files, where a medium is called "matter".
const char* kindName(const Material& material) {
  return material.kind == MaterialKind::tint ? "tint" : "matter";
}

Json materialJson(const SegmentMaterial& material) {
  const SegmentMedium& medium = material.medium;
  return {{"name", nullIfEmpty(material.name)},
          {"kind", kindName(medium.material)},
          {"color", colorJson(toReflectanceColor(medium.material))},
          {"priority", medium.priority},
          {"clip", medium.isClipped},
          {"density", medium.density},
          {"why", material.reason}};
}

/// The library's materials, by name.
Json libraryJson() {
  Json all = Json::array();
  for (const auto& [name, material] : materialLibrary().materials)
    all.push_back({{"name", name},
                   {"kind", kindName(material)},
                   {"color", colorJson(toReflectanceColor(material))}});
  return all;
}

/// Volume beside a segmentation: the only volume file in its folder. A placeholder if there is none
/// or several.
std::string findVolumeBeside(const std::filesystem::path& segmentation) {
  const std::filesystem::path path = std::filesystem::absolute(segmentation).lexically_normal();
  const std::filesystem::path folder =
      path.has_filename() ? path.parent_path() : path.parent_path().parent_path();
  auto files = listMaskFiles(folder);
  std::error_code unknown;
  std::erase_if(files, [&](const auto& file) {
    return std::filesystem::equivalent(file, segmentation, unknown);
  });
  return files.size() == 1 ? (segmentation / ".." / files.front().filename()).lexically_normal()
                           : std::filesystem::path("VOLUME");
}

/// True if a render fails only because the input and the request state no spacing.
bool needsSpacing(const Json& report) {
  const Json& refused = report["refused"];
  return !refused.is_null() && refused["code"] == ErrorCode::spacingRequired;
}

/// Adds renders without a segmentation: of the volume, or if none is chosen, of each series.
void addVolumeExamples(const RenderRequest& request, const DicomFolder* dicom, Json& report) {
  constexpr std::size_t mostListed = 8;
  const auto add = [&](const Json& choice) {
    report["examples"].push_back({{"volume", request.input.string()},
                                  {"choice", choice},
                                  {"segmentation", nullptr},
                                  {"focus", nullptr}});
  };
  if (report["refused"].is_null() || needsSpacing(report)) {
    add(nullIfEmpty(request.volume.name.value_or("")));
  } else if (dicom && !request.volume.name) {
    for (const DicomSeries& series : dicom->series) {
      const auto isNamesake = [&](const DicomSeries& other) {
        return other.name() == series.name();
      };
      const bool isUnique = std::ranges::count_if(dicom->series, isNamesake) == 1;
      const std::string& choice = isUnique && !series.name().empty() ? series.name() : series.uid;
      if (series.isVolume && !choice.empty() && report["examples"].size() < mostListed)
        add(choice);
    }
  }
}

/// A folder of masks is no input of a render, but its segmentation. nullopt: it has
/// DICOM series, or most of its volume files are no masks.
std::optional<Json> inspectMaskFolder(const RenderRequest& request, const Input& input) {
  Json report = makeReport(request, "segmentation"), unused;
  const std::size_t files = listMaskFiles(request.input).size();
  if (files == 0 || tryRead([&] { return input.dicom() != nullptr; }, unused))
    return std::nullopt;
  const Json folder =
      inspectSegmentationFile(request.input, nullptr, request.labels, report["warnings"]);
  if (2 * folder["segments"].size() < files)
    return std::nullopt;
  addExample(findVolumeBeside(request.input), nullptr, folder["name"], folder, report);
  report["segmentations"].push_back(folder);
  return report;
}

Json seriesJson(const DicomFolder& dicom) {
  Json all = Json::array();
  for (const DicomSeries& series : dicom.series)
    all.push_back({{"uid", nullIfEmpty(series.uid)},
                   {"number", nullIfEmpty(series.number)},
                   {"description", nullIfEmpty(series.description)},
                   {"modality", nullIfEmpty(series.modality)},
                   {"part", nullIfEmpty(series.part)},
                   {"frames", series.frames.size()},
                   {"files", series.files().size()}});
  return all;
}

/// Adds the segmentations in the folder that refer to the series. `grid`: of its volume.
void addSegmentationsOf(const DicomFolder& dicom, const RenderRequest& request, const Grid& grid,
                        Json& report) {
  const DicomSeries series =
      chooseSeries(dicom.series, request.volume.name, request.input.string());
  for (const auto& file : dicom.segmentationsOf(series)) {
    const Json one = inspectSegmentationFile(file, &grid, request.labels, report["warnings"]);
    addExample(request.input.string(), nullIfEmpty(request.volume.name.value_or("")), one["name"],
               one, report);
    report["segmentations"].push_back(one);
  }
}

/// NODE of a stack of images that cannot be rendered without a spacing.
Json stackJson(const ImageStack& stack) {
  Json json = nodeJson("", stack.path.string());
  for (const auto& file : stack.files())
    json["files"].push_back({{"name", file.filename().string()}, {"there", true}});
  json["size"] = stack.size();
  json["spacing"] = nullptr;
  return json;
}

/// Adds the spacing to the examples: that of the request, or if it is needed, a placeholder.
void addSpacing(const RenderRequest& request, Json& report) {
  const auto& spacing = request.volume.spacing;
  for (Json& example : report["examples"])
    example["spacing"] = spacing                ? Json(joinNumbers(*spacing, ",", 9))
                         : needsSpacing(report) ? Json("X,Y,Z")
                                                : Json(nullptr);
}

Json inspectFiles(const RenderRequest& request, const Input& input) {
  if (isFolder(request.input))
    if (auto masks = inspectMaskFolder(request, input))
      return std::move(*masks);
  Json unused;
  const DicomFolder* const dicom =
      isFolder(request.input)
          ? input.dicom()
          : tryRead([&] { return input.dicom(); }, unused).value_or(nullptr); // a segmentation
  Json report = makeReport(request, dicom ? "dicom" : "volume");
  if (dicom)
    report["series"] = seriesJson(*dicom);
  const FileVolume volume = inspectVolume(request, input, report);
  const bool isStack = !dicom && isImageStack(request.input);
  if (isStack && !volume.grid && !needsSpacing(report))
    throw *volume.failure;
  if (isStack && !volume.grid)
    report["volumes"].push_back(stackJson(openImageStack(request.input)));
  Json& segmentations = report["segmentations"];
  const Grid* grid = volume.grid ? &*volume.grid : nullptr;
  if (!dicom && !isStack &&
      (!grid || volume.isLikelyLabelMap || hasSegmentationName(request.input))) {
    segmentations.push_back(
        inspectSegmentationFile(request.input, grid, request.labels, report["warnings"]));
    if (!grid && !segmentations.back()["problem"].is_null())
      throw *volume.failure;
    report["kind"] = "segmentation";
  }
  if (dicom && !request.segmentation && grid)
    addSegmentationsOf(*dicom, request, *grid, report);
  if (request.segmentation) {
    segmentations.push_back(
        inspectSegmentationFile(*request.segmentation, grid, request.labels, report["warnings"]));
    segmentations.back()["used"] = true;
    if (grid)
      report["render"]["segmentation"] = nullIfEmpty(*request.segmentation);
    addExample(request.input.string(), nullIfEmpty(request.volume.name.value_or("")),
               segmentations.back()["name"], segmentations.back(), report);
  }
  if (report["examples"].empty() && report["kind"] != "segmentation")
    addVolumeExamples(request, dicom, report);
  return report;
}

} // namespace

void to_json(Json& json, const Message& message) {
  json = {{"code", message.code}, {"subject", message.subject}, {"detail", message.detail}};
}

void from_json(const Json& json, Message& message) {
  message = {json.at("code").get<ErrorCode>(), json.at("subject").get<std::string>(),
             json.at("detail").get<std::string>()};
}

Json nullIfEmpty(const std::string& text) {
  return text.empty() ? Json(nullptr) : Json(text);
}

Json makeReport(const RenderRequest& request, const char* kind) {
  Json report = {{"input", request.input.string()}, {"kind", kind}, {"version", nullptr}};
  for (const char* list : {"volumes", "segmentations", "volumeRenderings", "volumeProperties",
                           "rois", "views", "cameras", "transforms", "series"})
    report[list] = Json::array();
  report["others"] = Json::object();
  report["materials"] = libraryJson();
  report["examples"] = Json::array();
  report["render"] = nullptr;
  report["refused"] = nullptr;
  report["warnings"] = Json::array();
  report["ignored"] = Json::array();
  return report;
}

Json makeRenderReport() {
  Json render;
  for (const char* part :
       {"volume", "look", "crop", "camera", "background", "segmentation", "segmentationProblem"})
    render[part] = nullptr;
  render["stored"] = Json::array();
  return render;
}

Json volumeJson(const Volume& volume, const std::string& id) {
  return {{"id", nullIfEmpty(id)},
          {"name", volume.name},
          {"size", volume.grid.size},
          {"spacing", volume.grid.spacing()},
          {"center", volume.grid.worldCenter()},
          {"voxelType", voxelTypes[volume.voxels.index()]},
          {"range", {volume.minimum, volume.maximum}},
          {"frames", volume.frameCount > 1 ? Json(volume.frameCount) : Json(nullptr)},
          {"transforms", Json::array()}};
}

Json transferJson(const char* source, const std::string& id, const std::string& name) {
  return {{"source", source}, {"id", nullIfEmpty(id)}, {"name", nullIfEmpty(name)}};
}

Json defaultTransferJson(const Volume& volume) {
  const std::optional<std::string> preset = chooseTransferPreset(volume, {});
  return transferJson(preset ? "preset" : "range", "", preset.value_or(""));
}

Json poseJson(const CameraPose& pose, const std::string& id, const std::string& name) {
  Json camera = {{"id", nullIfEmpty(id)}, {"name", nullIfEmpty(name)}};
  addPose(pose, camera);
  return camera;
}

void addPose(const CameraPose& pose, Json& camera) {
  const bool perspective = pose.projection == Projection::perspective;
  camera["projection"] = perspective ? "perspective" : "orthographic";
  camera["position"] = pose.position;
  camera["target"] = pose.target;
  camera["up"] = pose.up;
  camera[perspective ? "angle" : "scale"] = perspective ? pose.angle : pose.scale;
}

Json nodeJson(const std::string& id, const std::string& name) {
  return {{"id", nullIfEmpty(id)}, {"name", name},  {"files", Json::array()},
          {"transform", nullptr},  {"used", false}, {"problem", nullptr}};
}

Json segmentationMembers(const char* kind, bool shown) {
  return {{"kind", kind},       {"shown", shown},       {"size", nullptr},
          {"spacing", nullptr}, {"namesFrom", nullptr}, {"segments", Json::array()}};
}

void addSegments(const Segmentation& segmentation, const std::map<std::string, bool>& shown,
                 Json& json) {
  constexpr double cubicMmInMl = 1000.0;
  const Grid& grid = segmentation.grid();
  json["size"] = grid.size;
  if (!segmentation.namesSource().empty())
    json["namesFrom"] = segmentation.namesSource();
  json["spacing"] = grid.spacing();
  const double milliliters = std::abs(grid.indexToWorld.linear().determinant()) / cubicMmInMl;
  const std::vector<SegmentStatistics> statistics = segmentation.statistics();
  const std::vector<SegmentMaterial> materials =
      assignMaterials(segmentation.segments(), materialLibrary());
  for (std::size_t i = 0; i < statistics.size(); ++i) {
    const SegmentInfo& info = segmentation.segments()[i];
    const auto& [voxels, bounds] = statistics[i];
    const auto visible = shown.find(info.id);
    Json segment = {{"id", info.id},
                    {"name", info.name},
                    {"labelValue", info.labelValue},
                    {"layer", info.layer},
                    {"color", info.color},
                    {"voxels", voxels},
                    {"milliliters", milliliters * static_cast<double>(voxels)},
                    {"bounds", nullptr},
                    {"shown", visible == shown.end() || visible->second},
                    {"material", materialJson(materials[i])}};
    if (voxels > 0)
      segment["bounds"] = {{"lower", bounds.lower}, {"upper", bounds.upper}};
    json["segments"].push_back(std::move(segment));
  }
}

Json inspectSegmentationFile(const std::filesystem::path& path, const Grid* volume,
                             const std::optional<std::string>& labels, Json& warnings) {
  Json json = nodeJson("", path.string());
  json.update(segmentationMembers("file", true));
  if (const auto segmentation =
          tryRead([&] { return readSegmentation(path, volume, labels); }, json["problem"])) {
    addSegments(*segmentation, {}, json);
    for (const Message& warning : segmentation->warnings())
      warnings.push_back(warning);
  }
  return json;
}

void addExample(const std::string& volume, const Json& choice, const Json& segmentation,
                const Json& report, Json& whole) {
  const auto countNamesakes = [&](const Json& name) {
    return std::ranges::count_if(report["segments"],
                                 [&](const Json& other) { return other["name"] == name; });
  };
  for (const Json& segment : report["segments"])
    if (segment["voxels"] > 0 && segment["shown"]) {
      const bool isUnique = !segment["name"].get_ref<const std::string&>().empty() &&
                            countNamesakes(segment["name"]) == 1;
      whole["examples"].push_back({{"volume", volume},
                                   {"choice", choice},
                                   {"segmentation", segmentation},
                                   {"focus", segment[isUnique ? "name" : "id"]}});
      return;
    }
}

Inspection inspectInput(const RenderRequest& request, const Input& input) {
  Inspection report =
      input.document() ? inspectScene(request, input) : inspectFiles(request, input);
  addSpacing(request, report);
  return report;
}

} // namespace fenestra::core
