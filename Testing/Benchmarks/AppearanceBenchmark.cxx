// Renders a command line of `fenestra`, and measures the appearance of the image (see README.md in
// this folder). Prints CSV.

#include "AppearanceMeasures.h"
#include "Program.h"
#include "Scenes.h"
#include "VisibleTissue.h"

#include "denoise/features/Denoising.h"
#include "files/images/ImageWriter.h"
#include "io/Outputs.h"
#include "program/CommandLine.h"
#include "program/RenderOptions.h"
#include "program/UsageError.h"
#include "scene/Defaults.h"
#include "scene/FilmImage.h"

#include <iomanip>
#include <iostream>

namespace fenestra::core::benchmarks {
namespace {

constexpr const char* group = "Benchmark";
const Option optionTable[] = {
    {"name", "NAME", group, "First column of the table [scene]"},
    {"bounds", "A1,A2,...", group, "Measures whose bounds apply [all but contrast]"},
    {"image", "FILE", group, "Image to write, a .png"},
    {"header", "", group, "Print the names of the columns first"},
};

const CommandSyntax syntax = {"AppearanceBenchmark",
                              "Measures image appearance.",
                              {{"ARGUMENT", "-- and the arguments of fenestra", {}, true}},
                              optionTable};

/// Range of a passing value.
struct Bound {
  double least = -infinity, greatest = infinity;
};

/// A group of measures by its number in README.md, one of its measures, and the bound of that.
struct Measure {
  std::string group, name;
  std::optional<double> value;
  Bound bound;
};

class Table {
public:
  Table(std::string scene, std::vector<std::string> bounds)
      : m_scene(std::move(scene)), m_bounds(std::move(bounds)) {}

  /// A measure without a value is reported as missing if its bound applies.
  void print(const Measure& measure) const {
    const bool isBounded =
        (measure.bound.least > -infinity || measure.bound.greatest < infinity) &&
        (m_bounds.empty() ? measure.group != "contrast"
                          : std::ranges::find(m_bounds, measure.group) != m_bounds.end());
    if (!measure.value && !(isBounded && !m_bounds.empty()))
      return;
    std::cout << m_scene << ',' << measure.group << ',' << measure.name << ',';
    if (measure.value)
      std::cout << std::setprecision(3) << *measure.value;
    std::cout << ',';
    if (isBounded && measure.bound.least > -infinity)
      std::cout << measure.bound.least;
    std::cout << ',';
    if (isBounded && measure.bound.greatest < infinity)
      std::cout << measure.bound.greatest;
    const bool passes = measure.value && *measure.value >= measure.bound.least &&
                        *measure.value <= measure.bound.greatest;
    std::cout << ','
              << (!isBounded       ? ""
                  : !measure.value ? "missing"
                  : passes         ? "pass"
                                   : "FAIL")
              << std::endl;
  }

private:
  std::string m_scene;
  std::vector<std::string> m_bounds;
};

/// The image that `fenestra` writes to a .png.
struct Rendered {
  Raster<Rgb> display;
  Raster<double> depth; ///< mm, mean over the samples of the first collision; else infinity
};

Rendered renderDisplay(const PreparedScene& scene, const RenderOptions& options,
                       const std::optional<std::string>& path) {
  RenderMonitor monitor;
  const Film film = render(scene.view(), makeSettings(options, scene.background()), monitor).film;
  const Image image = makeFilteredImage(denoise(film, scene.view(), *scene.features()),
                                        film.width(), film.height());
  if (path) {
    Outputs outputs;
    declareImage(*path, outputs);
    writeImage(image, makeImagePlane(scene.camera()), *path, outputs, options.display);
    outputs.commit();
  }
  std::vector<float> rgba;
  for (std::size_t i = 0; i < image.find("A")->size(); ++i)
    for (const char* channel : {"R", "G", "B", "A"})
      rgba.push_back((*image.find(channel))[i]);
  rgba = toDisplay(rgba, options.display);
  Rendered rendered{{film.width(), film.height()}, {film.width(), film.height()}};
  for (std::size_t i = 0; i < rendered.display.values.size(); ++i) {
    const float* const pixel = &rgba[4 * i];
    rendered.display.values[i] = Rgb(double{pixel[0]}, double{pixel[1]}, double{pixel[2]});
  }
  const Image raw = makeImage(film, scene.camera(), scene.clip(), {"depth"});
  std::ranges::copy(*raw.find("Z"), rendered.depth.values.begin());
  return rendered;
}

/// Pixels whose camera rays hit the focus, and, if `depth` is given, something there.
PixelMask findFocus(const PreparedScene& scene, const Raster<double>* depth = nullptr) {
  PixelMask focus(scene.camera().width(), scene.camera().height());
  const std::vector<double>& focusDepth = scene.clipResult().focusDepth;
  for (std::size_t i = 0; i < focusDepth.size(); ++i)
    focus.values[i] = focusDepth[i] < infinity && (!depth || depth->values[i] < infinity) ? 1 : 0;
  return focus;
}

template <typename Value, typename Part>
std::optional<double> part(const std::optional<Value>& value, Part Value::*member) {
  return value ? std::optional<double>((*value).*member) : std::nullopt;
}

std::optional<double> percent(const std::optional<double>& fraction) {
  return fraction ? std::optional(100.0 * *fraction) : std::nullopt;
}

void measureTissues(const Table& table, const PreparedScene& scene, const Input& input,
                    const RenderRequest& request, const Raster<Lab>& image,
                    const VisibleSurface& surface, const PixelMask& focus) {
  SegmentsHandle segments;
  if (scene.focus())
    segments = input.segments({request.volume.name, request.segmentation, request.labels},
                              scene.volume().grid);
  const TissueRegions regions =
      findTissueRegions(scene, surface, focus, segments ? &segments->segmentation : nullptr);
  const double pitch = scene.camera().pixelPitch();
  table.print({"A2", "muscle", measureMottle(image, regions.muscle, pitch), {.greatest = 1.5}});
  table.print({"A2", "heart", measureMottle(image, regions.heart, pitch), {.greatest = 1.5}});
  table.print({"A2", "focus", measureMottle(image, regions.focus, pitch), {.greatest = 2.0}});
}

void measureFocus(const Table& table, const PreparedScene& scene, const Rendered& rendered,
                  const Raster<Lab>& image, const VisibleSurface& surface) {
  const double pitch = scene.camera().pixelPitch();
  const PixelMask focus = findFocus(scene);
  const auto stairs = measureStairs(rendered.depth, findFocus(scene, &rendered.depth), pitch);
  table.print({"A1", "stairs rms deg", part(stairs, &AngleSpread::rms), {.greatest = 8.0}});
  table.print({"A1", "stairs p95 deg", part(stairs, &AngleSpread::p95), {.greatest = 14.0}});
  const auto noiseFree = measureStairs(surface.depth, findFocus(scene, &surface.depth), pitch);
  table.print({"A1", "without noise rms", part(noiseFree, &AngleSpread::rms), {}});
  table.print({"A6", "highlights %", percent(measureHighlights(image, focus, pitch)), {1.0, 4.0}});
  table.print({"A7", "dark edge %", percent(measureDarkEdge(image, focus)), {.greatest = 1.0}});
  const auto contrast = measureContrast(rendered.display, focus, surface.covered);
  table.print({"contrast", "Delta E", part(contrast, &EdgeContrast::deltaE), {.least = 20.0}});
  table.print(
      {"contrast", "Delta E protan", part(contrast, &EdgeContrast::deltaEProtan), {.least = 12.0}});
  table.print(
      {"contrast", "Delta E deutan", part(contrast, &EdgeContrast::deltaEDeutan), {.least = 12.0}});
  table.print(
      {"contrast", "Delta L*", part(contrast, &EdgeContrast::deltaLightness), {.least = 8.0}});
  if (contrast)
    for (const auto& [side, color] :
         {std::pair("focus", contrast->focus), {"context", contrast->context}}) {
      table.print({"contrast", std::string(side) + " L*", color.L, {}});
      table.print({"contrast", std::string(side) + " a*", color.a, {}});
      table.print({"contrast", std::string(side) + " b*", color.b, {}});
    }
}

void measureImage(const Table& table, const RenderOptions& options,
                  const std::optional<std::string>& path) {
  RenderRequest request = options.scene;
  request.features = request.measure = true;
  const Input input(request.input);
  const PreparedScene scene(request, input);
  for (const std::string& choice : scene.choices())
    std::cerr << choice << std::endl;
  const Rendered rendered = renderDisplay(scene, options, path);
  const Raster<Lab> image = toLabRaster(rendered.display);
  const VisibleSurface surface(scene);
  const Tone tone = measureTone(image, surface.covered);
  table.print({"A5", "L* p5", tone.dark, {}});
  table.print({"A5", "L* median", tone.median, {}});
  table.print({"A5", "L* p95", tone.light, {}});
  table.print({"A5", "L* p95 - p5", tone.light - tone.dark, {.least = 45.0}});
  table.print({"A5", "C* median", tone.chroma, {18.0, 32.0}});
  table.print({"A5", "C* p95", tone.chroma95, {.greatest = 42.0}});
  if (scene.focus())
    measureFocus(table, scene, rendered, image, surface);
  if (!isPlausibleModality(Modality::ct, scene.volume()))
    return;
  measureTissues(table, scene, input, request, image, surface, findFocus(scene));
  if (scene.focus())
    table.print({"A8",
                 "foreign surface %",
                 percent(measureForeignSurface(scene.volume(), *scene.focus())),
                 {.greatest = 2.0}});
}

int benchmark(int argc, char** argv) {
  const std::optional<OptionValues> values = parseCommandLine(syntax, argc, argv, 1);
  if (!values)
    return 0;
  if (values->has("header"))
    std::cout << "scene,measure,part,value,least,greatest,result" << std::endl;
  measureImage(Table(values->text("name").value_or("scene"), values->list("bounds")),
               parseRenderOptions(values->texts("ARGUMENT")), values->text("image"));
  return 0;
}

} // namespace
} // namespace fenestra::core::benchmarks

int main(int argc, char** argv) {
  using namespace fenestra::core::benchmarks;
  return runBenchmark("AppearanceBenchmark", benchmark, argc, argv);
}
