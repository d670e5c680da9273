#include "files/slicer/ScenePlan.h"

#include <algorithm>
#include <set>

namespace fenestra {
namespace {

using Nodes = std::vector<const MrmlNode*>;

template <typename Matches>
Nodes those(const Nodes& nodes, Matches&& matches) {
  Nodes found;
  std::ranges::copy_if(nodes, std::back_inserter(found),
                       [&](const MrmlNode* node) { return matches(*node); });
  return found;
}

template <typename Matches>
Nodes nodesThat(const MrmlDocument& document, Matches&& matches) {
  Nodes all;
  for (const MrmlNode& node : document.nodes())
    all.push_back(&node);
  return those(all, matches);
}

std::string listed(const Nodes& nodes) {
  return join(
      nodes, ", ", [](const MrmlNode* node) { return shown(*node); }, 20, "...");
}

/// Node by id, else by name; null: none. Throws Error (input) where several have the name.
const MrmlNode* named(const MrmlDocument& document, const Nodes& nodes, const std::string& name,
                      const std::string& flag) {
  const Nodes byId = those(nodes, [&](const MrmlNode& node) { return node.id == name; });
  if (!byId.empty())
    return byId.front();
  const Nodes byName = those(nodes, [&](const MrmlNode& node) { return node.name == name; });
  if (byName.size() > 1)
    throw inputError(document.source(), "--", flag, " ", name, " can be any of ", listed(byName),
                     "; name one by its id");
  return byName.empty() ? nullptr : byName.front();
}

/// Node of the first list that has any; null: none has. Throws Error (input) where that list has
/// several.
const MrmlNode* onlyOne(const MrmlDocument& document, std::initializer_list<const Nodes*> lists,
                        const char* what, const char* flag) {
  for (const Nodes* candidates : lists)
    if (candidates->size() > 1)
      throw inputError(document.source(), "has several ", what, " (", listed(*candidates),
                       "); choose one with --", flag);
    else if (!candidates->empty())
      return candidates->front();
  return nullptr;
}

/// First display of the volume that matches; null: none.
template <typename Matches>
const MrmlNode* displayOf(const MrmlDocument& document, const MrmlNode& volume, Matches&& matches) {
  const auto displays = volume.references.find("display");
  if (displays != volume.references.end())
    for (const std::string& id : displays->second)
      if (const MrmlNode* display = document.find(id); display && matches(*display))
        return display;
  return nullptr;
}

/// Volume rendering display of the volume: a shown one, else the first; null: none.
const MrmlNode* renderingOf(const MrmlDocument& document, const MrmlNode& volume) {
  const MrmlNode* visible = displayOf(document, volume, [](const MrmlNode& display) {
    return isVolumeRendering(display) && isShown(display);
  });
  return visible ? visible : displayOf(document, volume, isVolumeRendering);
}

const MrmlNode* chooseVolume(const MrmlDocument& document,
                             const std::optional<std::string>& choice) {
  const Nodes volumes = nodesThat(document, isScalarVolume);
  if (volumes.empty())
    throw inputError(document.source(), "holds no scalar volume; add one in Slicer and save again");
  if (choice) {
    if (const MrmlNode* volume = named(document, volumes, *choice, "volume"))
      return volume;
    throw inputError(document.source(), "has no scalar volume \"", *choice, "\"; it has ",
                     listed(volumes));
  }
  // Candidates in this order: rendered in Slicer, renderable, active in Slicer, all.
  const Nodes rendered = those(volumes, [&](const MrmlNode& volume) {
    const MrmlNode* display = renderingOf(document, volume);
    return display && isShown(*display);
  });
  const Nodes renderable = those(
      volumes, [&](const MrmlNode& volume) { return renderingOf(document, volume) != nullptr; });
  std::set<std::string> selected;
  for (const MrmlNode* selection : document.withTag("Selection"))
    selected.insert(selection->referenced("ActiveVolume"));
  const Nodes active =
      those(volumes, [&](const MrmlNode& volume) { return selected.contains(volume.id); });
  return onlyOne(document, {&rendered, &renderable, &active, &volumes}, "volumes to render",
                 "volume");
}

const MrmlNode* chooseSegmentation(const MrmlDocument& document, const SceneChoice& choice) {
  const Nodes segmentations = document.withTag("Segmentation");
  const Nodes labelMaps = nodesThat(document, isLabelMap);
  Nodes both = segmentations;
  both.insert(both.end(), labelMaps.begin(), labelMaps.end());
  if (choice.segmentation)
    return named(document, both, *choice.segmentation, "segmentation");
  if (!choice.needsSegmentation)
    return nullptr;
  const Nodes shownOnes = those(segmentations, [&](const MrmlNode& node) {
    const MrmlNode* display = document.follow(node, "display");
    return !display || isShown(*display);
  });
  if (const MrmlNode* one = onlyOne(document, {&shownOnes, &segmentations, &labelMaps},
                                    "segmentations", "segmentation"))
    return one;
  throw inputError(document.source(),
                   "has no segmentation to find segments in; give --segmentation FILE");
}

/// Rank of a view: the user most likely looked at the view of the greatest rank.
int likelihood(const MrmlNode& view) {
  const bool inLayout = view.text("attributes").find("MappedInLayout:1") != std::string::npos;
  return 4 * view.flag("active", false) + 2 * inLayout + view.flag("visibility", true);
}

const MrmlNode* chooseView(const MrmlDocument& document, const MrmlNode* rendering) {
  Nodes views = document.withTag("View");
  if (rendering && rendering->references.contains("view")) {
    const std::vector<std::string>& inViews = rendering->references.at("view");
    const std::set<std::string> ids(inViews.begin(), inViews.end());
    const Nodes own = those(views, [&](const MrmlNode& view) { return ids.contains(view.id); });
    views = own.empty() ? views : own;
  }
  const auto best =
      std::max_element(views.begin(), views.end(), [](const MrmlNode* a, const MrmlNode* b) {
        return likelihood(*a) < likelihood(*b);
      });
  return best == views.end() ? nullptr : *best;
}

/// Camera of a view: by layout name, in older scenes by the view's id, else the only camera; null:
/// none.
const MrmlNode* cameraOf(const MrmlDocument& document, const MrmlNode* view) {
  const Nodes cameras = document.withTag("Camera");
  if (view) {
    const std::string layout = layoutOf(*view);
    for (const MrmlNode* camera : cameras) {
      const std::string active = camera->text("activetag");
      if ((!layout.empty() && layoutOf(*camera) == layout) ||
          (!active.empty() && active == view->id))
        return camera;
    }
  }
  return cameras.size() == 1 ? cameras.front() : nullptr;
}

/// Refuses maximum and minimum intensity projections, which have no light to trace.
void refuseTechnique(const MrmlDocument& document, const MrmlNode* node) {
  if (!node)
    return;
  static const std::map<std::string, std::string> refused = {
      {"MaximumIntensityProjection", "a maximum intensity projection"},
      {"MinimumIntensityProjection", "a minimum intensity projection"},
      {"2", "a maximum intensity projection"}, // number in older scenes
      {"3", "a minimum intensity projection"}};
  if (const auto technique = refused.find(node->text("raycastTechnique"));
      technique != refused.end())
    throw document.error(*node, "raycastTechnique is " + technique->second +
                                    ", which has no light to trace; set it to Composite (Volume "
                                    "Rendering module), or render the volume's own file");
}

std::string said(const MrmlNode& node, const std::string& why) {
  return node.tag + " " + shown(node) + ": " + why;
}

void addAll(const Nodes& nodes, const std::string& why, std::vector<std::string>& list) {
  constexpr std::size_t most = 3; // scenes have hundreds of models
  if (nodes.size() > most)
    list.push_back(std::to_string(nodes.size()) + " nodes " + nodes.front()->tag + ": " + why);
  else
    for (const MrmlNode* node : nodes)
      list.push_back(said(*node, why));
}

/// Lists settings of the rendering that a path tracer lacks.
void listRendering(const MrmlDocument& document, ScenePlan& plan) {
  const MrmlNode& rendering = *plan.rendering;
  if (!isShown(rendering))
    plan.ignored.push_back(said(rendering, "is hidden in Slicer; its settings are used anyway"));
  if (const MrmlNode* clip = document.follow(rendering, "ClipNode");
      clip && rendering.flag("clipping", false))
    plan.warnings.push_back(said(*clip, "clips the rendering in Slicer, and is ignored here"));
  if (const MrmlNode* shader = document.follow(rendering, "shaderProperty"))
    plan.ignored.push_back(said(*shader, "shaders have no meaning in path tracing"));
  if (const MrmlNode* roi = document.follow(rendering, "roi"); roi && !plan.roi)
    plan.ignored.push_back(said(*roi, "cropping is off"));
  if (!plan.roi && rendering.flag("croppingEnabled", false))
    plan.warnings.push_back(said(rendering, "cropping is on without a region of interest"));
}

void listOthers(const MrmlDocument& document, ScenePlan& plan) {
  const auto list = [&](auto&& matches, const MrmlNode* used, const std::string& why) {
    addAll(
        nodesThat(document, [&](const MrmlNode& node) { return &node != used && matches(node); }),
        why, plan.ignored);
  };
  const auto tagged = [](const char* tag) {
    return [tag](const MrmlNode& node) { return node.tag == tag; };
  };
  list(isScalarVolume, plan.volume, "another volume is rendered");
  list(tagged("View"), plan.view, "another view is rendered");
  list(tagged("Camera"), plan.camera, "another camera is used");
  for (const char* tag :
       {"VectorVolume", "DiffusionTensorVolume", "DiffusionWeightedVolume", "Sequence"})
    list(tagged(tag), nullptr, "only scalar volumes are rendered");
  for (const char* tag : {"Model", "FiberBundle", "MarkupsFiducial", "MarkupsCurve",
                          "MarkupsClosedCurve", "MarkupsLine", "MarkupsAngle", "MarkupsPlane"})
    list(tagged(tag), nullptr, "surfaces and markups are not rendered");
}

} // namespace

ScenePlan planRender(const MrmlDocument& document, const SceneChoice& choice) {
  ScenePlan plan;
  plan.volume = chooseVolume(document, choice.volume);
  plan.rendering = renderingOf(document, *plan.volume);
  plan.segmentation = chooseSegmentation(document, choice);
  plan.view = chooseView(document, plan.rendering);
  plan.camera = cameraOf(document, plan.view);
  if (plan.rendering) {
    plan.property = document.follow(*plan.rendering, "volumeProperty");
    if (plan.rendering->flag("croppingEnabled", false))
      plan.roi = document.follow(*plan.rendering, "roi");
    refuseTechnique(document, plan.view);
    refuseTechnique(document, plan.rendering);
    if (plan.rendering->flag("followVolumeDisplayNode", false))
      plan.followed = displayOf(document, *plan.volume, [](const MrmlNode& display) {
        return display.tag == "VolumeDisplay";
      });
    listRendering(document, plan);
  }
  listOthers(document, plan);
  return plan;
}

} // namespace fenestra
