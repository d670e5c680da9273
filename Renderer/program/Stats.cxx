#include "program/Stats.h"

#include "base/safe/JsonNode.h"
#include "program/FileNames.h"

#include <sys/resource.h>

namespace fenestra {
namespace {

using Json = nlohmann::ordered_json;

double seconds(const timeval& t) {
  return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
}

Json jsonOf(const Distribution& values) {
  return {{"mean", values.mean}, {"p95", values.p95}, {"max", values.max}};
}

/// Adds the measures of the clip.
void addClip(Json& json, const Scene& scene, const std::optional<FocusReport>& focus) {
  const ClipResult& clip = scene.clipResult();
  if (clip.mismatch)
    json["boundaryMismatchMm"] = jsonOf(*clip.mismatch);
  if (const auto& boundary = clip.boundary; boundary && boundary->crossings > 0) {
    json["boundaryGapMm"] = jsonOf(boundary->gap);
    json["boundarySlopeJump"] = jsonOf(boundary->slopeJump);
    json["boundaryDepthJumps"] = boundary->depthJumps;
  }
  for (const ControlPoint& point : clip.controlPoints) {
    const Vec2 raster = scene.camera().toRaster(point.site);
    json["controlPoints"].push_back({raster.x(), raster.y()});
  }
  if (!focus)
    return;
  json["focusCoverage"] = focus->coverage;
  json["focusKept"] = focus->kept;
  json["focusCoverageUnclipped"] = focus->withoutClip;
  if (focus->light)
    json["focusLight"] = *focus->light;
  if (focus->contextRemoved)
    json["contextRemoved"] = *focus->contextRemoved;
}

/// Adds the sources of the picture, and the warnings.
void addSources(Json& json, const RenderStats& stats, const RenderOptions& options,
                const Scene& scene) {
  const std::filesystem::path folder = options.stats->parent_path();
  if (options.preset)
    json["preset"] = relativeName(*options.preset, folder);
  json["filesRead"] = Json::array();
  for (const std::string& file : scene.files())
    json["filesRead"].push_back(relativeName(file, folder));
  json["warnings"] = scene.warnings();
  for (const std::string& warning : stats.warnings)
    json["warnings"].push_back(warning);
}

} // namespace

std::string statsJson(const RenderStats& stats, const RenderOptions& options, const Scene& scene,
                      const RenderResult& result) {
  rusage usage = {};
  getrusage(RUSAGE_SELF, &usage);
  const SampleCounts samples = result.film.sampleCounts();
  const Counters& c = result.counters;
  const StageSeconds& stages = scene.seconds();
  const MajorantGrid& majorants = scene.forRender().majorants;

  Json json;
  json["seconds"] = {
      {"load", stages.load},      {"classify", stages.classify}, {"focus", stages.focus},
      {"spline", stages.spline},  {"fill", stages.fill},         {"transport", stats.transport},
      {"measure", stats.measure}, {"write", stats.write},        {"total", stats.total}};
  json["cpuSeconds"] = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  json["paths"] = c.paths;
  json["collisions"] = c.collisions;
  json["lookups"] = c.lookups;
  json["skippedFraction"] =
      c.cells > 0 ? static_cast<double>(c.skippedCells) / static_cast<double>(c.cells) : 0.0;
  json["shadowRays"] = c.shadowRays;
  json["gradients"] = c.gradients;
  json["cells"] = {{"all", majorants.size()}, {"empty", majorants.emptyCount()}};
  json["emptyPixels"] = samples.certainPixels;
  json["samplesPerPixel"] = {
      {"min", samples.least}, {"mean", samples.mean}, {"max", samples.greatest}};
  json["noise"] = result.film.noise(); // null: infinite
  json["peakBytes"] = static_cast<std::int64_t>(usage.ru_maxrss) * 1024;
  addClip(json, scene, stats.focus);
  if (scene.focus())
    json["focusVoxels"] = scene.focus()->grid.voxelCount();
  addSources(json, stats, options, scene);
  return jsonText(json);
}

} // namespace fenestra
