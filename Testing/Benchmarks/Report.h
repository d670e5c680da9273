#pragma once
// Report of a run: all points as CSV, curves as SVG, efficiencies and biases as Markdown tables.

#include "Curve.h"

#include <filesystem>
#include <string>
#include <vector>

namespace fenestra::benchmarks {

/// Curve of a mode in a scene. A missing scene has one record without a mode and points.
struct CurveRecord {
  std::string scene, mode;
  std::string reference;        ///< source of the reference
  double referenceRelMse = 0.0; ///< of the reference itself
  std::vector<Point> points = {};
};

/// Reads curves.csv from a folder; empty if the file is missing. Throws Error (input) for an
/// invalid file.
std::vector<CurveRecord> readCurves(const std::filesystem::path& folder);

/// Returns `previous`, in which records with the same scene and mode are replaced by those of
/// `measured`. Sorted by `scenes`, then modes().
std::vector<CurveRecord> mergeCurves(const std::vector<CurveRecord>& previous,
                                     const std::vector<CurveRecord>& measured,
                                     const std::vector<std::string>& scenes);

/// Writes curves.csv, curves.svg and README.md. `notes`: a paragraph about the machine and the run.
/// Throws Error (output).
void writeReport(const std::filesystem::path& folder, const std::vector<CurveRecord>& curves,
                 const std::string& notes);

/// SVG with one log-log panel per scene: relMSE over CPU seconds.
std::string drawCurves(const std::vector<CurveRecord>& curves);

/// relMSE at which efficiency is quoted.
inline constexpr double quotedRelMse = 1e-3;

} // namespace fenestra::benchmarks
