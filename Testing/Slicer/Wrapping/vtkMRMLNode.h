#ifndef __vtkMRMLNode_h
#define __vtkMRMLNode_h
// Stand-in for Slicer's class, with as much of its interface as the module's node and the wrapper's
// output need.

#include <vtkObject.h>
#include <vtkObjectFactory.h>

#include <cstring>
#include <map>
#include <ostream>
#include <string>
#include <vector>

#define vtkMRMLNodeNewMacro(thisClass)                                                             \
  vtkStandardNewMacro(thisClass) vtkMRMLNode* thisClass::CreateNodeInstance() {                    \
    return thisClass::New();                                                                       \
  }
#define vtkMRMLCopyContentMacro(thisClass)                                                         \
  void CopyContent(vtkMRMLNode* node, bool deepCopy = true) override;                              \
  bool HasCopyContent() const override {                                                           \
    return strcmp(#thisClass, this->GetClassNameInternal()) == 0;                                  \
  }

class vtkMRMLNode : public vtkObject {
public:
  vtkTypeMacro(vtkMRMLNode, vtkObject);
  virtual vtkMRMLNode* CreateNodeInstance() = 0;
  virtual const char* GetNodeTagName() = 0;
  virtual bool HasCopyContent() const { return false; }
  virtual void CopyContent(vtkMRMLNode* node, bool = true) {
    if (node)
      this->Name = node->Name;
  }
  void Copy(vtkMRMLNode* node) { this->CopyContent(node); }
  virtual void ReadXMLAttributes(const char** atts) {
    for (; atts[0] && atts[1]; atts += 2)
      if (strcmp(atts[0], "name") == 0)
        this->Name = atts[1];
  }
  virtual void WriteXML(std::ostream& of, int) {
    of << " name=\"" << XMLAttributeEncodeString(this->Name) << '"';
  }
  const char* GetID() { return "vtkMRMLNode1"; }
  const char* GetName() { return this->Name.c_str(); }
  void SetName(const char* name) { this->Name = name ? name : ""; }
  const char* GetSingletonTag() { return nullptr; }
  void AddNodeReferenceRole(const char* role) { this->References[role ? role : ""] = ""; }
  const char* SetNodeReferenceID(const char* role, const char* id) {
    return (this->References[role ? role : ""] = id ? id : "").c_str();
  }
  const char* GetNodeReferenceID(const char* role) {
    return this->References[role ? role : ""].c_str();
  }
  vtkMRMLNode* GetNodeReference(const char*) { return nullptr; }
  int StartModify() { return 0; }
  void EndModify(int) {}

  /// For scripts: the output of WriteXML, and a reader of the list `name, value, name, value, ...`.
  std::string ToXml() {
    std::ostringstream text;
    this->WriteXML(text, 0);
    return text.str();
  }
  void ReadAttributes(const std::vector<std::string>& namesAndValues) {
    std::vector<const char*> atts;
    for (const std::string& text : namesAndValues)
      atts.push_back(text.c_str());
    atts.insert(atts.end(), 2, nullptr);
    this->ReadXMLAttributes(atts.data());
  }

protected:
  static std::string XMLAttributeEncodeString(const std::string& text) {
    std::string out;
    for (const char c : text)
      out += c == '"' ? "&quot;" : c == '&' ? "&amp;" : c == '<' ? "&lt;" : std::string(1, c);
    return out;
  }

  std::string Name;
  std::map<std::string, std::string> References;
};

#endif
