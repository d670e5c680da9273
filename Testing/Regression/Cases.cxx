#include "Cases.h"

#include "Agreement.h"
#include "Cli/Process.h"
#include "files/images/ImageReader.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>

namespace fenestra::core::testing {

namespace {

/// Words of a line, with each "@name" replaced by its definition.
std::vector<std::string> expandWords(const std::string& line,
                                     const std::map<std::string, std::vector<std::string>>& names) {
  std::vector<std::string> result;
  std::istringstream stream(line);
  for (std::string word; stream >> word;) {
    const auto name = names.find(word);
    if (name == names.end())
      result.push_back(word);
    else
      result.insert(result.end(), name->second.begin(), name->second.end());
  }
  return result;
}

/// Case of "name" or "name:baseline".
RegressionCase makeCase(const std::string& text, std::uint64_t samples,
                        std::vector<std::string> arguments) {
  const std::size_t colon = text.find(':');
  const std::string baseline = colon == std::string::npos ? text : text.substr(colon + 1);
  return {text.substr(0, colon), baseline, samples, std::move(arguments)};
}

} // namespace

std::vector<RegressionCase> readCases() {
  std::vector<RegressionCase> cases;
  std::map<std::string, std::vector<std::string>> names;
  std::ifstream table(FENESTRA_REGRESSION_CASES);
  for (std::string line; std::getline(table, line);) {
    if (line.empty() || line[0] == '#')
      continue;
    std::vector<std::string> all = expandWords(line, names);
    if (all.size() < 3)
      throw std::runtime_error(std::string(FENESTRA_REGRESSION_CASES) + ": too few words: " + line);
    if (all[1] == "=")
      names[all[0]] = {all.begin() + 2, all.end()};
    else
      cases.push_back(makeCase(all[0], std::stoull(all[1]), {all.begin() + 2, all.end()}));
  }
  if (cases.empty())
    throw std::runtime_error(std::string(FENESTRA_REGRESSION_CASES) + ": no cases");
  return cases;
}

std::filesystem::path dataFolder() {
  return FENESTRA_REGRESSION_DATA;
}

std::filesystem::path baselinePath(const RegressionCase& c) {
  return dataFolder() / "baselines" / (c.baseline + ".exr");
}

Image renderCase(const RegressionCase& c, std::uint64_t seed, std::uint64_t samples,
                 const std::filesystem::path& folder, const std::filesystem::path& output) {
  std::filesystem::create_directories(output.parent_path());
  Arguments arguments = c.arguments;
  // Relative paths, since the image header stores the arguments.
  arguments.insert(arguments.end(),
                   {"--seed", std::to_string(seed), "--samples", std::to_string(samples),
                    "--layers", "color,error,samples", "--progress", "none", "--output",
                    std::filesystem::proximate(output, folder).string()});
  const Outcome outcome = run(arguments, folder);
  if (outcome.status != 0)
    throw std::runtime_error(c.name + ": exit status " + std::to_string(outcome.status) + ": " +
                             outcome.err);
  return readImage(output);
}

double Agreement::probability() const {
  // 1 - (1 - minimum)^3, precise for small probabilities.
  return -std::expm1(3.0 * std::log1p(-std::min({pixels, tiles, mean})));
}

Agreement compareWithBaseline(const Image& image, const Image& baseline) {
  const auto compareTiles = [&](int size) {
    return computeAgreement(computeTileMeans(image, size), computeTileMeans(baseline, size));
  };
  return {computeAgreement(image, baseline), compareTiles(8),
          compareTiles(std::max(image.width, image.height))};
}

} // namespace fenestra::core::testing
