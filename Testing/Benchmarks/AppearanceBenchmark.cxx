// Measures the appearance of images over the scenes of a table (see README.md in this folder): the
// spread of lightness if there is no focus, else the color difference across the focus edge. Prints
// CSV.

#include "Program.h"
#include "References.h"
#include "base/Color.h"
#include "denoise/features/Denoising.h"
#include "files/images/DisplayTransform.h"
#include "image/ColorVision.h"
#include "program/CommandLine.h"
#include "scene/FilmImage.h"
#include "scene/PreparedScene.h"

#include <algorithm>
#include <iomanip>
#include <iostream>

namespace fenestra::benchmarks {
namespace {

constexpr const char* group = "Benchmark";
const Option optionTable[] = {
    {"scenes", "A,B,...", group, "Scenes of the table [all]"},
    {"phantoms", "DIR", group, "Folder of the phantoms [benchmarks of the build]"},
    {"table", "FILE", group, "Table of scenes [appearance-scenes.txt of the source tree]"},
};

const CommandSyntax syntax = {"AppearanceBenchmark", "Measures image appearance.", {}, optionTable};

/// Denoised display image with a transparent background: R G B A per pixel.
std::vector<float> renderDisplay(const PreparedScene& scene, RenderSettings settings) {
  settings.path.background.kind = Background::Kind::transparent;
  RenderMonitor monitor;
  const Film film = render(scene.view(), settings, monitor).film;
  const Image image = makeFilteredImage(denoise(film, scene.view(), *scene.features()),
                                        film.width(), film.height());
  std::vector<float> rgba;
  for (std::size_t i = 0; i < image.find("A")->size(); ++i)
    for (const char* channel : {"R", "G", "B", "A"})
      rgba.push_back((*image.find(channel))[i]);
  return toDisplay(rgba, {});
}

/// Mean of display-encoded colors.
struct MeanColor {
  Rgb sum = Rgb::Zero();
  double count = 0.0;

  void add(const float* rgba) {
    sum += Rgb(double{rgba[0]}, double{rgba[1]}, double{rgba[2]});
    count += 1.0;
  }
  Rgb linear() const { return decodeSrgb(sum / std::max(count, 1.0)); }
};

bool isOpaque(const float* rgba) {
  return rgba[3] > 0.99F;
}

void printSpread(const std::vector<float>& rgba) {
  double sum = 0.0, squares = 0.0, count = 0.0;
  MeanColor mean;
  for (std::size_t i = 0; i < rgba.size(); i += 4) {
    if (!isOpaque(&rgba[i]))
      continue;
    MeanColor one;
    one.add(&rgba[i]);
    mean.add(&rgba[i]);
    const double lightness = toLab(one.linear()).L;
    sum += lightness;
    squares += lightness * lightness;
    count += 1.0;
  }
  const Rgb color = 255.0 * mean.sum / count;
  std::cout << sum / count << ',' << std::sqrt(squares / count - sum / count * sum / count) << ','
            << std::lround(color[0]) << ',' << std::lround(color[1]) << ',' << std::lround(color[2])
            << ",,,,,," << std::endl;
}

/// Distance, in pixels, of a pixel to the nearest one on the other side of the focus edge.
class EdgeDistance {
public:
  EdgeDistance(const std::vector<double>& focusDepth, int width, int height)
      : m_depth(focusDepth), m_width(width), m_height(height) {}

  bool isFocus(int column, int row) const {
    return m_depth[static_cast<std::size_t>(row) * static_cast<std::size_t>(m_width) +
                   static_cast<std::size_t>(column)] < infinity;
  }
  /// Infinity beyond `farthest`.
  double at(int column, int row, int farthest) const {
    double nearest = infinity;
    for (int y = std::max(0, row - farthest); y <= std::min(m_height - 1, row + farthest); ++y)
      for (int x = std::max(0, column - farthest); x <= std::min(m_width - 1, column + farthest);
           ++x)
        if (isFocus(x, y) != isFocus(column, row))
          nearest = std::min(nearest, std::hypot(x - column, y - row));
    return nearest <= farthest ? nearest : infinity;
  }

private:
  const std::vector<double>& m_depth;
  int m_width, m_height;
};

/// Prints the differences between the mean colors 3 to 8 pixels inside and outside the focus edge.
void printContrast(const PreparedScene& scene, const std::vector<float>& rgba) {
  constexpr int nearest = 3, farthest = 8;
  const Camera& camera = scene.camera();
  const EdgeDistance edge(scene.clipResult().focusDepth, camera.width(), camera.height());
  MeanColor inside, outside;
  for (int row = 0; row < camera.height(); ++row)
    for (int column = 0; column < camera.width(); ++column) {
      const float* const pixel =
          &rgba[4 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(camera.width()) +
                     static_cast<std::size_t>(column))];
      const double distance = edge.at(column, row, farthest);
      if (isOpaque(pixel) && distance >= nearest && distance <= farthest)
        (edge.isFocus(column, row) ? inside : outside).add(pixel);
    }
  const auto toSimulatedLab = [&](const MeanColor& color, ColorVision vision) {
    return toLab(simulateVision(vision, color.linear()));
  };
  std::cout << ",,,,,";
  for (const ColorVision vision : {ColorVision::normal, ColorVision::protan, ColorVision::deutan})
    std::cout << deltaE76(toSimulatedLab(inside, vision), toSimulatedLab(outside, vision)) << ',';
  std::cout << std::abs(toLab(inside.linear()).L - toLab(outside.linear()).L) << ",\"";
  if (const TintContrast* tint = scene.tintContrast())
    std::cout << summary(*tint);
  else
    std::cout << summary(scene.contrast());
  std::cout << '"' << std::endl;
}

void measureScene(const SceneCase& sceneCase) {
  if (!sceneCase.missing.empty()) {
    std::cerr << sceneCase.name << ": not present: " << sceneCase.missing << std::endl;
    return;
  }
  RenderOptions options = sceneCase.options();
  options.scene.features = options.scene.measure = true;
  const PreparedScene scene(options.scene);
  const std::vector<float> rgba = renderDisplay(scene, makeSettings(options, scene.background()));
  std::cout << std::setprecision(3) << sceneCase.name << ',';
  if (scene.focus())
    printContrast(scene, rgba);
  else
    printSpread(rgba);
}

int benchmark(int argc, char** argv) {
  const std::optional<OptionValues> values = parseCommandLine(syntax, argc, argv, 1);
  if (!values)
    return 0;
  const std::vector<std::string> scenes = values->list("scenes");
  std::cout << "scene,lightness_mean,lightness_spread,mean_red,mean_green,mean_blue,delta_e,"
               "delta_e_protan,delta_e_deutan,delta_lightness,predicted"
            << std::endl;
  for (const SceneCase& scene :
       readScenes(values->text("table").value_or(FENESTRA_APPEARANCE_TABLE),
                  findFolders(values->text("phantoms"))))
    if (scenes.empty() || std::ranges::find(scenes, scene.name) != scenes.end())
      measureScene(scene);
  return 0;
}

} // namespace
} // namespace fenestra::benchmarks

int main(int argc, char** argv) {
  using namespace fenestra::benchmarks;
  return runBenchmark("AppearanceBenchmark", benchmark, argc, argv);
}
