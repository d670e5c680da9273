#include "program/InspectReport.h"

#include <nlohmann/json.hpp>

namespace fenestra {
namespace {

using Json = nlohmann::ordered_json;

Json orNull(const std::string& text) {
  return text.empty() ? Json(nullptr) : Json(text);
}

template <typename Numbers>
Json list(const Numbers& vector) {
  Json json = Json::array();
  for (int i = 0; i < vector.size(); ++i)
    json.push_back(vector[i]);
  return json;
}

template <typename Items, typename ToJson>
Json all(const Items& items, ToJson&& toJson) {
  Json json = Json::array();
  for (const auto& item : items)
    json.push_back(toJson(item));
  return json;
}

template <typename Item, typename ToJson>
Json orNull(const std::optional<Item>& item, ToJson&& toJson) {
  return item ? toJson(*item) : Json(nullptr);
}

Json nodeJson(const NodeSummary& node) {
  return {{"id", orNull(node.id)},
          {"name", node.name},
          {"files", all(node.files,
                        [](const FileSummary& file) {
                          return Json{{"name", file.name}, {"there", file.there}};
                        })},
          {"transform", orNull(node.transform)},
          {"used", node.used},
          {"problem", orNull(node.problem)}};
}

Json segmentJson(const SegmentSummary& segment) {
  const Json bounds = {{"lower", list(segment.bounds.lower)},
                       {"upper", list(segment.bounds.upper)}};
  return {{"id", segment.id},
          {"name", segment.name},
          {"labelValue", segment.labelValue},
          {"layer", segment.layer},
          {"color", list(segment.color)},
          {"voxels", segment.voxels},
          {"milliliters", segment.milliliters},
          {"bounds", segment.voxels > 0 ? bounds : Json(nullptr)},
          {"shown", segment.shown}};
}

Json segmentationJson(const SegmentationSummary& segmentation) {
  Json json = nodeJson(segmentation.node);
  json["kind"] = segmentation.node.id.empty() ? "file"
                 : segmentation.isLabelMap    ? "labelMap"
                                              : "segmentation";
  json["shown"] = segmentation.shown;
  const bool isRead = segmentation.node.problem.empty();
  json["size"] = isRead ? list(segmentation.size) : Json(nullptr);
  json["spacing"] = isRead ? list(segmentation.spacing) : Json(nullptr);
  json["segments"] = all(segmentation.segments, segmentJson);
  return json;
}

Json renderingJson(const RenderingSummary& rendering) {
  Json json = nodeJson(rendering.node);
  json["volume"] = orNull(rendering.volume);
  json["property"] = orNull(rendering.property);
  json["roi"] = orNull(rendering.roi);
  json["cropping"] = rendering.cropping;
  json["followsDisplay"] = rendering.followsDisplay;
  json["shown"] = rendering.shown;
  return json;
}

Json viewJson(const ViewSummary& view) {
  Json json = nodeJson(view.node);
  json["layout"] = orNull(view.layout);
  json["technique"] = orNull(view.technique);
  json["background"] = {{"bottom", list(view.bottom)}, {"top", list(view.top)}};
  return json;
}

void addPose(const CameraPose& pose, Json& json) {
  const bool perspective = pose.projection == Projection::perspective;
  json["projection"] = perspective ? "perspective" : "orthographic";
  json["position"] = list(pose.position);
  json["target"] = list(pose.target);
  json["up"] = list(pose.up);
  json[perspective ? "angle" : "scale"] = perspective ? pose.angle : pose.scale;
}

Json cameraJson(const CameraSummary& camera) {
  Json json = nodeJson(camera.node);
  json["layout"] = orNull(camera.layout);
  if (camera.pose)
    addPose(*camera.pose, json);
  return json;
}

Json transformJson(const TransformSummary& transform) {
  Json json = nodeJson(transform.node);
  json["linear"] = transform.toWorld.has_value();
  json["toWorld"] = orNull(transform.toWorld, [](const Affine& map) {
    Json rows = Json::array();
    for (int row = 0; row < 3; ++row) {
      rows.push_back(list(map.linear().row(row)));
      rows.back().push_back(map.translation()[row]);
    }
    return rows;
  });
  return json;
}

Json seriesJson(const SeriesSummary& series) {
  return {{"uid", series.uid},
          {"number", orNull(series.number)},
          {"description", orNull(series.description)},
          {"modality", orNull(series.modality)},
          {"files", series.files}};
}

const char* sourceName(LookSource source) {
  switch (source) {
  case LookSource::volumeProperty:
    return "volumeProperty";
  case LookSource::volumeDisplay:
    return "volumeDisplay";
  case LookSource::preset:
    return "preset";
  case LookSource::range:
    break;
  }
  return "range";
}

Json renderJson(const RenderUse& use) {
  Json json;
  json["volume"] = orNull(use.volume, [](const VolumeUse& volume) {
    return Json{{"id", orNull(volume.id)},
                {"name", volume.name},
                {"size", list(volume.size)},
                {"spacing", list(volume.spacing)},
                {"center", list(volume.center)},
                {"voxelType", volume.voxelType},
                {"range", Json::array({volume.minimum, volume.maximum})},
                {"transforms", volume.transforms}};
  });
  json["look"] = orNull(use.look, [](const LookUse& look) {
    return Json{
        {"source", sourceName(look.source)}, {"id", orNull(look.id)}, {"name", orNull(look.name)}};
  });
  json["crop"] = orNull(use.crop, [](const CropUse& crop) {
    return Json{{"id", orNull(crop.id)},
                {"name", crop.name},
                {"edges", list(crop.edges)},
                {"center", list(crop.center)}};
  });
  json["camera"] = orNull(use.camera, [](const CameraUse& camera) {
    Json used = {{"id", orNull(camera.id)}, {"name", orNull(camera.name)}};
    addPose(camera.pose, used);
    return used;
  });
  json["background"] = orNull(use.background, [](const BackgroundUse& background) {
    return Json{{"view", orNull(background.view)},
                {"bottom", list(background.bottom)},
                {"top", list(background.top)}};
  });
  json["segmentation"] = orNull(use.segmentation);
  json["segmentationProblem"] = orNull(use.segmentationProblem);
  json["stored"] = use.stored;
  return json;
}

} // namespace

std::string inspectionJson(const Inspection& inspection, const std::string& input) {
  static constexpr const char* kinds[] = {"scene", "volume", "segmentation", "dicom"};
  Json json;
  json["input"] = input;
  json["kind"] = kinds[static_cast<std::size_t>(inspection.kind)];
  json["version"] = orNull(inspection.version);
  json["volumes"] = all(inspection.volumes, nodeJson);
  json["segmentations"] = all(inspection.segmentations, segmentationJson);
  json["volumeRenderings"] = all(inspection.renderings, renderingJson);
  json["volumeProperties"] = all(inspection.properties, nodeJson);
  json["rois"] = all(inspection.rois, nodeJson);
  json["views"] = all(inspection.views, viewJson);
  json["cameras"] = all(inspection.cameras, cameraJson);
  json["transforms"] = all(inspection.transforms, transformJson);
  json["series"] = all(inspection.series, seriesJson);
  json["others"] = inspection.others.empty() ? Json::object() : Json(inspection.others);
  json["render"] = orNull(inspection.render, renderJson);
  json["refused"] = orNull(inspection.refused);
  json["warnings"] = inspection.warnings;
  json["ignored"] = inspection.ignored;
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

} // namespace fenestra
