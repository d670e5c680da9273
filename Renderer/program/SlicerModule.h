#pragma once
// The renderer as a command-line module of 3D Slicer: its options in the XML of Slicer's execution
// model, from which Slicer builds a panel, and the values that a render returns to Slicer.

#include "program/Options.h"

#include <string>
#include <vector>

namespace fenestra::core {

/// A number that a render measured; Slicer shows it below the panel.
struct ReturnValue {
  const char* name;
  const char* description;
};
inline constexpr ReturnValue returnValues[] = {
    {"samplesPerPixel", "Samples per pixel, mean over the image"},
    {"reachedNoise",
     "Relative noise of the image, after denoising if applied; empty below two samples per pixel"},
    {"renderSeconds", "Rendering time alone, wall clock"},
};

/// XML module description: the first positional argument as a volume, all options but Slicer's own
/// in table order, and the return values. A number or enumeration without a default becomes a text,
/// since Slicer always passes the former but omits an empty text.
std::string makeSlicerXml(const CommandSyntax& syntax);

/// Lines "name = value", as Slicer expects; values[i] belongs to returnValues[i].
std::string formatReturnValues(const std::vector<double>& values);

} // namespace fenestra::core
