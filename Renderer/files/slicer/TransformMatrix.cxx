#include "files/slicer/TransformMatrix.h"

#include <itkAffineTransform.h>
#include <itkCenteredAffineTransform.h>
#include <itkCenteredEuler3DTransform.h>
#include <itkComposeScaleSkewVersor3DTransform.h>
#include <itkEuler3DTransform.h>
#include <itkFixedCenterOfRotationAffineTransform.h>
#include <itkQuaternionRigidTransform.h>
#include <itkScalableAffineTransform.h>
#include <itkScaleLogarithmicTransform.h>
#include <itkScaleSkewVersor3DTransform.h>
#include <itkScaleTransform.h>
#include <itkScaleVersor3DTransform.h>
#include <itkSimilarity3DTransform.h>
#include <itkVersorRigid3DTransform.h>

#include <map>

namespace fenestra {
namespace {

using Path = std::filesystem::path;

bool hasParameters(const TransformRecord& record, std::size_t count, std::size_t mostFixed) {
  return record.parameters.size() == count &&
         (record.fixed.empty() || (record.fixed.size() >= 3 && record.fixed.size() <= mostFixed));
}

/// Matrix and offset that ITK's class computes from its parameters.
template <typename Transform>
Affine matrixOffset(const Path& path, const TransformRecord& record) {
  const auto transform = Transform::New();
  // Euler angles may have a fourth fixed parameter, the order of the axes.
  if (!hasParameters(record, transform->GetNumberOfParameters(),
                     std::max<std::size_t>(3, transform->GetFixedParameters().size())))
    throwDamagedTransform(path);
  const auto fill = [](auto array, const std::vector<double>& values) {
    array.SetSize(static_cast<unsigned>(values.size()));
    std::copy(values.begin(), values.end(), array.begin());
    return array;
  };
  if (!record.fixed.empty())
    transform->SetFixedParameters(fill(transform->GetFixedParameters(), record.fixed));
  transform->SetParameters(fill(transform->GetParameters(), record.parameters));
  transform->SetCenter(transform->GetCenter()); // recomputes the offset, which some classes do not
  Affine map;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column)
      map.linear()(row, column) =
          transform->GetMatrix()(static_cast<unsigned>(row), static_cast<unsigned>(column));
    map.translation()[row] = transform->GetOffset()[static_cast<unsigned>(row)];
  }
  return map;
}

Affine translation(const Path& path, const TransformRecord& record) {
  if (record.parameters.size() != 3)
    throwDamagedTransform(path);
  return translationBy({record.parameters[0], record.parameters[1], record.parameters[2]});
}

Affine identity(const Path&, const TransformRecord&) {
  return Affine::Identity();
}

using Reader = Affine (*)(const Path&, const TransformRecord&);

/// ITK's linear transforms of three axes, by the names that files use.
const std::map<std::string, Reader>& readers() {
  static const std::map<std::string, Reader> all = {
      {"AffineTransform", matrixOffset<itk::AffineTransform<double, 3>>},
      {"CenteredAffineTransform", matrixOffset<itk::CenteredAffineTransform<double, 3>>},
      {"CenteredEuler3DTransform", matrixOffset<itk::CenteredEuler3DTransform<double>>},
      {"ComposeScaleSkewVersor3DTransform",
       matrixOffset<itk::ComposeScaleSkewVersor3DTransform<double>>},
      {"Euler3DTransform", matrixOffset<itk::Euler3DTransform<double>>},
      {"FixedCenterOfRotationAffineTransform",
       matrixOffset<itk::FixedCenterOfRotationAffineTransform<double, 3>>},
      {"IdentityTransform", identity},
      {"MatrixOffsetTransformBase", matrixOffset<itk::MatrixOffsetTransformBase<double, 3, 3>>},
      {"QuaternionRigidTransform", matrixOffset<itk::QuaternionRigidTransform<double>>},
      {"Rigid3DTransform", matrixOffset<itk::Rigid3DTransform<double>>},
      {"ScalableAffineTransform", matrixOffset<itk::ScalableAffineTransform<double, 3>>},
      {"ScaleLogarithmicTransform", matrixOffset<itk::ScaleLogarithmicTransform<double, 3>>},
      {"ScaleSkewVersor3DTransform", matrixOffset<itk::ScaleSkewVersor3DTransform<double>>},
      {"ScaleTransform", matrixOffset<itk::ScaleTransform<double, 3>>},
      {"ScaleVersor3DTransform", matrixOffset<itk::ScaleVersor3DTransform<double>>},
      {"Similarity3DTransform", matrixOffset<itk::Similarity3DTransform<double>>},
      {"TranslationTransform", translation},
      {"VersorRigid3DTransform", matrixOffset<itk::VersorRigid3DTransform<double>>},
      {"VersorTransform", matrixOffset<itk::VersorTransform<double>>},
  };
  return all;
}

} // namespace

bool isLinearTransform(const std::string& type) {
  return type == "CompositeTransform" || readers().contains(type);
}

Affine transformMatrix(const Path& path, const TransformRecord& record) {
  const auto reader = readers().find(record.type);
  if (reader == readers().end())
    throwDamagedTransform(path); // a composite within a composite
  return reader->second(path, record);
}

} // namespace fenestra
