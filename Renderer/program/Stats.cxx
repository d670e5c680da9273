#include "program/Stats.h"

#include <nlohmann/json.hpp>

#include <sys/resource.h>

namespace fenestra {
namespace {

double seconds(const timeval& t) {
  return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
}

nlohmann::ordered_json jsonOf(const Distribution& values) {
  return {{"mean", values.mean}, {"p95", values.p95}, {"max", values.max}};
}

/// Adds the measures of the clip.
void addClip(nlohmann::ordered_json& json, const RenderStats& stats) {
  if (stats.mismatch)
    json["boundaryMismatchMm"] = jsonOf(*stats.mismatch);
  if (stats.boundary && stats.boundary->crossings > 0) {
    json["boundaryGapMm"] = jsonOf(stats.boundary->gap);
    json["boundarySlopeJump"] = jsonOf(stats.boundary->slopeJump);
    json["boundaryDepthJumps"] = stats.boundary->depthJumps;
  }
  for (const Vec2& point : stats.controlPoints)
    json["controlPoints"].push_back({point.x(), point.y()});
  if (!stats.focus)
    return;
  json["focusCoverage"] = stats.focus->coverage;
  json["focusKept"] = stats.focus->kept;
  json["focusCoverageUnclipped"] = stats.focus->withoutClip;
  if (stats.focus->light)
    json["focusLight"] = *stats.focus->light;
  if (stats.focus->contextRemoved)
    json["contextRemoved"] = *stats.focus->contextRemoved;
}

} // namespace

std::string statsJson(const RenderStats& stats, const RenderResult& result) {
  rusage usage = {};
  getrusage(RUSAGE_SELF, &usage);
  const SampleCounts samples = result.film.sampleCounts();
  const Counters& c = result.counters;
  const double noise = result.film.noise();

  nlohmann::ordered_json json;
  json["seconds"] = {{"load", stats.stages.load},   {"classify", stats.stages.classify},
                     {"focus", stats.stages.focus}, {"spline", stats.stages.spline},
                     {"fill", stats.stages.fill},   {"transport", stats.transport},
                     {"measure", stats.measure},    {"write", stats.write},
                     {"total", stats.total}};
  json["cpuSeconds"] = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  json["paths"] = c.paths;
  json["collisions"] = c.collisions;
  json["lookups"] = c.lookups;
  json["skippedFraction"] =
      c.cells > 0 ? static_cast<double>(c.skippedCells) / static_cast<double>(c.cells) : 0.0;
  json["shadowRays"] = c.shadowRays;
  json["gradients"] = c.gradients;
  json["cells"] = {{"all", stats.cells}, {"empty", stats.emptyCells}};
  json["emptyPixels"] = samples.certainPixels;
  json["samplesPerPixel"] = {
      {"min", samples.least}, {"mean", samples.mean}, {"max", samples.greatest}};
  json["noise"] = noise < infinity ? nlohmann::ordered_json(noise) : nullptr;
  json["peakBytes"] = static_cast<std::int64_t>(usage.ru_maxrss) * 1024;
  addClip(json, stats);
  if (stats.focusVoxels)
    json["focusVoxels"] = *stats.focusVoxels;
  if (stats.preset)
    json["preset"] = *stats.preset;
  json["filesRead"] = stats.files;
  json["warnings"] = stats.warnings;
  return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

} // namespace fenestra
