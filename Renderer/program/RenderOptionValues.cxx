#include "program/RenderOptionValues.h"

#include "files/images/ImageFormat.h"
#include "io/MessageText.h"
#include "program/UsageError.h"

#include <algorithm>
#include <cstdio>

namespace fenestra::core {
namespace {

/// R,G,B, or one number for all three. `alternatives`: other valid values, for the message.
Rgb parseLinearColor(const OptionValues& values, const std::string& name,
                     const std::string& alternatives) {
  constexpr double brightest = 1e12; // keeps products within a float's range
  const std::string text = *values.text(name);
  const bool numbers = text.find_first_not_of("0123456789+-.,eE ") == std::string::npos;
  const bool isGray = text.find(',') == std::string::npos;
  const Rgb value = !numbers ? Rgb::Constant(-1.0)
                    : isGray ? Rgb::Constant(values.numbers(name, 1)[0])
                             : Rgb(values.triple(name).array());
  if (value.minCoeff() < 0.0 || value.maxCoeff() > brightest)
    throw usageError("--", name, ": expected R,G,B, or one number for gray, from 0 to 1e12, or ",
                     alternatives, ", got '", toOneLine(text), "'");
  return value;
}

} // namespace

void readMargins(const OptionValues& values, const std::string& name, FocusRequest& focus) {
  const std::string text = *values.text(name);
  focus.shaping.margins.clear();
  focus.hasOrganMargin = text == "auto";
  if (focus.hasOrganMargin)
    return;
  const auto commas = std::ranges::count(text, ',');
  focus.shaping.margins = values.numbers(name, 1 + static_cast<std::size_t>(commas));
  for (const double margin : focus.shaping.margins)
    if (std::abs(margin) > 1000.0)
      throw usageError("--" + name + ": must be from -1000 to 1000 mm");
}

void readVolumeSmoothing(const OptionValues& values, const std::string& name,
                         SmoothingRequest& smoothing) {
  using Kind = SmoothingRequest::Kind;
  const std::string text = *values.text(name);
  const bool isWord = text == "auto" || text == "off";
  const double noise = isWord ? 0.0 : values.numbers(name, 1)[0];
  if (noise < 0.0)
    throw usageError("--", name, ": expected auto, off, or a positive number, got '",
                     toOneLine(text), "'");
  smoothing = text == "auto" ? SmoothingRequest{Kind::automatic}
              : noise > 0.0  ? SmoothingRequest{Kind::given, noise}
                             : SmoothingRequest{Kind::off};
}

void readPlane(const OptionValues& values, const std::string& name,
               std::optional<PlaneRequest>& plane) {
  const std::vector<double> numbers = values.numbers(name, 6);
  const Vec3 normal(numbers[3], numbers[4], numbers[5]);
  if (normal.isZero(0.0))
    throw usageError("--" + name + ": the normal NX,NY,NZ must not be zero");
  plane = {Vec3(numbers[0], numbers[1], numbers[2]), normal.stableNormalized()};
}

void readEnvironment(const OptionValues& values, const std::string& name, RenderRequest& scene) {
  const std::string text = *values.text(name);
  if (findImageFormat(text) == ImageFormat::exr)
    scene.environmentMap = text;
  else
    scene.environment = parseLinearColor(values, name, "an .exr file");
}

void readBackground(const OptionValues& values, const std::string& name,
                    std::optional<Background>& background) {
  const std::string text = *values.text(name);
  if (text == "transparent")
    background = Background{Background::Kind::transparent};
  else if (text == "environment")
    background = Background{Background::Kind::environment};
  else if (text == "gradient")
    background = Background::makeDarkGradient();
  else if (text == "dark")
    background = Background::makeDark();
  else if (text == "gray")
    background = Background::makeGray();
  else
    background = Background{
        Background::Kind::color,
        parseLinearColor(values, name, "dark, gradient, gray, transparent or environment")};
}

void readAnnotations(const OptionValues& values, const std::string& name,
                     Annotations& annotations) {
  const std::vector<std::string> marks = values.list(name);
  if (marks == std::vector<std::string>{"none"})
    return;
  for (const std::string& mark : marks) {
    if (mark != "scale" && mark != "orientation")
      throw usageError("--", name, ": expected scale, orientation or both, or none, got '",
                       toOneLine(*values.text(name)), "'");
    (mark == "scale" ? annotations.scale : annotations.orientation) = true;
  }
}

void readSpacing(const OptionValues& values, const std::string& name,
                 std::optional<Vec3>& spacing) {
  const std::string text = *values.text(name);
  const bool isCubic = text.find(',') == std::string::npos;
  spacing = isCubic ? Vec3::Constant(values.numbers(name, 1)[0]) : values.triple(name);
  if (spacing->minCoeff() < 1e-9 || spacing->maxCoeff() > 1e9)
    throw usageError("--", name, ": must be from 1e-9 to 1e9 mm, got '", toOneLine(text), "'");
}

void readSize(const OptionValues& values, const std::string& name, RenderRequest& scene) {
  constexpr int largest = 16384;
  const std::string text = *values.text(name);
  char rest = 0;
  const int parts = std::sscanf(text.c_str(), "%dx%d%c", &scene.width, &scene.height, &rest);
  if (parts != 2 || std::min(scene.width, scene.height) < 1 ||
      std::max(scene.width, scene.height) > largest)
    throw usageError("--", name, ": expected WIDTHxHEIGHT in pixels, each from 1 to ", largest,
                     ", got '", toOneLine(text), "'");
}

void readShard(const OptionValues& values, const std::string& name, RenderOptions& options) {
  const std::string text = *values.text(name);
  int number = 0, count = 0;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%d/%d%c", &number, &count, &rest) != 2 || number < 1 ||
      number > count || count > maxShards)
    throw usageError("--", name, ": expected K/N, shard K of N, from 1/1 to ", maxShards, "/",
                     maxShards, ", got '", toOneLine(text), "'");
  options.settings.shard = {number - 1, count};
  options.isShard = true;
}

void readTexts(const OptionValues& values, const std::string& name,
               std::vector<std::string>& texts) {
  texts = values.texts(name);
}

void readWord(const OptionValues& values, const std::string& name,
              std::optional<std::string>& word) {
  word = values.word(name);
}

void readSwitch(const OptionValues&, const std::string&, bool& isOn) {
  isOn = true;
}

void readLayers(const OptionValues& values, const std::string& name, LayerSet& layers) {
  layers = parseLayers(values.list(name));
}

} // namespace fenestra::core
