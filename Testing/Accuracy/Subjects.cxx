#include "Subjects.h"

#include "files/images/ImageReader.h"
#include "scene/PreparedScene.h"

#include <itkImage.h>
#include <itkImageFileReader.h>
#include <itkNiftiImageIOFactory.h>
#include <itkNrrdImageIOFactory.h>

#include <cmath>
#include <cstdlib>
#include <sstream>
#include <stdexcept>

namespace fenestra::core::accuracy {

namespace {

std::string quote(const std::string& word) {
  return "'" + word + "'";
}

void runFenestra(const std::string& arguments) {
  const std::string command = quote(FENESTRA_EXECUTABLE) + " " + arguments + " > /dev/null";
  if (std::system(command.c_str()) != 0)
    throw std::runtime_error("command failed: " + command);
}

/// Formats a vector as an option value.
std::string toOptionValue(const Vec3& v) {
  std::ostringstream text;
  text.precision(17);
  text << v.x() << ',' << v.y() << ',' << v.z();
  return text.str();
}

RenderRequest makeRequest(const Subject& subject) {
  RenderRequest request;
  request.input = subject.input;
  if (subject.input.extension() != ".mrml")
    request.segmentation = subject.labelmap.string();
  request.focus = {subject.focus};
  request.focusStyle.shaping.smoothing = subject.smoothing;
  request.clip.softness = 0.0; // compare the depths of the surface itself
  return request;
}

Indicator makeSmoothedIndicator(const Subject& subject) {
  const PreparedScene scene(makeRequest(subject));
  const Mask& mask = *scene.focus();
  return {mask.grid.size, mask.grid.indexToWorld, mask.voxels, static_cast<double>(mask.maxValue)};
}

} // namespace

Subject makeKnee(const std::filesystem::path& folder, const std::string& size) {
  const std::filesystem::path knee = folder / "knee";
  runFenestra("phantom knee --output " + quote(knee.string()) +
              (size.empty() ? "" : " --size " + size));
  constexpr int femoralCartilage = 5; // label value in the phantom
  return {"knee", knee / "knee.mrml", knee / "knee.seg.nrrd", "FemoralCartilage", femoralCartilage};
}

Indicator readIndicator(const Subject& subject) {
  if (subject.smoothing > 0.0)
    return makeSmoothedIndicator(subject);
  using Labels = itk::Image<std::int32_t, 3>;
  itk::NiftiImageIOFactory::RegisterOneFactory();
  itk::NrrdImageIOFactory::RegisterOneFactory();
  const auto reader = itk::ImageFileReader<Labels>::New();
  reader->SetFileName(subject.labelmap.string());
  reader->Update();
  const Labels* const labels = reader->GetOutput();
  const auto size = labels->GetLargestPossibleRegion().GetSize();
  Indicator indicator;
  for (unsigned axis = 0; axis < 3; ++axis) {
    const double mirrored = axis < 2 ? -1.0 : 1.0; // ITK uses LPS
    indicator.size[axis] = static_cast<std::int64_t>(size[axis]);
    for (unsigned column = 0; column < 3; ++column)
      indicator.indexToWorld.linear()(axis, column) =
          mirrored * labels->GetDirection()[axis][column] * labels->GetSpacing()[column];
    indicator.indexToWorld.translation()[axis] = mirrored * labels->GetOrigin()[axis];
  }
  const std::int32_t* const voxels = labels->GetBufferPointer();
  for (std::int64_t i = 0; i < indicator.size.prod(); ++i)
    indicator.voxels.push_back(voxels[i] == subject.label ? 1 : 0);
  return indicator;
}

View makeView(const FocusField& field, int number, int count, int size, double elevation) {
  const double angle = 2.0 * pi * number / count;
  const double height = elevation * pi / 180.0;
  View view;
  view.target = field.center();
  view.position = view.target + 500.0 * Vec3(std::cos(height) * std::sin(angle),
                                             std::cos(height) * std::cos(angle), std::sin(height));
  view.up = Vec3::UnitZ();
  view.halfHeight = 1.1 * field.radius();
  view.size = size;
  return view;
}

RenderRequest makeRequest(const Subject& subject, const View& view, Boundary boundary) {
  RenderRequest request = makeRequest(subject);
  request.clip.mode = ClipMode::surface;
  request.clip.surface.boundary = boundary;
  request.view.position = view.position;
  request.view.target = view.target;
  request.view.up = view.up;
  request.view.projection = view.isPerspective ? Projection::perspective : Projection::orthographic;
  if (view.isPerspective)
    request.view.angle = view.angle();
  else
    request.view.scale = view.halfHeight;
  request.width = request.height = view.size;
  return request;
}

Surface makeSurface(const Subject& subject, const View& view, const std::string& boundary) {
  const auto scene = std::make_shared<const PreparedScene>(
      makeRequest(subject, view, boundary == "exact" ? Boundary::exact : Boundary::spline));
  return [scene](const Vec2& raster) {
    return std::get<ClipDepth>(scene->clip())
        .surfaceDepth(scene->camera().toPlane(raster.x(), raster.y()));
  };
}

std::vector<float> renderDepths(const Subject& subject, const View& view,
                                const std::string& boundary, const std::filesystem::path& folder) {
  const std::filesystem::path image = folder / (boundary + ".exr");
  std::ostringstream arguments;
  arguments.precision(17);
  arguments << quote(subject.input.string()) << " --focus " << quote(subject.focus)
            << " --label-smoothing " << subject.smoothing << " --clip-softness 0 --clip-boundary "
            << boundary << " --position=" << toOptionValue(view.position)
            << " --target=" << toOptionValue(view.target) << " --up=" << toOptionValue(view.up)
            << " --scale " << view.halfHeight << " --projection orthographic --size " << view.size
            << 'x' << view.size
            << " --transfer '{\"extinction\": [[0, 100]], \"albedo\": [[0, 0.5, 0.5, 0.5]]}'"
            << " --samples 4 --bounces 1 --layers depth --progress none --output "
            << quote(image.string());
  runFenestra(arguments.str());
  return *readImage(image).find("Z");
}

} // namespace fenestra::core::accuracy
