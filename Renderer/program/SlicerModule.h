#pragma once
// The renderer as a command line module of 3D Slicer: the flags in the words of Slicer's execution
// model, from which Slicer makes a panel, and the values that a render hands back to it.

#include "program/Flags.h"

#include <string>
#include <vector>

namespace fenestra {

/// What a render reached; Slicer shows it under the panel.
struct ReturnValue {
  const char* name;
  const char* type; ///< Slicer's
  const char* text;
};
inline constexpr ReturnValue returnValues[] = {
    {"samplesPerPixel", "double", "Samples a pixel, the mean over the picture"},
    {"reachedNoise", "double", "Relative noise of the picture; empty below two samples a pixel"},
    {"renderSeconds", "double", "Time of the rendering alone, by the clock"},
};

/// The module description, an XML document: the first positional argument as a volume, then every
/// flag but Slicer's own, in the order of the table, and the return values. A flag without a
/// standard value is a text, which Slicer leaves out where it is empty.
std::string slicerDescription(const CommandSyntax& syntax);

/// One of `values` for each of returnValues, in Slicer's form: "name = value", a line each.
std::string returnValuesText(const std::vector<double>& values);

} // namespace fenestra
