#include "vtkMRMLFenestraRenderNode.h"

#include <vtkObjectFactory.h>

#include <algorithm>

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
  static const std::vector<std::string> names = {
      "focus",      "preset",   "margin",         "labelsmoothing",
      "clip",       "boundary", "controlpoints",  "smoothing",
      "plane",      "hole",     "holemargin",     "ghost",
      "offset",     "soft",     "contextdensity", "contextsaturation",
      "view",       "position", "target",         "up",
      "projection", "scale",    "angle",          "transfer",
      "shift",      "density",  "lights",         "environment",
      "background", "size",     "samples",        "seconds",
      "noise",      "bounces",  "seed",           "frames",
      "degrees",    "steady"};
  return names;
}

const std::vector<std::string>& vtkMRMLFenestraRenderNode::GetTurntableFlagNames() {
  static const std::vector<std::string> names = {"frames", "degrees", "steady"};
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
  std::map<std::string, std::string> kept;
  for (const std::string& name : GetFlagNames()) {
    const auto found = flags.find(name);
    if (found != flags.end() && !found->second.empty())
      kept.insert(*found);
  }
  if (kept == this->Flags)
    return;
  this->Flags = kept;
  this->Modified();
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
  std::map<std::string, std::string> flags;
  for (; atts[0] && atts[1]; atts += 2)
    flags[atts[0]] = atts[1];
  this->SetFlags(flags);
  this->EndModify(wasModifying);
}

void vtkMRMLFenestraRenderNode::WriteXML(ostream& of, int indent) {
  Superclass::WriteXML(of, indent);
  for (const auto& [name, value] : this->Flags)
    of << ' ' << name << "=\"" << this->XMLAttributeEncodeString(value) << '"';
}

void vtkMRMLFenestraRenderNode::Copy(vtkMRMLNode* node) {
  const int wasModifying = this->StartModify();
  Superclass::Copy(node);
  if (auto* other = vtkMRMLFenestraRenderNode::SafeDownCast(node))
    this->SetFlags(other->Flags);
  this->EndModify(wasModifying);
}

void vtkMRMLFenestraRenderNode::PrintSelf(ostream& os, vtkIndent indent) {
  Superclass::PrintSelf(os, indent);
  for (const auto& [name, value] : this->Flags)
    os << indent << name << ": " << value << '\n';
}
