#pragma once
// Stand-in for the macros of Slicer's header that the module's node uses.

#define vtkMRMLReadXMLBeginMacro(atts)                                                             \
  for (const char** xmlReadAtts = atts; *xmlReadAtts; xmlReadAtts += 2) {                          \
    const char *xmlReadAttName = xmlReadAtts[0], *xmlReadAttValue = xmlReadAtts[1];
#define vtkMRMLReadXMLBooleanMacro(attribute, name)                                                \
  if (std::string(xmlReadAttName) == #attribute)                                                   \
    this->Set##name(std::string(xmlReadAttValue) == "true");
#define vtkMRMLReadXMLEndMacro() }
#define vtkMRMLWriteXMLBeginMacro(of)                                                              \
  {                                                                                                \
    ostream& xmlWriteOutputStream = of;
#define vtkMRMLWriteXMLBooleanMacro(attribute, name)                                               \
  xmlWriteOutputStream << " " #attribute "=\"" << (this->Get##name() ? "true" : "false") << "\"";
#define vtkMRMLWriteXMLEndMacro() }
#define vtkMRMLPrintBeginMacro(os, indent)                                                         \
  {                                                                                                \
    ostream& printOutputStream = os;                                                               \
    vtkIndent printOutputIndent = indent;
#define vtkMRMLPrintIntMacro(name)                                                                 \
  printOutputStream << printOutputIndent << #name ": " << this->Get##name() << "\n";
#define vtkMRMLPrintBooleanMacro(name) vtkMRMLPrintIntMacro(name)
#define vtkMRMLPrintFloatMacro(name) vtkMRMLPrintIntMacro(name)
#define vtkMRMLPrintStdStringMacro(name) vtkMRMLPrintIntMacro(name)
#define vtkMRMLPrintEndMacro() }
