#include "files/slicer/FocusNodes.h"

#include "base/Text.h"
#include "files/slicer/ScenePlan.h"
#include "io/MessageText.h"

#include <algorithm>
#include <map>

namespace fenestra::core {
namespace {

class FocusSearch {
public:
  FocusSearch(MrmlScene& scene, const std::optional<std::string>& labels)
      : m_scene(scene), m_labels(labels) {}

  /// Node of the first list that has nodes with the segment; if there are none, the only node of
  /// the first list, which suggests its own segments.
  const MrmlNode* find(const std::vector<SegmentationNodes>& lists, const std::string& selector) {
    for (const SegmentationNodes& nodes : lists) {
      SegmentationNodes found;
      std::ranges::copy_if(nodes, std::back_inserter(found), [&](const MrmlNode* node) {
        return std::ranges::any_of(readInfos(*node), [&](const SegmentInfo& segment) {
          return isSelected(segment, selector);
        });
      });
      if (found.size() > 1)
        throw inputError(
            ErrorCode::ambiguousSegmentation, m_scene.document.source(),
            "has several segmentations with the segment \"", sanitize(selector),
            "\": ", join(found, ", ", [](const MrmlNode* node) { return describeNode(*node); }));
      if (!found.empty())
        return found.front();
    }
    const auto first =
        std::ranges::find_if(lists, [](const SegmentationNodes& nodes) { return !nodes.empty(); });
    if (first->size() == 1)
      return first->front();
    if (m_problem)
      throw *m_problem;
    throw inputError(ErrorCode::ambiguousSegmentation, m_scene.document.source(),
                     "has several segmentations, but none with the segment \"", sanitize(selector),
                     '"');
  }

private:
  /// Segments of a node, read once; empty if its values have no names or it cannot be read.
  const std::vector<SegmentInfo>& readInfos(const MrmlNode& node) {
    const auto [entry, isNew] = m_infos.try_emplace(&node);
    if (isNew)
      try {
        entry->second = readSceneSegmentInfos(m_scene, node, m_labels);
      } catch (const Error& error) {
        if (!m_problem)
          m_problem.emplace(error);
      }
    return entry->second;
  }

  MrmlScene& m_scene;
  const std::optional<std::string>& m_labels;
  std::map<const MrmlNode*, std::vector<SegmentInfo>> m_infos;
  std::optional<Error> m_problem; ///< of the first node that cannot be read
};

} // namespace

std::vector<const MrmlNode*> findFocusNodes(MrmlScene& scene, const std::vector<std::string>& focus,
                                            const std::optional<std::string>& labels) {
  if (std::ranges::count_if(scene.document.nodes(), isSegmentation) < 2)
    return {};
  const std::vector<SegmentationNodes> lists = listSegmentations(scene.document);
  FocusSearch search(scene, labels);
  std::vector<const MrmlNode*> nodes;
  for (const std::string& selector : focus)
    if (const MrmlNode* node = search.find(lists, selector);
        std::ranges::find(nodes, node) == nodes.end())
      nodes.push_back(node);
  return nodes;
}

} // namespace fenestra::core
