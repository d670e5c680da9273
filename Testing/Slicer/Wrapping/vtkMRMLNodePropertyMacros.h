#pragma once
// Stand-in for the macros of Slicer's header that the module's node uses.

#define vtkMRMLReadXMLBeginMacro(atts)                                                             \
  for (const char** xmlReadAtts = atts; *xmlReadAtts; xmlReadAtts += 2) {                          \
    const char *xmlReadAttName = xmlReadAtts[0], *xmlReadAttValue = xmlReadAtts[1];
#define vtkMRMLReadXMLEndMacro() }
#define vtkMRMLPrintBeginMacro(os, indent)                                                         \
  {                                                                                                \
    ostream& printOutputStream = os;                                                               \
    vtkIndent printOutputIndent = indent;
#define vtkMRMLPrintIntMacro(name)                                                                 \
  printOutputStream << printOutputIndent << #name ": " << this->Get##name() << "\n";
#define vtkMRMLPrintFloatMacro(name) vtkMRMLPrintIntMacro(name)
#define vtkMRMLPrintStdStringMacro(name) vtkMRMLPrintIntMacro(name)
#define vtkMRMLPrintEndMacro() }
