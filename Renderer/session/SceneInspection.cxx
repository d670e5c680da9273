// Inspection of Slicer scenes: the parts that a render uses, then every node by itself.

#include "files/slicer/ScenePlan.h"
#include "session/Defaults.h"
#include "session/InspectionParts.h"

#include <algorithm>
#include <set>

namespace fenestra {
namespace {

bool isRoi(const MrmlNode& node) {
  return node.tag == "MarkupsROI" || node.tag == "AnnotationROI" || node.tag == "ROI" ||
         node.tag == "MRMLROINode";
}

bool isSegmentation(const MrmlNode& node) {
  return node.tag == "Segmentation" || isLabelMap(node);
}

bool isTransform(const MrmlNode& node) {
  return node.tag.ends_with("Transform");
}

std::string idOf(const MrmlNode* node) {
  return node ? node->id : std::string();
}

class SceneInspector {
public:
  explicit SceneInspector(const SceneRequest& request)
      : m_request(request), m_scene(request.input) {
    m_result.kind = InputKind::scene;
    m_result.version = m_scene.document.version();
  }

  Inspection inspect() {
    plan();
    if (m_plan)
      inspectRender();
    inspectNodes();
    inspectChosenFile();
    return std::move(m_result);
  }

private:
  const MrmlDocument& document() const { return m_scene.document; }
  const Grid* volumeGrid() const { return m_grid ? &*m_grid : nullptr; }

  /// Plans a render with a focus; if only the focus's segmentation is undecided, one without.
  void plan() {
    SceneChoice choice{m_request.volume, m_request.segmentation, true};
    const auto planned = [&] { return planRender(document(), choice); };
    std::string problem;
    m_plan = attempted(planned, problem);
    if (!m_plan) {
      choice.needsSegmentation = false;
      m_plan = attempted(planned, m_result.refused);
      const auto& nodes = document().nodes();
      if (std::any_of(nodes.begin(), nodes.end(), isSegmentation))
        m_segmentationProblem = problem;
    }
  }

  // ---- what a render would use
  // -------------------------------------------------------------------

  void inspectRender() {
    RenderUse& use = m_result.render.emplace();
    use.segmentationProblem = m_segmentationProblem;
    m_result.warnings = m_plan->warnings;
    m_result.ignored = m_plan->ignored;
    readRender(use);
    if (use.volume) {
      use.volume->id = m_plan->volume->id;
      use.volume->transforms = transformsAbove(document(), *m_plan->volume);
    }
    if (m_plan->roi)
      use.crop = cropUse(*m_plan->roi);
    if (m_plan->camera && !use.camera)
      if (const auto pose = readCamera(*m_plan->camera, m_unused))
        use.camera = CameraUse{"", "", *pose};
    if (m_plan->camera && use.camera) {
      use.camera->id = m_plan->camera->id;
      use.camera->name = m_plan->camera->name;
    }
    if (m_plan->view) {
      const ViewBackground colors = viewBackground(*m_plan->view);
      use.background = BackgroundUse{m_plan->view->id, colors.bottom, colors.top};
    }
    use.segmentation = idOf(m_plan->segmentation);
    noteUsed(use);
  }

  /// Finds volume, look and camera by making a Scene; if the Scene fails, by reading volume and
  /// look.
  void readRender(RenderUse& use) {
    const auto scene =
        attempted([&] { return std::make_unique<Scene>(m_request); }, m_result.refused);
    if (scene) {
      use.volume = volumeUse((*scene)->volume());
      m_grid = (*scene)->volume().grid;
      use.look = lookUse((*scene)->volume(), (*scene)->look());
      use.camera = CameraUse{"", "", (*scene)->camera().pose()};
      m_result.warnings = (*scene)->warnings();
      return;
    }
    if (const auto volume =
            attempted([&] { return readSceneVolume(m_scene, *m_plan->volume); }, m_unused)) {
      use.volume = volumeUse(*volume);
      m_grid = volume->grid;
      use.look = lookUse(*volume, m_plan->property ? m_plan->property->name : "");
    }
  }

  /// `look`: Scene::look of the render.
  LookUse lookUse(const Volume& volume, const std::string& look) const {
    const MrmlNode* property = m_plan->property;
    if (property && look == property->name)
      return {LookSource::volumeProperty, property->id, property->name};
    if (m_plan->followed)
      return {LookSource::volumeDisplay, m_plan->followed->id, m_plan->followed->name};
    return defaultLook(volume);
  }

  std::optional<CropUse> cropUse(const MrmlNode& roi) {
    const auto box = attempted([&] { return readSceneRoi(m_scene, roi); }, m_unused);
    if (!box)
      return std::nullopt;
    const Vec3 halfEdges = box->boxToWorld.linear().columnNorms();
    return CropUse{roi.id, roi.name, 2.0 * halfEdges, box->boxToWorld.translation()};
  }

  void noteUsed(const RenderUse& use) {
    for (const MrmlNode* node : {m_plan->volume, m_plan->rendering, m_plan->roi,
                                 m_plan->segmentation, m_plan->view, m_plan->camera})
      if (node) {
        m_used.insert(node);
        if (node != m_plan->view)
          for (const std::string& id : transformsAbove(document(), *node))
            m_used.insert(document().find(id));
      }
    if (m_plan->property && use.look && use.look->source == LookSource::volumeProperty)
      m_used.insert(m_plan->property);
  }

  // ---- every node
  // ---------------------------------------------------------------------------------

  void inspectNodes() {
    findOwners();
    for (const MrmlNode& node : document().nodes())
      if (isScalarVolume(node))
        m_result.volumes.push_back(summary(node));
      else if (isSegmentation(node))
        m_result.segmentations.push_back(segmentationSummary(node));
      else if (isVolumeRendering(node))
        m_result.renderings.push_back(renderingSummary(node));
      else if (node.tag == "VolumeProperty")
        m_result.properties.push_back(summary(node));
      else if (isRoi(node))
        m_result.rois.push_back(summary(node));
      else if (node.tag == "View")
        m_result.views.push_back(viewSummary(node));
      else if (node.tag == "Camera")
        m_result.cameras.push_back(cameraSummary(node));
      else if (isTransform(node))
        m_result.transforms.push_back(transformSummary(node));
      else
        ++m_result.others[node.tag];
  }

  /// Maps each display to its volume.
  void findOwners() {
    for (const MrmlNode& node : document().nodes())
      if (const auto displays = node.references.find("display");
          isScalarVolume(node) && displays != node.references.end())
        for (const std::string& id : displays->second)
          m_owners.emplace(id, node.id);
  }

  NodeSummary summary(const MrmlNode& node) const {
    NodeSummary result{.id = node.id, .name = node.name};
    for (const std::string& file : storedFiles(m_scene, node))
      result.files.push_back({decodedUrl(file), m_scene.files.holds(file)});
    result.transform = idOf(document().follow(node, "transform"));
    result.used = m_used.contains(&node);
    return result;
  }

  /// True for nodes after the first 64 that no render uses: reading files takes time.
  static bool isSkipped(std::size_t before, NodeSummary& node) {
    constexpr std::size_t mostRead = 64;
    if (before < mostRead || node.used)
      return false;
    node.problem = "not looked into: there are " + std::to_string(mostRead) + " before it";
    return true;
  }

  SegmentationSummary segmentationSummary(const MrmlNode& node) {
    SegmentationSummary result{.node = summary(node), .isLabelMap = isLabelMap(node)};
    const MrmlNode* display = document().follow(node, "display");
    result.shown = result.isLabelMap || !display || isShown(*display);
    if (isSkipped(m_result.segmentations.size(), result.node))
      return result;
    if (const auto segmentation =
            attempted([&] { return readSceneSegmentation(m_scene, node, volumeGrid()); },
                      result.node.problem))
      describe(*segmentation, segmentVisibility(m_scene, node), result);
    return result;
  }

  RenderingSummary renderingSummary(const MrmlNode& node) const {
    const auto owner = m_owners.find(node.id);
    return {.node = summary(node),
            .volume = owner == m_owners.end() ? "" : owner->second,
            .property = node.referenced("volumeProperty"),
            .roi = node.referenced("roi"),
            .cropping = node.flag("croppingEnabled", false),
            .followsDisplay = node.flag("followVolumeDisplayNode", false),
            .shown = isShown(node)};
  }

  ViewSummary viewSummary(const MrmlNode& node) const {
    const ViewBackground background = viewBackground(node);
    return {.node = summary(node),
            .layout = layoutOf(node),
            .technique = node.text("raycastTechnique"),
            .bottom = background.bottom,
            .top = background.top};
  }

  std::optional<CameraPose> readCamera(const MrmlNode& node, std::string& problem) {
    return attempted([&] { return readSceneCamera(m_scene, node); }, problem);
  }

  CameraSummary cameraSummary(const MrmlNode& node) {
    CameraSummary result{.node = summary(node), .layout = layoutOf(node)};
    if (!isSkipped(m_result.cameras.size(), result.node))
      result.pose = readCamera(node, result.node.problem);
    return result;
  }

  TransformSummary transformSummary(const MrmlNode& node) {
    TransformSummary result{.node = summary(node)};
    const MrmlNode below{.tag = node.tag,
                         .id = node.id,
                         .name = node.name,
                         .references = {{"transform", {node.id}}}};
    if (!isSkipped(m_result.transforms.size(), result.node))
      result.toWorld = attempted([&] { return toWorld(m_scene, below); }, result.node.problem);
    return result;
  }

  /// Inspects a requested segmentation that is not in the scene, but may be a file.
  void inspectChosenFile() {
    if (!m_plan || m_plan->segmentation || !m_request.segmentation)
      return;
    const std::filesystem::path path = *m_request.segmentation;
    std::error_code failed;
    if (!std::filesystem::exists(path, failed) && !failed) { // else its reader reports why
      m_result.render->segmentationProblem =
          "--segmentation " + path.string() + ": is neither in the scene nor a file";
      return;
    }
    SegmentationSummary result{.node = {.id = "", .name = path.string(), .used = true}};
    if (const auto segmentation =
            attempted([&] { return readSegmentation(path, volumeGrid()); }, result.node.problem))
      describe(*segmentation, {}, result);
    m_result.render->segmentation = path.string();
    m_result.segmentations.push_back(std::move(result));
  }

  const SceneRequest& m_request;
  MrmlScene m_scene;
  std::optional<ScenePlan> m_plan;
  std::string m_segmentationProblem;
  std::optional<Grid> m_grid; ///< of the volume
  std::set<const MrmlNode*> m_used;
  std::map<std::string, std::string> m_owners;
  std::string m_unused; ///< problems reported elsewhere: with their nodes, or in `refused`
  Inspection m_result;
};

} // namespace

Inspection inspectScene(const SceneRequest& request) {
  return SceneInspector(request).inspect();
}

} // namespace fenestra
