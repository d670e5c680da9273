#include "Report.h"

#include "WriteResults.h"
#include "base/Error.h"

#include <algorithm>
#include <fstream>
#include <iomanip>
#include <sstream>

namespace fenestra::benchmarks {
namespace {

constexpr const char* csvHeader =
    "scene,mode,reference,reference_relmse,samples,seeds,cpu_seconds,relmse,relmse_spread,"
    "efficiency,bias_percent,bias_error_percent";
constexpr const char* absent = "not present";

std::string toCsv(const std::vector<CurveRecord>& curves) {
  std::ostringstream out;
  out << csvHeader << '\n' << std::setprecision(6);
  for (const CurveRecord& curve : curves) {
    if (curve.mode.empty())
      out << curve.scene << ',' << absent << ",,,,,,,,,,\n";
    for (const Point& p : curve.points)
      out << curve.scene << ',' << curve.mode << ',' << curve.reference << ','
          << curve.referenceRelMse << ',' << p.samples << ',' << p.seeds << ',' << p.cpuSeconds
          << ',' << p.relMse << ',' << p.spread << ',' << p.efficiency() << ',' << 100.0 * p.bias
          << ',' << 100.0 * p.biasError << '\n';
  }
  return out.str();
}

std::vector<std::string> splitCells(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');)
    cells.push_back(cell);
  return cells;
}

/// Adds a row, with cells in the order of csvHeader.
void addRow(const std::vector<std::string>& cells, std::vector<CurveRecord>& curves) {
  if (curves.empty() || curves.back().scene != cells[0] || curves.back().mode != cells[1])
    curves.push_back({cells[0], cells[1], cells[2], std::stod(cells[3])});
  Point point;
  point.samples = std::stoull(cells[4]);
  point.seeds = std::stoi(cells[5]);
  point.cpuSeconds = std::stod(cells[6]);
  point.relMse = std::stod(cells[7]);
  point.spread = std::stod(cells[8]);
  point.bias = std::stod(cells[10]) / 100.0;
  point.biasError = std::stod(cells[11]) / 100.0;
  curves.back().points.push_back(point);
}

const CurveRecord* find(const std::vector<CurveRecord>& curves, const std::string& scene,
                        const std::string& mode) {
  const auto found = std::ranges::find_if(
      curves, [&](const CurveRecord& c) { return c.scene == scene && c.mode == mode; });
  return found == curves.end() ? nullptr : &*found;
}

/// Names of the scenes, each once, in order of occurrence.
std::vector<std::string> listScenes(const std::vector<CurveRecord>& curves) {
  std::vector<std::string> scenes;
  for (const CurveRecord& curve : curves)
    if (scenes.empty() || scenes.back() != curve.scene)
      scenes.push_back(curve.scene);
  return scenes;
}

std::string toScientific(double x) {
  std::ostringstream out;
  out << std::setprecision(1) << std::scientific << x;
  return out.str();
}

std::string makeEfficiencyCell(const CurveRecord& curve) {
  const std::optional<Efficiency> efficiency = findEfficiency(curve.points, quotedRelMse);
  if (!efficiency)
    return "no measurable error";
  std::ostringstream out;
  out << std::setprecision(3) << efficiency->value;
  if (efficiency->relMse != quotedRelMse)
    out << " at " << toScientific(efficiency->relMse);
  return out.str();
}

/// Bias of the point with the most samples.
std::string makeBiasCell(const CurveRecord& curve) {
  const Point& point = curve.points.back();
  std::ostringstream out;
  out << std::fixed << std::setprecision(2) << std::showpos << 100.0 * point.bias << " ± "
      << std::noshowpos << 100.0 * point.biasError;
  return out.str();
}

/// Writes a table with a row per scene: the scene, `first` for one of its curves under the heading
/// `second`, then `cell` for each curve.
template <typename First, typename Cell>
void writeTable(std::ostream& out, const std::vector<CurveRecord>& curves, const char* second,
                First&& first, Cell&& cell) {
  out << "| scene | " << second << " |";
  for (const Mode& mode : modes())
    out << ' ' << mode.name << " |";
  out << "\n|---|---|";
  for (std::size_t i = 0; i < modes().size(); ++i)
    out << "---|";
  for (const std::string& scene : listScenes(curves)) {
    const auto any = std::ranges::find(curves, scene, &CurveRecord::scene);
    out << "\n| " << scene << " | " << (any->mode.empty() ? absent : first(*any)) << " |";
    for (const Mode& mode : modes()) {
      const CurveRecord* curve = find(curves, scene, mode.name);
      out << ' ' << (curve ? cell(*curve) : "–") << " |";
    }
  }
  out << "\n\n";
}

/// Efficiency of another renderer in the scenes with independent references, measured once on an
/// idle dual-core machine with two threads; empty: not measured.
struct Peer {
  const char *name, *s1, *s2, *s2hi;
};
constexpr Peer peers[] = {
    {"pbrt-v4, volumetric path tracer", "4.0", "4.5", ""},
    {"Cycles (Blender 3.4), step rate 1: biased", "3.1", "9.8", ""},
    {"simple scalar tracker: delta tracking, 32³ majorants", "29", "51", "14"},
};

void writePeers(std::ostream& out, const std::vector<CurveRecord>& curves) {
  out << "## Other renderers\n\nEfficiency with the same scenes, lights and cameras, 256 × 256 "
         "pixels and two threads. It was measured once on another dual-core machine, so only the "
         "order of magnitude is comparable. Cycles marches in steps of one voxel. pbrt terminates "
         "paths by absorption, intersects the volume's box as triangles after every collision, and "
         "renders spectrally.\n\n"
         "| renderer | S1 | S2 | S2hi |\n|---|---|---|---|\n| Fenestra (above) |";
  for (const char* scene : {"S1", "S2", "S2hi"}) {
    const CurveRecord* curve = find(curves, scene, "product"); // Fenestra
    out << ' ' << (curve ? makeEfficiencyCell(*curve) : "–") << " |";
  }
  for (const Peer& peer : peers) {
    out << "\n| " << peer.name << " |";
    for (const std::string cell : {peer.s1, peer.s2, peer.s2hi})
      out << ' ' << (cell.empty() ? "–" : cell) << " |";
  }
  out << "\n\n";
}

double largestSpread(const std::vector<CurveRecord>& curves) {
  double largest = 0.0;
  for (const CurveRecord& curve : curves)
    for (const Point& point : curve.points)
      largest = std::max(largest, point.spread / std::abs(point.relMse));
  return largest;
}

/// Records of other programs, next to this report.
constexpr const char* otherRecords =
    "## Other records\n\n| file | content | script |\n|---|---|---|\n"
    "| [denoiser.csv](denoiser.csv) | [gain, cost and error estimate of the "
    "denoiser](../README.md#denoiser) | `denoiser.sh` |\n"
    "| [appearance.csv](appearance.csv) | [lightness and color differences of "
    "images](../README.md#appearance) | `appearance.sh` |\n"
    "| [instructions.csv](instructions.csv) | [CPU instructions per "
    "path](../README.md#instructions-per-path) | `instructions.sh --record` |\n"
    "| [components.csv](components.csv) | [time of single components, on one "
    "thread](../README.md#components) | `run.sh` |\n"
    "| [changes.csv](changes.csv) | [time from a change to the first new "
    "sample](../README.md#changes) | `run.sh` |\n";

std::string makeReadme(const std::vector<CurveRecord>& curves, const std::string& notes) {
  std::ostringstream out;
  out << "# Error against time\n\nGenerated by `bash Testing/Benchmarks/run.sh`; see the "
         "[description "
         "of the method](../README.md#error-against-time). All points: [curves.csv](curves.csv)."
         "\n\n"
      << notes << "\n\n![relMSE over CPU seconds, one panel per scene](curves.svg)\n\n"
      << "## Efficiency\n\n1 / (relMSE × CPU seconds) of rendering, where the curve crosses relMSE "
      << toScientific(quotedRelMse) << " (interpolated in logarithms). Otherwise \"at\" gives the "
      << "relMSE of the nearest measured point.\n\n";
  writeTable(
      out, curves, "reference (its relMSE)",
      [](const CurveRecord& curve) {
        return curve.reference + " (" + toScientific(curve.referenceRelMse) + ")";
      },
      makeEfficiencyCell);
  writePeers(out, curves);
  out << "## Bias\n\nRelative bias of the image mean at the largest measured sample count, with "
         "one standard error, in percent.\n\n";
  writeTable(
      out, curves, "reference", [](const CurveRecord& curve) { return curve.reference; },
      makeBiasCell);
  out << "## Modes\n\n";
  for (const Mode& mode : modes())
    out << "- `" << mode.name << "`: " << mode.description << '\n';
  out << "\nThe standard deviation of relMSE over the seeds of a point is at most "
      << std::setprecision(2) << 100.0 * largestSpread(curves) << " % of relMSE.\n\n"
      << otherRecords;
  return out.str();
}

} // namespace

std::vector<CurveRecord> readCurves(const std::filesystem::path& folder) {
  const std::filesystem::path path = folder / "curves.csv";
  std::vector<CurveRecord> curves;
  std::ifstream file(path);
  std::string line;
  if (!file || !std::getline(file, line))
    return curves;
  const std::size_t columns = splitCells(csvHeader).size();
  if (line != csvHeader)
    throw inputError(path.string(), "has unexpected columns; move it away, or change --output");
  while (std::getline(file, line)) {
    const std::vector<std::string> cells = splitCells(line);
    if (cells.size() > 1 && cells[1] == absent)
      curves.push_back({cells[0], "", "", 0.0});
    else if (cells.size() == columns)
      addRow(cells, curves);
    else
      throw inputError(path.string(), "'" + line + "': truncated row; move the file away");
  }
  return curves;
}

std::vector<CurveRecord> mergeCurves(const std::vector<CurveRecord>& previous,
                                     const std::vector<CurveRecord>& measured,
                                     const std::vector<std::string>& scenes) {
  std::vector<CurveRecord> result;
  for (const std::string& scene : scenes) {
    const std::size_t before = result.size();
    for (const Mode& mode : modes()) {
      const CurveRecord* curve = find(measured, scene, mode.name);
      curve = curve ? curve : find(previous, scene, mode.name);
      if (curve)
        result.push_back(*curve);
    }
    const CurveRecord* missing = find(measured, scene, "");
    missing = missing ? missing : find(previous, scene, "");
    if (missing && result.size() == before)
      result.push_back(*missing);
  }
  return result;
}

void writeReport(const std::filesystem::path& folder, const std::vector<CurveRecord>& curves,
                 const std::string& notes) {
  std::filesystem::create_directories(folder);
  writeFile(folder / "curves.csv", toCsv(curves));
  writeFile(folder / "curves.svg", drawCurves(curves));
  writeFile(folder / "README.md", makeReadme(curves, notes));
}

} // namespace fenestra::benchmarks
