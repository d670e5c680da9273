#include "files/slicer/MrmlDocument.h"

#include "io/MessageText.h"

#include <pugixml.hpp>

#include <algorithm>

namespace fenestra::core {
namespace {

constexpr std::size_t maxNodes = 100'000, maxAttributes = 1'000'000; ///< limits of a scene

/// Attributes that hold references in older files, with their current role. The first of two with
/// the same role takes precedence.
constexpr std::pair<const char*, const char*> legacyRoles[] = {
    {"displayNodeID", "display"},
    {"displayNodeRef", "display"},
    {"storageNodeID", "storage"},
    {"storageNodeRef", "storage"},
    {"transformNodeID", "transform"},
    {"transformNodeRef", "transform"},
    {"colorNodeID", "color"},
    {"colorNodeRef", "color"},
    {"viewNodeIDs", "view"},
    {"viewNodeRef", "view"},
    {"activeVolumeID", "ActiveVolume"},
    {"volumePropertyNodeID", "volumeProperty"},
    {"ROINodeID", "roi"},
    {"shaderPropertyNodeId", "shaderProperty"}};

/// Format: "role1:id1 {key=value} id2;role2:id3;"; braces hold properties of the reference before.
void readReferences(const std::string& text, MrmlNode& node) {
  for (const std::string& entry : split(text, ';')) {
    const std::size_t colon = entry.find(':');
    if (colon == std::string::npos || colon == 0)
      continue;
    std::vector<std::string> ids = splitWords(entry.substr(colon + 1));
    std::erase_if(
        ids, [](const std::string& word) { return word.find_first_of("{}") != std::string::npos; });
    if (!ids.empty())
      node.references.try_emplace(entry.substr(0, colon), std::move(ids));
  }
}

MrmlNode readNode(const pugi::xml_node& element) {
  MrmlNode node{.tag = element.name(), .id = "", .name = ""};
  for (const pugi::xml_attribute& attribute : element.attributes())
    node.attributes.emplace(attribute.name(), attribute.value());
  node.id = node.text("id");
  node.name = node.text("name");
  readReferences(node.text("references"), node);
  for (const auto& [attribute, role] : legacyRoles)
    if (std::vector<std::string> ids = splitWords(node.text(attribute)); !ids.empty())
      node.references.try_emplace(role, std::move(ids));
  return node;
}

/// Collects file names from elements at any depth without recursion.
struct FileNameCollector final : pugi::xml_tree_walker {
  bool for_each(pugi::xml_node& element) override {
    for (const pugi::xml_attribute& attribute : element.attributes()) {
      const std::string_view name = attribute.name();
      if (*attribute.value() && (name == "fileName" || name.starts_with("fileListMember")))
        found.emplace(attribute.value());
    }
    return true;
  }

  std::set<std::string> found;
};

} // namespace

const std::string* MrmlNode::find(const std::string& attribute) const {
  const auto it = attributes.find(attribute);
  return it == attributes.end() ? nullptr : &it->second;
}

std::string MrmlNode::text(const std::string& attribute) const {
  const std::string* value = find(attribute);
  return value ? *value : std::string();
}

bool MrmlNode::boolean(const std::string& attribute, bool fallback) const {
  const std::string* value = find(attribute);
  if (!value)
    return fallback;
  if (*value == "true" || *value == "false")
    return *value == "true";
  return number(attribute).value_or(fallback) != 0.0;
}

std::optional<std::vector<double>> MrmlNode::numbers(const std::string& attribute) const {
  const std::string* value = find(attribute);
  return value ? parseNumbers(*value) : std::nullopt;
}

std::optional<double> MrmlNode::number(const std::string& attribute) const {
  const auto all = numbers(attribute);
  return all && all->size() == 1 ? std::optional(all->front()) : std::nullopt;
}

std::optional<Vec3> MrmlNode::triple(const std::string& attribute) const {
  const auto all = numbers(attribute);
  if (!all || all->size() != 3)
    return std::nullopt;
  return Vec3((*all)[0], (*all)[1], (*all)[2]);
}

std::string MrmlNode::referenceId(const std::string& role) const {
  const auto it = references.find(role);
  return it == references.end() ? std::string() : it->second.front();
}

MrmlDocument::MrmlDocument(std::string_view text, std::string source)
    : m_source(std::move(source)) {
  pugi::xml_document document;
  const pugi::xml_parse_result result =
      document.load_buffer(text.data(), text.size(), pugi::parse_default | pugi::parse_doctype);
  if (!result)
    throw inputError(ErrorCode::damagedFile, m_source, "is not complete XML (",
                     result.description(), " at byte ", result.offset, "); save the scene again");
  for (const pugi::xml_node& child : document)
    if (child.type() == pugi::node_doctype)
      throw inputError(m_source, "has a document type, which could define entities and is never "
                                 "needed in MRML; remove the line <!DOCTYPE ...>");
  const pugi::xml_node root = document.child("MRML");
  if (!root)
    throw inputError(ErrorCode::unsupportedFile, m_source,
                     "has no MRML element, so it is not a scene; give a .mrml or .mrb");
  m_version = root.attribute("version").value();
  FileNameCollector names;
  document.traverse(names);
  m_fileNames = std::move(names.found);
  std::size_t attributes = 0;
  for (const pugi::xml_node& element : root.children())
    if (element.type() == pugi::node_element) {
      if (m_nodes.size() == maxNodes)
        throw inputError(ErrorCode::limitExceeded, m_source,
                         "has more than 100000 nodes; save a smaller scene");
      m_nodes.push_back(readNode(element));
      attributes += m_nodes.back().attributes.size();
      if (attributes > maxAttributes)
        throw inputError(ErrorCode::limitExceeded, m_source,
                         "has more than a million attributes; save a smaller scene");
      if (!m_nodes.back().id.empty())
        m_byId.emplace(m_nodes.back().id, m_nodes.size() - 1);
    }
}

std::vector<const MrmlNode*> MrmlDocument::findByTag(std::string_view tag) const {
  std::vector<const MrmlNode*> found;
  for (const MrmlNode& node : m_nodes)
    if (node.tag == tag)
      found.push_back(&node);
  return found;
}

const MrmlNode* MrmlDocument::find(const std::string& id) const {
  const auto it = m_byId.find(id);
  return it == m_byId.end() ? nullptr : &m_nodes[it->second];
}

Error MrmlDocument::error(const MrmlNode& node, const std::string& what, ErrorCode code) const {
  return inputError(code, concat(m_source, ": ", node.tag, " ", describeNode(node)), what);
}

MakeError MrmlDocument::bindError(const MrmlNode& node, const std::string& subject,
                                  const std::string& hint, ErrorCode code) const {
  return [=, this, &node](const std::string& what) {
    return error(node, subject + what + hint, code);
  };
}

std::string describeNode(const MrmlNode& node) {
  std::string text = sanitize(node.name);
  if (!node.id.empty())
    text.append(text.empty() ? "(" : " (").append(sanitize(node.id)).append(")");
  return text;
}

} // namespace fenestra::core
