#pragma once
// Helpers for the tests inside Slicer.

#include <vtkMRMLCoreTestingMacros.h>

#include <QCoreApplication>
#include <QElapsedTimer>

#include <vtkBinaryLabelmapToClosedSurfaceConversionRule.h>
#include <vtkClosedSurfaceToBinaryLabelmapConversionRule.h>
#include <vtkImageData.h>
#include <vtkMRMLScalarVolumeNode.h>
#include <vtkMRMLScene.h>
#include <vtkMRMLSegmentationNode.h>
#include <vtkNew.h>
#include <vtkOrientedImageData.h>
#include <vtkSegmentation.h>
#include <vtkSegmentationConverterFactory.h>
#include <vtkSmartPointer.h>

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

namespace FenestraTesting {

/// Processes Qt's events until the condition holds; returns whether it holds, false after minutes.
template <typename Condition>
bool waitFor(Condition&& condition) {
  QElapsedTimer watch;
  watch.start();
  while (!condition() && watch.elapsed() < 300000)
    QCoreApplication::processEvents(QEventLoop::AllEvents | QEventLoop::WaitForMoreEvents, 10);
  return condition();
}

/// Fills a ball of `value` in air: radius 10 mm, in 32 x 32 x 32 voxels of 1 mm.
inline void fillBall(vtkImageData* image, int type, double value) {
  image->SetDimensions(32, 32, 32);
  image->AllocateScalars(type, 1);
  for (int k = 0; k < 32; ++k)
    for (int j = 0; j < 32; ++j)
      for (int i = 0; i < 32; ++i) {
        const double r =
            std::sqrt((i - 16.0) * (i - 16) + (j - 16.0) * (j - 16) + (k - 16.0) * (k - 16));
        image->SetScalarComponentFromDouble(i, j, k, 0, r < 10.0 ? value : 0.0);
      }
}

inline vtkMRMLScalarVolumeNode* addVolume(vtkMRMLScene* scene) {
  vtkNew<vtkImageData> image;
  fillBall(image, VTK_SHORT, 100.0);
  auto* volume = vtkMRMLScalarVolumeNode::SafeDownCast(
      scene->AddNewNodeByClass("vtkMRMLScalarVolumeNode", "Ball"));
  volume->SetAndObserveImageData(image);
  volume->SetOrigin(-16.0, -16.0, -16.0);
  return volume;
}

/// Converts segments between labels and surfaces, like Slicer's own module.
inline void registerConverters() {
  auto* converters = vtkSegmentationConverterFactory::GetInstance();
  converters->RegisterConverterRule(
      vtkSmartPointer<vtkBinaryLabelmapToClosedSurfaceConversionRule>::New());
  converters->RegisterConverterRule(
      vtkSmartPointer<vtkClosedSurfaceToBinaryLabelmapConversionRule>::New());
}

/// Adds the ball as a segment "Ball", and an empty segment "Nothing".
inline vtkMRMLSegmentationNode* addSegmentation(vtkMRMLScene* scene) {
  vtkNew<vtkOrientedImageData> labels;
  fillBall(labels, VTK_UNSIGNED_CHAR, 1.0);
  labels->SetOrigin(-16.0, -16.0, -16.0);
  auto* node = vtkMRMLSegmentationNode::SafeDownCast(
      scene->AddNewNodeByClass("vtkMRMLSegmentationNode", "Segmentation"));
#if Slicer_VERSION_MAJOR > 5 || (Slicer_VERSION_MAJOR == 5 && Slicer_VERSION_MINOR >= 4)
  node->SetSourceRepresentationToBinaryLabelmap();
#else
  node->SetMasterRepresentationToBinaryLabelmap();
#endif
  node->AddSegmentFromBinaryLabelmapRepresentation(labels, "Ball");
  node->GetSegmentation()->AddEmptySegment("Nothing", "Nothing");
  return node;
}

/// True if a flag has these numbers within 1e-9.
inline bool isNear(const std::string& flag, const std::vector<double>& numbers) {
  std::istringstream text(flag);
  char comma = 0;
  for (size_t i = 0; i < numbers.size(); ++i) {
    double number = 0.0;
    if ((i > 0 && !(text >> comma)) || !(text >> number) || std::abs(number - numbers[i]) > 1e-9)
      return false;
  }
  return !(text >> comma);
}

} // namespace FenestraTesting
