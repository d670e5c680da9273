#include "vtkMRMLFenestraRenderNode.h"

#include "FenestraFlags.h"

#include <vtkObjectFactory.h>

#include <algorithm>

using FenestraScene::Verdict;

vtkMRMLNodeNewMacro(vtkMRMLFenestraRenderNode);

const char* const vtkMRMLFenestraRenderNode::VolumeRole = "volume";
const char* const vtkMRMLFenestraRenderNode::SegmentationRole = "segmentation";
const char* const vtkMRMLFenestraRenderNode::ViewRole = "view";
const char* const vtkMRMLFenestraRenderNode::PlaneRole = "plane";
const char* const vtkMRMLFenestraRenderNode::PictureRole = "picture";
const char* const vtkMRMLFenestraRenderNode::RadianceRole = "radiance";
const char* const vtkMRMLFenestraRenderNode::DepthRole = "depth";
const char* const vtkMRMLFenestraRenderNode::SurfaceRole = "surface";
const char* const vtkMRMLFenestraRenderNode::MeasuresAttribute = "Fenestra.Measures";

vtkMRMLFenestraRenderNode::vtkMRMLFenestraRenderNode() {
  for (const char* role : {VolumeRole, SegmentationRole, ViewRole, PlaneRole, PictureRole,
                           RadianceRole, DepthRole, SurfaceRole})
    this->AddNodeReferenceRole(role);
}

vtkMRMLFenestraRenderNode::~vtkMRMLFenestraRenderNode() = default;

const std::vector<std::string>& vtkMRMLFenestraRenderNode::GetFlagNames() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const FenestraScene::Flag& flag : FenestraScene::flags())
      all.push_back(flag.name);
    return all;
  }();
  return names;
}

const std::vector<std::string>& vtkMRMLFenestraRenderNode::GetTurntableFlagNames() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> own;
    for (const FenestraScene::Flag& flag : FenestraScene::flags())
      if (flag.ofTurntable)
        own.push_back(flag.name);
    return own;
  }();
  return names;
}

void vtkMRMLFenestraRenderNode::SetFlag(const std::string& name, const std::string& value) {
  std::map<std::string, std::string> flags = this->Flags;
  flags[name] = value;
  this->SetFlags(flags);
}

std::string vtkMRMLFenestraRenderNode::GetFlag(const std::string& name) const {
  const auto found = this->Flags.find(name);
  return found == this->Flags.end() ? std::string() : found->second;
}

void vtkMRMLFenestraRenderNode::SetFlags(const std::map<std::string, std::string>& flags) {
  std::map<std::string, std::string> kept, withheld = this->Withheld;
  for (const std::string& name : GetFlagNames()) {
    const auto found = flags.find(name);
    if (found == flags.end() || found->second.empty())
      continue;
    kept.insert(*found);
    withheld.erase(name);
  }
  this->Assign(kept, withheld);
}

void vtkMRMLFenestraRenderNode::Assign(std::map<std::string, std::string> flags,
                                       std::map<std::string, std::string> withheld) {
  if (flags == this->Flags && withheld == this->Withheld)
    return;
  this->Flags = std::move(flags);
  this->Withheld = std::move(withheld);
  this->Modified();
}

bool vtkMRMLFenestraRenderNode::WithholdsFiles() const {
  return std::any_of(this->Withheld.begin(), this->Withheld.end(), [](const auto& one) {
    return FenestraScene::verdictOn(one.first, one.second) == Verdict::file;
  });
}

void vtkMRMLFenestraRenderNode::AllowFiles() {
  std::map<std::string, std::string> flags = this->Flags;
  for (const auto& [name, value] : this->Withheld)
    if (FenestraScene::verdictOn(name, value) == Verdict::file)
      flags[name] = value;
  this->SetFlags(flags);
}

void vtkMRMLFenestraRenderNode::CopyFlags(vtkMRMLFenestraRenderNode* node) {
  this->Assign(node->Flags, node->Withheld);
}

void vtkMRMLFenestraRenderNode::SetFocus(const std::vector<std::string>& segments) {
  std::string text;
  for (const std::string& segment : segments) {
    text += text.empty() ? "" : ",";
    for (const char c : segment)
      text += c == ',' ? std::string("\\,") : std::string(1, c);
  }
  this->SetFlag("focus", text);
}

std::vector<std::string> vtkMRMLFenestraRenderNode::GetFocus() const {
  std::vector<std::string> segments;
  const std::string text = this->GetFlag("focus");
  std::string segment;
  for (size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\\' && i + 1 < text.size() && text[i + 1] == ',')
      segment += text[++i];
    else if (text[i] != ',')
      segment += text[i];
    else
      segments.push_back(std::move(segment)), segment.clear();
  }
  if (!text.empty())
    segments.push_back(segment);
  return segments;
}

void vtkMRMLFenestraRenderNode::ReadXMLAttributes(const char** atts) {
  const int wasModifying = this->StartModify();
  Superclass::ReadXMLAttributes(atts);
  const std::vector<std::string>& names = GetFlagNames();
  std::map<std::string, std::string> flags, withheld;
  for (; atts[0] && atts[1]; atts += 2)
    if (std::find(names.begin(), names.end(), atts[0]) != names.end() && *atts[1] != '\0')
      (FenestraScene::verdictOn(atts[0], atts[1]) == Verdict::good ? flags : withheld)[atts[0]] =
          atts[1];
  this->Assign(flags, withheld);
  this->EndModify(wasModifying);
}

void vtkMRMLFenestraRenderNode::WriteXML(ostream& of, int indent) {
  Superclass::WriteXML(of, indent);
  for (const auto* all : {&this->Flags, &this->Withheld})
    for (const auto& [name, value] : *all)
      of << ' ' << name << "=\"" << this->XMLAttributeEncodeString(value) << '"';
}

void vtkMRMLFenestraRenderNode::Copy(vtkMRMLNode* node) {
  const int wasModifying = this->StartModify();
  Superclass::Copy(node);
  if (auto* other = vtkMRMLFenestraRenderNode::SafeDownCast(node))
    this->CopyFlags(other);
  this->EndModify(wasModifying);
}

void vtkMRMLFenestraRenderNode::PrintSelf(ostream& os, vtkIndent indent) {
  Superclass::PrintSelf(os, indent);
  for (const auto& [name, value] : this->Flags)
    os << indent << name << ": " << value << '\n';
  for (const auto& [name, value] : this->Withheld)
    os << indent << "withheld " << name << ": " << value << '\n';
}
