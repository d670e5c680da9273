#include "fenestra/Image.h"

#include "files/images/ImageFormat.h"
#include "files/images/ImageWriter.h"
#include "library/Convert.h"
#include "library/Data.h"
#include "library/MakeImage.h"
#include "program/about/Version.h"
#include "scene/FilmImage.h"

#include <algorithm>
#include <cmath>

namespace fenestra {
inline namespace v1 {
namespace {

/// Channels that form an array, in order, and the array.
struct Layer {
  std::vector<const char*> channels;
  std::vector<float> Image::Data::*values;
};

const std::vector<Layer>& layers() {
  using D = Image::Data;
  static const std::vector<Layer> all = {
      {{"R", "G", "B", "A"}, &D::rgba},
      {{"denoised.R", "denoised.G", "denoised.B", "denoised.A"}, &D::denoised},
      {{"Z"}, &D::depth},
      {{"clip.Z"}, &D::clipDepth},
      {{"normal.X", "normal.Y", "normal.Z"}, &D::normals},
      {{"albedo.R", "albedo.G", "albedo.B"}, &D::albedo},
      {{"error.R", "error.G", "error.B"}, &D::error},
      {{"samples.N"}, &D::sampleCounts}};
  return all;
}

/// Values of the channels, pixel by pixel; empty: the image lacks them.
std::vector<float> interleave(const core::Image& image, const std::vector<const char*>& channels) {
  std::vector<float> values;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    const core::Plane* const plane = image.find(channels[c]);
    if (!plane)
      return {};
    values.resize(plane->size() * channels.size());
    for (std::size_t i = 0; i < plane->size(); ++i)
      values[i * channels.size() + c] = (*plane)[i];
  }
  return values;
}

void addChannels(const Layer& layer, const Image::Data& data, core::Image& image) {
  const std::vector<float>& values = data.*layer.values;
  const std::size_t count = layer.channels.size();
  for (std::size_t c = 0; !values.empty() && c < count; ++c) {
    core::Plane& plane = image.channels[layer.channels[c]];
    plane.resize(values.size() / count);
    for (std::size_t i = 0; i < plane.size(); ++i)
      plane[i] = values[i * count + c];
  }
}

/// All channels, R, G, B and A as rendered; for display, R, G, B and A alone, denoised if they are.
core::Image toChannels(const Image::Data& data, bool isForDisplay) {
  core::Image image{data.width, data.height, {}, data.metadata};
  if (!isForDisplay)
    for (const Layer& layer : layers())
      addChannels(layer, data, image);
  else
    addChannels({layers().front().channels,
                 data.denoised.empty() ? &Image::Data::rgba : &Image::Data::denoised},
                data, image);
  return image;
}

/// Throws core::Error (request) for marks that the projection does not allow.
core::Display makeDisplay(const Display& display, const Image::Data& data) {
  if (display.hasScale && !data.isOrthographic)
    throw core::requestError(core::ErrorCode::scaleOfPerspectiveCamera, "scale bar",
                             "requires an orthographic projection");
  return {.view = display.tone == Tone::film ? core::DisplayView::film
                                             : core::DisplayView::photographic,
          .exposure = display.exposure,
          .annotations = {display.hasScale, display.hasOrientation}};
}

std::string describe(const core::CameraPose& pose) {
  constexpr int exact = 17; // significant digits
  const bool isPerspective = pose.projection == core::Projection::perspective;
  return core::concat(isPerspective ? "perspective, angle " : "orthographic, scale ",
                      core::toString(isPerspective ? pose.angle : pose.scale, exact), "; position ",
                      core::joinNumbers(pose.position, ",", exact), "; target ",
                      core::joinNumbers(pose.target, ",", exact), "; up ",
                      core::joinNumbers(pose.up, ",", exact));
}

} // namespace

Image makeImage(const core::PreparedScene& scene, const std::string* preset,
                const core::RenderSettings& settings, const core::RenderResult& result,
                const std::optional<core::FilteredImage>& filtered) {
  core::Image channels =
      core::makeImage(result.film, scene.camera(), scene.clip(), core::allLayers);
  auto data = std::make_shared<Image::Data>();
  data->metadata = core::makeImageHeader(scene, settings, result);
  data->metadata["camera"] = describe(scene.camera().pose());
  data->metadata["version"] = core::versionText;
  data->metadata["target"] = core::concat(core::processorText, "-", result.target);
  data->metadata["look"] = scene.transferName();
  if (preset)
    data->metadata["preset"] = *preset;
  if (filtered) {
    core::addDenoised(channels, *filtered);
    data->metadata["filter"] = core::describeDenoising(filtered);
  }
  data->width = channels.width;
  data->height = channels.height;
  for (const Layer& layer : layers())
    (*data).*layer.values = interleave(channels, layer.channels);
  data->plane = core::makeImagePlane(scene.camera());
  data->isOrthographic = scene.camera().pose().projection == core::Projection::orthographic;
  data->noise = result.film.noise();
  data->denoisedNoise = core::denoisedNoise(filtered).value_or(core::infinity);
  data->samples = result.finishedSamples;
  data->isComplete = result.reason != core::StopReason::request;
  return Image(std::move(data));
}

Image::Image(std::shared_ptr<const Data> data) : m_data(std::move(data)) {}

int Image::width() const {
  return m_data->width;
}
int Image::height() const {
  return m_data->height;
}
std::span<const float> Image::rgba() const {
  return m_data->rgba;
}
std::span<const float> Image::denoised() const {
  return m_data->denoised;
}
std::span<const float> Image::depth() const {
  return m_data->depth;
}
std::span<const float> Image::clipDepth() const {
  return m_data->clipDepth;
}
std::span<const float> Image::normals() const {
  return m_data->normals;
}
std::span<const float> Image::albedo() const {
  return m_data->albedo;
}
std::span<const float> Image::error() const {
  return m_data->error;
}
std::span<const float> Image::sampleCounts() const {
  return m_data->sampleCounts;
}
double Image::noise() const {
  return m_data->noise;
}
double Image::denoisedNoise() const {
  return m_data->denoisedNoise;
}
std::uint64_t Image::samples() const {
  return m_data->samples;
}
bool Image::isComplete() const {
  return m_data->isComplete;
}
const std::map<std::string, std::string>& Image::metadata() const {
  return m_data->metadata;
}

std::vector<std::uint8_t> Image::display(const Display& display) const {
  return guard([&] {
    const std::vector<float> encoded = core::makeDisplayPixels(
        toChannels(*m_data, true), m_data->plane, makeDisplay(display, *m_data));
    std::vector<std::uint8_t> bytes(encoded.size());
    std::ranges::transform(encoded, bytes.begin(), [](float value) {
      return static_cast<std::uint8_t>(std::lround(255.0 * static_cast<double>(value)));
    });
    return bytes;
  });
}

std::string Image::png(const Display& display) const {
  return guard([&] {
    return core::encodePng(toChannels(*m_data, true), m_data->plane, makeDisplay(display, *m_data));
  });
}

void Image::save(const std::string& path, const Display& display) const {
  guard([&] {
    core::Outputs outputs;
    core::declareImage(path, outputs, core::NameOrigin::user,
                       {.denoised = !m_data->denoised.empty()});
    core::writeImage(toChannels(*m_data, core::isDisplayFile(path)), m_data->plane, path, outputs,
                     makeDisplay(display, *m_data));
    outputs.commit();
  });
}

} // namespace v1
} // namespace fenestra
