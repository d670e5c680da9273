// Inspection of Slicer scenes: first what a render uses, then each node.

#include "files/slicer/ScenePlan.h"
#include "scene/Defaults.h"
#include "scene/InspectionParts.h"

#include <algorithm>
#include <memory>
#include <set>

namespace fenestra::core {
namespace {

bool isRoi(const MrmlNode& node) {
  return node.tag == "MarkupsROI" || node.tag == "AnnotationROI" || node.tag == "ROI" ||
         node.tag == "MRMLROINode";
}

std::string idOrEmpty(const MrmlNode* node) {
  return node ? node->id : std::string();
}

std::string nameOrEmpty(const MrmlNode* node) {
  return node ? node->name : std::string();
}

Json backgroundColors(const MrmlNode& view) {
  const ViewBackground colors = readViewBackground(view);
  return {{"bottom", colors.bottom}, {"top", colors.top}};
}

class SceneInspector {
public:
  SceneInspector(const RenderRequest& request, const Input& input)
      : m_request(request),
        m_input(input),
        m_scene(*input.scene()),
        m_report(makeReport(request, "scene")) {
    m_report["version"] = nullIfEmpty(m_scene.document.version());
  }

  Inspection inspect() {
    makePlan();
    if (m_plan)
      inspectRender();
    inspectNodes();
    inspectChosenFile();
    if (m_report["refused"].is_null())
      addExamples();
    return std::move(m_report);
  }

private:
  const MrmlDocument& document() const { return m_scene.document; }
  const Grid* volumeGrid() const { return m_grid ? &*m_grid : nullptr; }

  /// Plans a render with a focus, or without one if only its segmentation is ambiguous.
  void makePlan() {
    SceneSelection choice{m_request.volume.name, m_request.segmentation, true};
    const auto tryPlan = [&] { return planRender(document(), choice); };
    Json problem;
    m_plan = tryRead(tryPlan, problem);
    if (!m_plan) {
      choice.needsSegmentation = false;
      m_plan = tryRead(tryPlan, m_report["refused"]);
      if (std::ranges::any_of(document().nodes(), isSegmentation))
        m_segmentationProblem = problem;
    }
  }

  // ---- what a render would use

  /// Makes a PreparedScene to get volume, transfer function and camera; if that fails, reads each.
  void inspectRender() {
    Json render = makeRenderReport();
    m_report["warnings"] = m_plan->warnings;
    m_report["ignored"] = m_plan->ignored;
    std::optional<CameraPose> pose;
    if (const auto scene =
            tryRead([&] { return std::make_unique<PreparedScene>(m_request, m_input); },
                    m_report["refused"])) {
      addVolume((*scene)->volume(), (*scene)->transferName(), render);
      pose = (*scene)->camera().pose();
      m_report["warnings"] = (*scene)->warnings();
    } else {
      if (const auto volume =
              tryRead([&] { return readSceneVolume(m_scene, *m_plan->volume, m_request.volume); },
                      m_unused))
        addVolume(*volume, nameOrEmpty(m_plan->property), render);
      if (m_plan->camera)
        pose = readCamera(*m_plan->camera, m_unused);
    }
    if (pose)
      render["camera"] = poseJson(*pose, idOrEmpty(m_plan->camera), nameOrEmpty(m_plan->camera));
    if (m_plan->roi)
      render["crop"] = cropJson(*m_plan->roi);
    if (m_plan->view) {
      render["background"] = {{"view", nullIfEmpty(m_plan->view->id)}};
      render["background"].update(backgroundColors(*m_plan->view));
    }
    render["segmentation"] = nullIfEmpty(idOrEmpty(m_plan->segmentation));
    render["segmentationProblem"] = m_segmentationProblem;
    markUsed(render["look"]);
    m_report["render"] = std::move(render);
  }

  /// Adds volume and transfer function. `transferName`: PreparedScene::transferName of the render.
  void addVolume(const Volume& volume, const std::string& transferName, Json& render) {
    m_grid = volume.grid;
    render["volume"] = volumeJson(volume, m_plan->volume->id);
    render["volume"]["transforms"] = listParentTransforms(document(), *m_plan->volume);
    const MrmlNode* property = m_plan->property;
    if (property && transferName == property->name)
      render["look"] = transferJson("volumeProperty", property->id, property->name);
    else if (m_plan->sliceDisplay)
      render["look"] =
          transferJson("volumeDisplay", m_plan->sliceDisplay->id, m_plan->sliceDisplay->name);
    else
      render["look"] = defaultTransferJson(volume);
  }

  Json cropJson(const MrmlNode& roi) {
    const auto box = tryRead([&] { return readSceneRoi(m_scene, roi); }, m_unused);
    if (!box)
      return nullptr;
    return {{"id", nullIfEmpty(roi.id)},
            {"name", roi.name},
            {"edges", Vec3(2.0 * box->boxToWorld.linear().columnNorms())},
            {"center", box->boxToWorld.translation()}};
  }

  void markUsed(const Json& transfer) {
    for (const MrmlNode* node : {m_plan->volume, m_plan->rendering, m_plan->roi,
                                 m_plan->segmentation, m_plan->view, m_plan->camera})
      if (node) {
        m_used.insert(node);
        if (node != m_plan->view)
          for (const std::string& id : listParentTransforms(document(), *node))
            m_used.insert(document().find(id));
      }
    if (m_plan->property && transfer.is_object() && transfer["source"] == "volumeProperty")
      m_used.insert(m_plan->property);
  }

  // ---- every node

  void inspectNodes() {
    findOwners();
    std::map<std::string, std::size_t> others;
    for (const MrmlNode& node : document().nodes())
      if (isScalarVolume(node))
        m_report["volumes"].push_back(nodeJson(node));
      else if (isSegmentation(node))
        m_report["segmentations"].push_back(segmentationJson(node));
      else if (isVolumeRendering(node))
        m_report["volumeRenderings"].push_back(renderingJson(node));
      else if (node.tag == "VolumeProperty")
        m_report["volumeProperties"].push_back(nodeJson(node));
      else if (isRoi(node))
        m_report["rois"].push_back(nodeJson(node));
      else if (node.tag == "View")
        m_report["views"].push_back(viewJson(node));
      else if (node.tag == "Camera")
        m_report["cameras"].push_back(cameraJson(node));
      else if (node.tag.ends_with("Transform"))
        m_report["transforms"].push_back(transformJson(node));
      else
        ++others[node.tag];
    m_report["others"] = others;
  }

  /// Maps each display to its volume.
  void findOwners() {
    for (const MrmlNode& node : document().nodes())
      if (const auto displays = node.references.find("display");
          isScalarVolume(node) && displays != node.references.end())
        for (const std::string& id : displays->second)
          m_displayOwners.emplace(id, node.id);
  }

  /// NODE and `more` members.
  Json nodeJson(const MrmlNode& node, const Json& more = Json::object()) const {
    Json json = fenestra::core::nodeJson(node.id, node.name);
    for (const std::string& file : listStorageFiles(m_scene, node))
      json["files"].push_back({{"name", decodeUrl(file)}, {"there", m_scene.files.contains(file)}});
    json["transform"] = nullIfEmpty(idOrEmpty(document().follow(node, "transform")));
    json["used"] = m_used.contains(&node);
    json.update(more);
    return json;
  }

  /// True for unused nodes after the first 64 of a list: reading their files would take too long.
  bool isSkipped(const char* list, Json& node) const {
    constexpr std::size_t maxRead = 64;
    if (m_report[list].size() < maxRead || node["used"] == true)
      return false;
    node["problem"] = concat("not read, since only the first ", maxRead, " of a kind are read");
    return true;
  }

  Json segmentationJson(const MrmlNode& node) {
    const MrmlNode* display = document().follow(node, "display");
    const bool shown = isLabelMap(node) || !display || isVisible(*display);
    Json json =
        nodeJson(node, segmentationMembers(isLabelMap(node) ? "labelMap" : "segmentation", shown));
    if (isSkipped("segmentations", json))
      return json;
    if (const auto segmentation = tryRead(
            [&] { return readSceneSegmentation(m_scene, node, volumeGrid(), m_request.labels); },
            json["problem"]))
      addSegments(*segmentation, readSegmentVisibility(m_scene, node), json);
    return json;
  }

  Json renderingJson(const MrmlNode& node) const {
    const auto owner = m_displayOwners.find(node.id);
    return nodeJson(node,
                    {{"volume", nullIfEmpty(owner == m_displayOwners.end() ? "" : owner->second)},
                     {"property", nullIfEmpty(node.referenceId("volumeProperty"))},
                     {"roi", nullIfEmpty(node.referenceId("roi"))},
                     {"cropping", node.boolean("croppingEnabled", false)},
                     {"followsDisplay", node.boolean("followVolumeDisplayNode", false)},
                     {"shown", isVisible(node)}});
  }

  Json viewJson(const MrmlNode& node) const {
    return nodeJson(node, {{"layout", nullIfEmpty(findLayoutName(node))},
                           {"technique", nullIfEmpty(node.text("raycastTechnique"))},
                           {"background", backgroundColors(node)}});
  }

  std::optional<CameraPose> readCamera(const MrmlNode& node, Json& problem) {
    return tryRead([&] { return readSceneCamera(m_scene, node); }, problem);
  }

  Json cameraJson(const MrmlNode& node) {
    Json json = nodeJson(node, {{"layout", nullIfEmpty(findLayoutName(node))}});
    if (!isSkipped("cameras", json))
      if (const auto pose = readCamera(node, json["problem"]))
        addPose(*pose, json);
    return json;
  }

  Json transformJson(const MrmlNode& node) {
    Json json = nodeJson(node, {{"linear", false}, {"toWorld", nullptr}});
    // toWorld() includes only the parents of a node, so ask for a child of the transform.
    const MrmlNode child{.tag = node.tag,
                         .id = node.id,
                         .name = node.name,
                         .references = {{"transform", {node.id}}}};
    if (isSkipped("transforms", json))
      return json;
    if (const auto map = tryRead([&] { return toWorld(m_scene, child); }, json["problem"])) {
      json["linear"] = true;
      for (int row = 0; row < 3; ++row) {
        const Vec3 linear = map->linear().row(row);
        json["toWorld"].push_back({linear.x(), linear.y(), linear.z(), map->translation()[row]});
      }
    }
    return json;
  }

  /// Inspects the requested segmentation if it is a file and not a node of the scene.
  void inspectChosenFile() {
    if (!m_plan || m_plan->segmentation || !m_request.segmentation)
      return;
    const std::filesystem::path path = *m_request.segmentation;
    std::error_code failed;
    if (!std::filesystem::exists(path, failed) && !failed) { // else its reader reports it
      m_report["render"]["segmentationProblem"] =
          makeMessage(ErrorCode::unknownName, path, "neither a node of the scene nor a file");
      return;
    }
    Json segmentation =
        inspectSegmentationFile(path, volumeGrid(), m_request.labels, m_report["warnings"]);
    segmentation["used"] = true;
    m_report["render"]["segmentation"] = nullIfEmpty(path.string());
    m_report["segmentations"].push_back(std::move(segmentation));
  }

  /// Adds a render with a focus of each segmentation, or if there is none, without a focus.
  void addExamples() {
    const Json choice = nullIfEmpty(m_request.volume.name.value_or(""));
    const Json segmentations = m_report["segmentations"];
    for (const Json& one : segmentations) {
      const Json& name = one["id"].is_null() ? one["name"] : one["id"];
      const bool isOnly = segmentations.size() == 1 && !m_request.segmentation;
      addExample(m_input.path().string(), choice, isOnly ? Json() : name, one, m_report);
    }
    if (m_report["examples"].empty())
      m_report["examples"].push_back({{"volume", m_input.path().string()},
                                      {"choice", choice},
                                      {"segmentation", nullptr},
                                      {"focus", nullptr}});
  }

  const RenderRequest& m_request;
  const Input& m_input;
  MrmlScene& m_scene;
  std::optional<ScenePlan> m_plan;
  Json m_segmentationProblem;
  std::optional<Grid> m_grid; ///< of the volume
  std::set<const MrmlNode*> m_used;
  std::map<std::string, std::string> m_displayOwners; ///< volume id by display id
  Json m_unused; ///< problems that are reported elsewhere: with their nodes, or in `refused`
  Inspection m_report;
};

} // namespace

Inspection inspectScene(const RenderRequest& request, const Input& input) {
  return SceneInspector(request, input).inspect();
}

} // namespace fenestra::core
