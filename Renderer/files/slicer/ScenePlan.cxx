#include "files/slicer/ScenePlan.h"

#include <algorithm>
#include <set>

namespace fenestra::core {
namespace {

using Nodes = std::vector<const MrmlNode*>;

template <typename Matches>
Nodes filterNodes(const Nodes& nodes, Matches&& matches) {
  Nodes found;
  std::ranges::copy_if(nodes, std::back_inserter(found),
                       [&](const MrmlNode* node) { return matches(*node); });
  return found;
}

template <typename Matches>
Nodes findNodes(const MrmlDocument& document, Matches&& matches) {
  Nodes all;
  for (const MrmlNode& node : document.nodes())
    all.push_back(&node);
  return filterNodes(all, matches);
}

std::string formatNodes(const Nodes& nodes) {
  constexpr std::size_t maxListed = 20;
  return join(
      nodes, ", ", [](const MrmlNode* node) { return describeNode(*node); }, maxListed, "...");
}

/// Node by id, else by name; null: none. Throws Error (input) if several have the name.
const MrmlNode* findNamed(const MrmlDocument& document, const Nodes& nodes,
                          const std::string& name) {
  const Nodes byId = filterNodes(nodes, [&](const MrmlNode& node) { return node.id == name; });
  if (!byId.empty())
    return byId.front();
  const Nodes byName = filterNodes(nodes, [&](const MrmlNode& node) { return node.name == name; });
  if (byName.size() > 1)
    throw inputError(ErrorCode::ambiguousName, document.source(), "\"", name,
                     "\" matches several: ", formatNodes(byName), "; choose one by its id");
  return byName.empty() ? nullptr : byName.front();
}

/// Node of the first list that is not empty; null: all are empty. Throws Error (input) if that list
/// has several nodes.
const MrmlNode* findSingle(const MrmlDocument& document, std::initializer_list<const Nodes*> lists,
                           const char* what, ErrorCode ambiguous) {
  for (const Nodes* candidates : lists)
    if (candidates->size() > 1)
      throw inputError(ambiguous, document.source(), "has several ", what, " (",
                       formatNodes(*candidates), ")");
    else if (!candidates->empty())
      return candidates->front();
  return nullptr;
}

/// First display of the volume that matches; null: none.
template <typename Matches>
const MrmlNode* findDisplay(const MrmlDocument& document, const MrmlNode& volume,
                            Matches&& matches) {
  const auto displays = volume.references.find("display");
  if (displays != volume.references.end())
    for (const std::string& id : displays->second)
      if (const MrmlNode* display = document.find(id); display && matches(*display))
        return display;
  return nullptr;
}

/// Volume rendering display of the volume: the first visible one, else the first; null: none.
const MrmlNode* findRendering(const MrmlDocument& document, const MrmlNode& volume) {
  const MrmlNode* visible = findDisplay(document, volume, [](const MrmlNode& display) {
    return isVolumeRendering(display) && isVisible(display);
  });
  return visible ? visible : findDisplay(document, volume, isVolumeRendering);
}

const MrmlNode* chooseVolume(const MrmlDocument& document,
                             const std::optional<std::string>& choice) {
  const Nodes volumes = findNodes(document, isScalarVolume);
  if (volumes.empty())
    throw inputError(document.source(), "has no scalar volume; add one in Slicer and save again");
  if (choice) {
    if (const MrmlNode* volume = findNamed(document, volumes, *choice))
      return volume;
    throw inputError(ErrorCode::unknownName, document.source(), "has no scalar volume \"", *choice,
                     "\"; it has ", formatNodes(volumes));
  }
  // Candidates in order of preference: rendered in Slicer, renderable, active in Slicer, all.
  const Nodes rendered = filterNodes(volumes, [&](const MrmlNode& volume) {
    const MrmlNode* display = findRendering(document, volume);
    return display && isVisible(*display);
  });
  const Nodes renderable = filterNodes(
      volumes, [&](const MrmlNode& volume) { return findRendering(document, volume) != nullptr; });
  std::set<std::string> selected;
  for (const MrmlNode* selection : document.findByTag("Selection"))
    selected.insert(selection->referenceId("ActiveVolume"));
  const Nodes active =
      filterNodes(volumes, [&](const MrmlNode& volume) { return selected.contains(volume.id); });
  return findSingle(document, {&rendered, &renderable, &active, &volumes}, "volumes to render",
                    ErrorCode::ambiguousVolume);
}

const MrmlNode* chooseSegmentation(const MrmlDocument& document, const SceneSelection& choice) {
  if (choice.segmentation)
    return findNamed(document, findNodes(document, isSegmentation), *choice.segmentation);
  if (!choice.needsSegmentation)
    return nullptr;
  const std::vector<SegmentationNodes> lists = listSegmentations(document);
  if (const MrmlNode* one = findSingle(document, {lists.data(), &lists[1], &lists[2]},
                                       "segmentations", ErrorCode::ambiguousSegmentation))
    return one;
  throw inputError(ErrorCode::segmentationRequired, document.source(),
                   "has no segmentation, but a focus needs one");
}

/// Rank of a view; the highest is most likely the one that the user last used.
int rankView(const MrmlNode& view) {
  const bool inLayout = view.text("attributes").find("MappedInLayout:1") != std::string::npos;
  return 4 * view.boolean("active", false) + 2 * inLayout + view.boolean("visibility", true);
}

const MrmlNode* chooseView(const MrmlDocument& document, const MrmlNode* rendering) {
  Nodes views = document.findByTag("View");
  if (rendering && rendering->references.contains("view")) {
    const std::vector<std::string>& viewIds = rendering->references.at("view");
    const std::set<std::string> ids(viewIds.begin(), viewIds.end());
    const Nodes matching =
        filterNodes(views, [&](const MrmlNode& view) { return ids.contains(view.id); });
    views = matching.empty() ? views : matching;
  }
  const auto best =
      std::max_element(views.begin(), views.end(), [](const MrmlNode* a, const MrmlNode* b) {
        return rankView(*a) < rankView(*b);
      });
  return best == views.end() ? nullptr : *best;
}

/// Camera of a view: by layout name, in older scenes by the view's id, else the only camera; null:
/// none.
const MrmlNode* findCamera(const MrmlDocument& document, const MrmlNode* view) {
  const Nodes cameras = document.findByTag("Camera");
  if (view) {
    const std::string layout = findLayoutName(*view);
    for (const MrmlNode* camera : cameras) {
      const std::string active = camera->text("activetag");
      if ((!layout.empty() && findLayoutName(*camera) == layout) ||
          (!active.empty() && active == view->id))
        return camera;
    }
  }
  return cameras.size() == 1 ? cameras.front() : nullptr;
}

/// Rejects maximum and minimum intensity projections, which have no light transport.
void rejectTechnique(const MrmlDocument& document, const MrmlNode* node) {
  if (!node)
    return;
  static const std::map<std::string, std::string> unsupported = {
      {"MaximumIntensityProjection", "a maximum intensity projection"},
      {"MinimumIntensityProjection", "a minimum intensity projection"},
      {"2", "a maximum intensity projection"}, // number in older scenes
      {"3", "a minimum intensity projection"}};
  if (const auto technique = unsupported.find(node->text("raycastTechnique"));
      technique != unsupported.end())
    throw document.error(*node,
                         "raycastTechnique is " + technique->second +
                             ", which path tracing cannot render; set it to Composite "
                             "(Volume Rendering module), or render the volume's own file",
                         ErrorCode::unsupportedFile);
}

std::string formatNode(const MrmlNode& node) {
  return node.tag + " " + describeNode(node);
}

std::string formatReason(const MrmlNode& node, const std::string& why) {
  return formatNode(node) + ": " + why;
}

void addReasons(const Nodes& nodes, const std::string& why, std::vector<std::string>& list) {
  constexpr std::size_t maxListed = 3; // scenes can have hundreds of models
  if (nodes.size() > maxListed)
    list.push_back(std::to_string(nodes.size()) + " nodes " + nodes.front()->tag + ": " + why);
  else
    for (const MrmlNode* node : nodes)
      list.push_back(formatReason(*node, why));
}

/// Reports settings of the rendering that path tracing does not support.
void listRenderingSettings(const MrmlDocument& document, ScenePlan& plan) {
  const MrmlNode& rendering = *plan.rendering;
  if (!isVisible(rendering))
    plan.ignored.push_back(
        formatReason(rendering, "is hidden in Slicer; its settings are used anyway"));
  const auto warn = [&plan](const MrmlNode& node, const std::string& why) {
    plan.warnings.push_back(makeMessage(ErrorCode::ignoredSceneSetting, formatNode(node), why));
  };
  if (const MrmlNode* clip = document.follow(rendering, "ClipNode");
      clip && rendering.boolean("clipping", false))
    warn(*clip, "clips the rendering in Slicer, but is ignored here");
  if (const MrmlNode* shader = document.follow(rendering, "shaderProperty"))
    plan.ignored.push_back(formatReason(*shader, "path tracing does not use shaders"));
  if (const MrmlNode* roi = document.follow(rendering, "roi"); roi && !plan.roi)
    plan.ignored.push_back(formatReason(*roi, "cropping is off"));
  if (!plan.roi && rendering.boolean("croppingEnabled", false))
    warn(rendering, "cropping is on without a region of interest");
}

void listUnused(const MrmlDocument& document, ScenePlan& plan) {
  const auto list = [&](auto&& matches, const MrmlNode* used, const std::string& why) {
    addReasons(
        findNodes(document, [&](const MrmlNode& node) { return &node != used && matches(node); }),
        why, plan.ignored);
  };
  const auto hasTag = [](const char* tag) {
    return [tag](const MrmlNode& node) { return node.tag == tag; };
  };
  list(isScalarVolume, plan.volume, "another volume is rendered");
  list(hasTag("View"), plan.view, "another view is rendered");
  list(hasTag("Camera"), plan.camera, "another camera is used");
  for (const char* tag :
       {"VectorVolume", "DiffusionTensorVolume", "DiffusionWeightedVolume", "Sequence"})
    list(hasTag(tag), nullptr, "only scalar volumes are rendered");
  for (const char* tag : {"Model", "FiberBundle", "MarkupsFiducial", "MarkupsCurve",
                          "MarkupsClosedCurve", "MarkupsLine", "MarkupsAngle", "MarkupsPlane"})
    list(hasTag(tag), nullptr, "surfaces and markups are not rendered");
}

} // namespace

std::vector<SegmentationNodes> listSegmentations(const MrmlDocument& document) {
  const Nodes segmentations = document.findByTag("Segmentation");
  const Nodes visible = filterNodes(segmentations, [&](const MrmlNode& node) {
    const MrmlNode* display = document.follow(node, "display");
    return !display || isVisible(*display);
  });
  return {visible, segmentations, findNodes(document, isLabelMap)};
}

ScenePlan planRender(const MrmlDocument& document, const SceneSelection& choice) {
  ScenePlan plan;
  plan.volume = chooseVolume(document, choice.volume);
  plan.rendering = findRendering(document, *plan.volume);
  plan.segmentation = chooseSegmentation(document, choice);
  plan.view = chooseView(document, plan.rendering);
  plan.camera = findCamera(document, plan.view);
  if (plan.rendering) {
    plan.property = document.follow(*plan.rendering, "volumeProperty");
    if (plan.rendering->boolean("croppingEnabled", false))
      plan.roi = document.follow(*plan.rendering, "roi");
    rejectTechnique(document, plan.view);
    rejectTechnique(document, plan.rendering);
    if (plan.rendering->boolean("followVolumeDisplayNode", false))
      plan.sliceDisplay = findDisplay(document, *plan.volume, [](const MrmlNode& display) {
        return display.tag == "VolumeDisplay";
      });
    listRenderingSettings(document, plan);
  }
  listUnused(document, plan);
  return plan;
}

} // namespace fenestra::core
