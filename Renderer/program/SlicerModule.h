#pragma once
// The renderer as a command line module of 3D Slicer: its flags in the terms of Slicer's execution
// model, from which Slicer builds a panel, and the values that a render returns to Slicer.

#include "program/Options.h"

#include <string>
#include <vector>

namespace fenestra {

/// Measured result of a render, a number; Slicer shows it under the panel.
struct ReturnValue {
  const char* name;
  const char* description;
};
inline constexpr ReturnValue returnValues[] = {
    {"samplesPerPixel", "Samples a pixel, the mean over the picture"},
    {"reachedNoise",
     "Relative noise of the picture, filtered if that is; empty below two samples a pixel"},
    {"renderSeconds", "Time of the rendering alone, by the clock"},
};

/// Module description, an XML document: the first positional argument as a volume, then every flag
/// but Slicer's own, in the table's order, then the return values. A flag without a default is a
/// text, which Slicer leaves out if empty.
std::string makeSlicerXml(const CommandSyntax& syntax);

/// Lines "name = value" in Slicer's form; values[i] belongs to returnValues[i].
std::string formatReturnValues(const std::vector<double>& values);

} // namespace fenestra
