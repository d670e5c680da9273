#include "MatrixRecord.h"

#include "RunSettings.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <iomanip>
#include <regex>

namespace fenestra::testing {
namespace {

constexpr int bins = 20;

using Histogram = std::array<double, bins>;

Histogram makeHistogram(const std::vector<double>& probabilities) {
  Histogram histogram{};
  for (const double p : probabilities)
    histogram[static_cast<std::size_t>(std::min(static_cast<int>(p * bins), bins - 1))] += 1.0;
  return histogram;
}

/// Draws one histogram, 320 x 180, with the expected height and two standard deviations around it.
void drawHistogram(std::ostream& svg, int left, const std::vector<double>& probabilities,
                   const std::string& title) {
  constexpr double width = 320.0, height = 180.0, top = 40.0;
  const Histogram histogram = makeHistogram(probabilities);
  const double expected = static_cast<double>(probabilities.size()) / bins;
  const double spread = 2.0 * std::sqrt(expected * (1.0 - 1.0 / bins));
  const double maximum = 1.1 * std::max(*std::ranges::max_element(histogram), expected + spread);
  const auto y = [&](double count) { return top + height * (1.0 - count / maximum); };
  svg << "<g transform='translate(" << left << ",0)'>\n<text x='" << width / 2
      << "' y='24' text-anchor='middle'>" << title << "</text>\n";
  svg << "<rect x='0' y='" << y(expected + spread) << "' width='" << width << "' height='"
      << y(expected - spread) - y(expected + spread) << "' fill='#e8e8e8'/>\n";
  for (int i = 0; i < bins; ++i) {
    const double count = histogram[static_cast<std::size_t>(i)];
    svg << "<rect x='" << (i + 0.1) * width / bins << "' y='" << y(count) << "' width='"
        << 0.8 * width / bins << "' height='" << y(0.0) - y(count) << "' fill='#3b6ea5'/>\n";
  }
  svg << "<line x1='0' x2='" << width << "' y1='" << y(expected) << "' y2='" << y(expected)
      << "' stroke='#c03030'/>\n<line x1='0' x2='" << width << "' y1='" << y(0.0) << "' y2='"
      << y(0.0) << "' stroke='black'/>\n";
  svg << "<text x='0' y='240'>0</text><text x='" << width
      << "' y='240' text-anchor='end'>1</text><text x='" << width / 2
      << "' y='240' text-anchor='middle'>probability</text>\n</g>\n";
}

void writeHistograms(const std::filesystem::path& path, const std::vector<double>& tiles,
                     const std::vector<double>& images) {
  std::ofstream svg(path);
  svg << "<svg xmlns='http://www.w3.org/2000/svg' width='760' height='260' "
         "font-family='sans-serif' font-size='13'>\n<rect width='760' height='260' "
         "fill='white'/>\n";
  drawHistogram(svg, 30, tiles, std::to_string(tiles.size()) + " tiles");
  drawHistogram(svg, 410, images, std::to_string(images.size()) + " images");
  svg << "</svg>\n";
}

/// Quoted cells of a description (Matrix.h), which separates factors by " | ".
std::string toCsvCells(const std::string& description) {
  return '"' + std::regex_replace(description, std::regex(" \\| "), "\",\"") + '"';
}

} // namespace

void recordMatrix(const std::vector<Outcome>& outcomes, const std::vector<HypothesisTest>& tests,
                  const MatrixSettings& settings) {
  const std::optional<std::filesystem::path> folder = reportFolder();
  if (!folder)
    return;
  std::vector<double> tiles, images;
  for (const Outcome& c : outcomes) {
    tiles.insert(tiles.end(), c.tileProbabilities.begin(), c.tileProbabilities.end());
    if (c.imageProbability)
      images.push_back(*c.imageProbability);
  }
  writeHistograms(*folder / "probabilities.svg", tiles, images);

  std::ofstream summary(*folder / "matrix-summary.csv");
  summary
      << std::setprecision(3)
      << "hypothesis,values,probability,significance level,combinations,samples per pixel,seed\n";
  for (const HypothesisTest& test : tests)
    summary << test.name << ',' << std::llround(test.count) << ',' << test.probability << ','
            << significanceLevel(tests.size()) << ',' << outcomes.size() << ',' << settings.samples
            << ',' << settings.seed << '\n';
  std::ofstream csv(*folder / "matrix.csv");
  csv << std::setprecision(3)
      << "combination,view,clip,light,g,albedo,transfer function,voxels,grid,background,bounces,"
         "difference of the image in percent,z,probability\n";
  for (const Outcome& c : outcomes)
    csv << c.combination.index << ',' << toCsvCells(describe(c.combination)) << ','
        << 100.0 * c.difference << ',' << c.z << ',' << c.probability() << '\n';
}

} // namespace fenestra::testing
