#pragma once
// A MRML scene as the file has it: nodes with attributes, and references between them. What the
// nodes mean is MrmlScene's.

#include "base/Error.h"

#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace fenestra {

/// One node, like <Volume id="vtkMRMLScalarVolumeNode1" name="CT" ...>.
struct MrmlNode {
  std::string tag, id, name;
  std::map<std::string, std::string> attributes = {}; ///< of the XML element
  /// Ids by role. Of the two forms a node may have, `references="role:id1 id2;..."` wins over
  /// attributes of its own as older files have them (storageNodeRef, ROINodeID, ...), as in
  /// vtkMRMLNode::ReadXMLAttributes.
  std::map<std::string, std::vector<std::string>> references = {};

  const std::string* find(const std::string& attribute) const;
  std::string text(const std::string& attribute) const; ///< empty where it is missing
  /// "true" and numbers other than 0; `otherwise` where it is missing or neither.
  bool flag(const std::string& attribute, bool otherwise) const;
  /// All numbers of the attribute; nothing where it is missing, or holds anything but finite
  /// numbers.
  std::optional<std::vector<double>> numbers(const std::string& attribute) const;
  /// The first id of a role, empty where there is none.
  std::string referenced(const std::string& role) const;
};

class MrmlDocument {
public:
  /// `source` names the file in messages. Throws Error (input) for anything but MRML, and for XML
  /// with a document type, which could define entities.
  MrmlDocument(std::string_view text, std::string source);

  const std::string& source() const { return m_source; }
  /// Who wrote it, as it says: "Slicer 5.6.2 32448"; empty where it does not.
  const std::string& version() const { return m_version; }
  /// Those of the scene itself, in their order; scene views hold copies, which do not count.
  const std::vector<MrmlNode>& nodes() const { return m_nodes; }
  /// What any element calls a file of its own, as it is written; those in scene views, too.
  const std::set<std::string>& fileNames() const { return m_fileNames; }
  std::vector<const MrmlNode*> withTag(std::string_view tag) const;
  /// The first with this id; nothing where there is none.
  const MrmlNode* find(const std::string& id) const;
  /// The first one that the role names; nothing where the role is empty or names no node.
  const MrmlNode* follow(const MrmlNode& node, const std::string& role) const {
    return find(node.referenced(role));
  }

  /// Names the file and the node.
  Error error(const MrmlNode& node, const std::string& what) const;

private:
  std::string m_source, m_version;
  std::vector<MrmlNode> m_nodes;
  std::set<std::string> m_fileNames;
  std::map<std::string, std::size_t> m_byId;
};

/// "CT (vtkMRMLScalarVolumeNode1)", on one line and short.
std::string shown(const MrmlNode& node);

} // namespace fenestra
