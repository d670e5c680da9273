#include "vtkMRMLFenestraRenderNode.h"

#include "FenestraFlags.h"

#include <vtkMRMLNodePropertyMacros.h>
#include <vtkObjectFactory.h>

#include <algorithm>
#include <set>
#include <sstream>

using SlicerExport::Verdict;

namespace {
std::vector<std::string> getNames(const std::map<std::string, std::string>& values) {
  std::vector<std::string> names;
  for (const auto& [name, value] : values)
    names.push_back(name);
  return names;
}

std::vector<std::string> getFlagNames(bool turntableOnly) {
  std::vector<std::string> names;
  for (const SlicerExport::Flag& flag : SlicerExport::flags())
    if (flag.turntableOnly || !turntableOnly)
      names.push_back(flag.name);
  return names;
}

/// Attributes of vtkMRMLNode.
const std::set<std::string> baseAttributes = {
    "attributes", "description", "hideFromEditors", "id",           "name",       "references",
    "selectable", "selected",    "saveWithScene",   "singletonTag", "undoEnabled"};
} // namespace

vtkMRMLNodeNewMacro(vtkMRMLFenestraRenderNode);

vtkMRMLFenestraRenderNode::vtkMRMLFenestraRenderNode() {
  for (const char* role : {VolumeRole, SegmentationRole, ViewRole, PlaneRole, PictureRole,
                           RadianceRole, DepthRole, SurfaceRole})
    this->AddNodeReferenceRole(role);
}

vtkMRMLFenestraRenderNode::~vtkMRMLFenestraRenderNode() = default;

const std::vector<std::string>& vtkMRMLFenestraRenderNode::GetFlagNames() {
  static const std::vector<std::string> names = getFlagNames(false);
  return names;
}

const std::vector<std::string>& vtkMRMLFenestraRenderNode::GetTurntableFlagNames() {
  static const std::vector<std::string> names = getFlagNames(true);
  return names;
}

bool vtkMRMLFenestraRenderNode::SetFlag(const std::string& name, const std::string& value) {
  const std::vector<std::string>& names = GetFlagNames();
  const bool isKnown = std::find(names.begin(), names.end(), name) != names.end();
  const bool isValid = value.empty() || SlicerExport::checkFlag(name, value) != Verdict::invalid;
  if (!isKnown || !isValid) {
    vtkErrorMacro("SetFlag: " << (isKnown ? "wrong value \"" + value + "\" of the option \""
                                          : std::string("there is no option \""))
                              << name << "\"");
    return false;
  }
  Values flags = this->Flags;
  flags[name] = value;
  this->SetFlags(flags);
  return true;
}

std::string vtkMRMLFenestraRenderNode::GetFlag(const std::string& name) const {
  const auto found = this->Flags.find(name);
  return found == this->Flags.end() ? std::string() : found->second;
}

void vtkMRMLFenestraRenderNode::SetFlags(const std::map<std::string, std::string>& flags) {
  std::map<std::string, std::string> valid, withheld = this->Withheld;
  for (const std::string& name : GetFlagNames()) {
    const auto found = flags.find(name);
    if (found == flags.end() || SlicerExport::checkFlag(name, found->second) == Verdict::invalid)
      continue;
    valid.insert(*found);
    withheld.erase(name);
  }
  this->Assign(valid, withheld, this->Unknown);
}

const std::map<std::string, std::string>& vtkMRMLFenestraRenderNode::GetFlags() const {
  return this->Flags;
}

const std::map<std::string, std::string>& vtkMRMLFenestraRenderNode::GetWithheld() const {
  return this->Withheld;
}

std::vector<std::string> vtkMRMLFenestraRenderNode::GetActiveFlagNames() const {
  return getNames(this->Flags);
}

std::vector<std::string> vtkMRMLFenestraRenderNode::GetWithheldFlagNames() const {
  return getNames(this->Withheld);
}

void vtkMRMLFenestraRenderNode::Assign(Values flags, Values withheld, Values unknown) {
  if (flags == this->Flags && withheld == this->Withheld && unknown == this->Unknown)
    return;
  this->Flags = std::move(flags);
  this->Withheld = std::move(withheld);
  this->Unknown = std::move(unknown);
  this->Modified();
}

bool vtkMRMLFenestraRenderNode::WithholdsFiles() const {
  return std::any_of(this->Withheld.begin(), this->Withheld.end(), [](const auto& one) {
    return SlicerExport::checkFlag(one.first, one.second) == Verdict::file;
  });
}

void vtkMRMLFenestraRenderNode::AllowFiles() {
  std::map<std::string, std::string> flags = this->Flags;
  for (const auto& [name, value] : this->Withheld)
    if (SlicerExport::checkFlag(name, value) == Verdict::file)
      flags[name] = value;
  this->SetFlags(flags);
}

/// Also copies what is withheld and unknown.
void vtkMRMLFenestraRenderNode::CopyFlags(vtkMRMLFenestraRenderNode* node) {
  if (node)
    this->Assign(node->Flags, node->Withheld, node->Unknown);
}

void vtkMRMLFenestraRenderNode::SetProgress(double fraction) {
  this->Progress = fraction;
  this->InvokeEvent(RenderProgressEvent);
}

void vtkMRMLFenestraRenderNode::EndRender(const std::string& problem) {
  this->RenderState = Ended;
  this->Problem = problem;
  this->InvokeEvent(RenderEndEvent);
}

void vtkMRMLFenestraRenderNode::SetFocus(const std::vector<std::string>& segments) {
  this->SetFlag("focus", SlicerExport::joinList(segments));
}

void vtkMRMLFenestraRenderNode::SetFocus(const char* segment) {
  const bool isEmpty = !segment || !*segment;
  this->SetFocus(isEmpty ? std::vector<std::string>() : std::vector<std::string>{segment});
}

std::vector<std::string> vtkMRMLFenestraRenderNode::GetFocus() const {
  return SlicerExport::splitList(this->GetFlag("focus"));
}

void vtkMRMLFenestraRenderNode::ReadXMLAttributes(const char** atts) {
  const int wasModifying = this->StartModify();
  Superclass::ReadXMLAttributes(atts);
  const std::vector<std::string>& names = GetFlagNames();
  Values flags, withheld, unknown;
  vtkMRMLReadXMLBeginMacro(atts);
  const std::string name = xmlReadAttName, value = xmlReadAttValue;
  if (std::find(names.begin(), names.end(), name) == names.end()) {
    if (baseAttributes.count(name) == 0)
      unknown[name] = value;
  } else if (!value.empty()) {
    (SlicerExport::checkFlag(name, value) == Verdict::valid ? flags : withheld)[name] = value;
  }
  vtkMRMLReadXMLEndMacro();
  this->Assign(flags, withheld, unknown);
  this->EndModify(wasModifying);
}

void vtkMRMLFenestraRenderNode::WriteXML(ostream& of, int indent) {
  std::ostringstream base;
  Superclass::WriteXML(base, indent);
  of << base.str();
  const auto write = [this, &of](const std::string& name, const std::string& value) {
    of << ' ' << name << "=\"" << this->XMLAttributeEncodeString(value) << '"';
  };
  for (const auto* all : {&this->Flags, &this->Withheld})
    for (const auto& [name, value] : *all)
      write(name, value);
  // The base class of a newer Slicer may know the attribute and have written it.
  for (const auto& [name, value] : this->Unknown)
    if (base.str().find(' ' + name + "=\"") == std::string::npos)
      write(name, value);
}

void vtkMRMLFenestraRenderNode::CopyContent(vtkMRMLNode* node, bool deepCopy) {
  const int wasModifying = this->StartModify();
  Superclass::CopyContent(node, deepCopy);
  this->CopyFlags(vtkMRMLFenestraRenderNode::SafeDownCast(node));
  this->EndModify(wasModifying);
}

void vtkMRMLFenestraRenderNode::PrintSelf(ostream& os, vtkIndent indent) {
  Superclass::PrintSelf(os, indent);
  vtkMRMLPrintBeginMacro(os, indent);
  vtkMRMLPrintIntMacro(RenderState);
  vtkMRMLPrintFloatMacro(Progress);
  vtkMRMLPrintStdStringMacro(Problem);
  vtkMRMLPrintEndMacro();
  for (const auto& [name, value] : this->Flags)
    os << indent << name << ": " << value << '\n';
  for (const auto& [name, value] : this->Withheld)
    os << indent << "withheld " << name << ": " << value << '\n';
}
