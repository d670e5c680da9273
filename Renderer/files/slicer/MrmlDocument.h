#pragma once
// MRML scene as stored: nodes with attributes, and references between them. A scene is read in
// three steps: this parser assigns no meanings, ScenePlan chooses the nodes to render, and
// MrmlScene interprets only those.

#include "base/CheckAffine.h"

#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace fenestra::core {

/// One node, like <Volume id="vtkMRMLScalarVolumeNode1" name="CT" ...>.
struct MrmlNode {
  std::string tag, id, name;
  std::map<std::string, std::string> attributes = {}; ///< of the XML element
  /// Ids by role. `references="role:id1 id2;..."` takes precedence over the separate attributes of
  /// older files (storageNodeRef, ROINodeID, ...), as in vtkMRMLNode::ReadXMLAttributes.
  std::map<std::string, std::vector<std::string>> references = {};

  const std::string* find(const std::string& attribute) const;
  std::string text(const std::string& attribute) const; ///< empty: missing
  /// True for "true" and numbers other than 0; `fallback`: missing, or other text.
  bool boolean(const std::string& attribute, bool fallback) const;
  /// Numbers of the attribute; nullopt: missing, or not finite numbers.
  std::optional<std::vector<double>> numbers(const std::string& attribute) const;
  /// The attribute's single number; nullopt: missing, or other text.
  std::optional<double> number(const std::string& attribute) const;
  /// The attribute's three numbers; nullopt: missing, or other text.
  std::optional<Vec3> triple(const std::string& attribute) const;
  /// First id of a role; empty: none.
  std::string referenceId(const std::string& role) const;
};

class MrmlDocument {
public:
  /// `source` is the file name in messages. Throws Error (input) for text that is not MRML, and for
  /// XML with a document type, which could define entities.
  MrmlDocument(std::string_view text, std::string source);

  const std::string& source() const { return m_source; }
  /// Program that wrote the scene, like "Slicer 5.6.2 32448"; empty: unknown.
  const std::string& version() const { return m_version; }
  /// Nodes of the scene itself in file order, without the copies inside scene views.
  const std::vector<MrmlNode>& nodes() const { return m_nodes; }
  /// File names in all elements, including scene views, as written.
  const std::set<std::string>& fileNames() const { return m_fileNames; }
  std::vector<const MrmlNode*> findByTag(std::string_view tag) const;
  /// First node with this id; null: none.
  const MrmlNode* find(const std::string& id) const;
  /// First node that the role references; null: no reference, or no such node.
  const MrmlNode* follow(const MrmlNode& node, const std::string& role) const {
    return find(node.referenceId(role));
  }

  /// Error (input) that states the file and the node.
  Error error(const MrmlNode& node, const std::string& what,
              ErrorCode code = ErrorCode::invalidField) const;
  /// Factory of such errors for a check; adds `subject` before its text and `hint` after it.
  MakeError bindError(const MrmlNode& node, const std::string& subject = "",
                      const std::string& hint = "", ErrorCode code = ErrorCode::invalidField) const;

private:
  std::string m_source, m_version;
  std::vector<MrmlNode> m_nodes;
  std::set<std::string> m_fileNames;
  std::map<std::string, std::size_t> m_byId;
};

/// "CT (vtkMRMLScalarVolumeNode1)", shortened and on one line.
std::string describeNode(const MrmlNode& node);

} // namespace fenestra::core
