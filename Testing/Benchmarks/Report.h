#pragma once
// What a run leaves behind: every point as CSV, curves as a picture, efficiencies as a table.

#include "Curve.h"

#include <filesystem>
#include <string>
#include <vector>

namespace fenestra::benchmarks {

/// A mode's curve of a scene. A scene that is not present has one curve without mode and points.
struct CurveRecord {
  std::string scene, mode;
  std::string reference;        ///< who made it
  double referenceRelMse = 0.0; ///< its own
  std::vector<Point> points = {};
};

/// curves.csv of a folder, nothing where there is none. Throws Error (input) for another file.
std::vector<CurveRecord> readCurves(const std::filesystem::path& folder);

/// `kept` with what is `measured` in the place of what was known of the same scene and mode; in the
/// order of the scenes' names and of modes().
std::vector<CurveRecord> merged(const std::vector<CurveRecord>& kept,
                                const std::vector<CurveRecord>& measured,
                                const std::vector<std::string>& scenes);

/// curves.csv, curves.svg and README.md. `machine` and what else a reader has to know of the run is
/// in `notes`, a paragraph. Throws Error (output).
void writeReport(const std::filesystem::path& folder, const std::vector<CurveRecord>& curves,
                 const std::string& notes);

/// curves.svg: a log-log panel a scene, relMSE over CPU seconds.
std::string drawCurves(const std::vector<CurveRecord>& curves);

/// The relMSE at which efficiency is quoted.
inline constexpr double quotedRelMse = 1e-3;

} // namespace fenestra::benchmarks
