#include "Subjects.h"

#include "io/pictures/ImageReader.h"

#include <itkImage.h>
#include <itkImageFileReader.h>
#include <itkNiftiImageIOFactory.h>
#include <itkNrrdImageIOFactory.h>

#include <cmath>
#include <cstdlib>
#include <iomanip>
#include <sstream>
#include <stdexcept>

namespace fenestra::accuracy {

namespace {

std::string quoted(const std::string& word) {
  return "'" + word + "'";
}

void runFenestra(const std::string& arguments) {
  const std::string command = quoted(FENESTRA_EXECUTABLE) + " " + arguments + " > /dev/null";
  if (std::system(command.c_str()) != 0)
    throw std::runtime_error("failed: " + command);
}

std::string text(const Vec3& p) {
  std::ostringstream out;
  out << std::setprecision(17) << p.x() << ',' << p.y() << ',' << p.z();
  return out.str();
}

} // namespace

Subject makeKnee(const std::filesystem::path& folder, const std::string& size) {
  const std::filesystem::path knee = folder / "knee";
  runFenestra("phantom knee --output " + quoted(knee.string()) +
              (size.empty() ? "" : " --size " + size));
  constexpr int femoralCartilage = 5; // as the phantom numbers its segments
  return {"knee", knee / "knee.mrml", knee / "knee.seg.nrrd", "FemoralCartilage", femoralCartilage};
}

Indicator readIndicator(const Subject& subject) {
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
    const double mirrored = axis < 2 ? -1.0 : 1.0; // ITK's world is LPS
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

View viewAround(const FocusField& field, int number, int count, int size) {
  const double angle = 2.0 * pi * number / count;
  View view;
  view.target = field.centre();
  view.position = view.target + 500.0 * Vec3(std::sin(angle), std::cos(angle), 0.0);
  view.up = Vec3::UnitZ();
  view.halfHeight = 1.1 * field.radius();
  view.size = size;
  return view;
}

std::vector<float> clipDepths(const Subject& subject, const View& view, const std::string& boundary,
                              const std::filesystem::path& folder) {
  const std::filesystem::path picture = folder / "clip.exr";
  std::ostringstream arguments;
  arguments << std::setprecision(17) << quoted(subject.input.string());
  if (subject.input.extension() != ".mrml")
    arguments << " --segmentation " << quoted(subject.labelmap.string());
  arguments << " --focus " << subject.focus << " --clip surface --boundary " << boundary
            << " --position=" << text(view.position) << " --target=" << text(view.target)
            << " --up=" << text(view.up) << " --projection "
            << (view.isPerspective ? "perspective --angle " : "orthographic --scale ")
            << (view.isPerspective
                    ? 360.0 / pi * std::atan(view.halfHeight / (view.target - view.position).norm())
                    : view.halfHeight)
            << " --size " << view.size << 'x' << view.size
            << " --samples 1 --bounces 1 --layers clip --progress none --output "
            << quoted(picture.string());
  runFenestra(arguments.str());
  return readImage(picture).channels.at("clip.Z");
}

} // namespace fenestra::accuracy
