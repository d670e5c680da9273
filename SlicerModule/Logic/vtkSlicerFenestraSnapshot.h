#ifndef __vtkSlicerFenestraSnapshot_h
#define __vtkSlicerFenestraSnapshot_h

#include "FenestraSceneFiles.h"

#include <string>
#include <vector>

class vtkMRMLScalarVolumeNode;
class vtkMRMLSegmentationNode;

/// What the renderer needs of Slicer's nodes, taken without copying voxels: arrays are shared, and
/// live as long as who wants them. Functions throw vtkSlicerFenestraComplaint.
namespace vtkSlicerFenestraSnapshot {
void TakeVolume(vtkMRMLScalarVolumeNode* volume, FenestraScene::Contents& contents);
/// The volume rendering that the user set up, if any: its property, which passes through a file in
/// the private `folder`, and its crop box.
void TakeRendering(vtkMRMLScalarVolumeNode* volume, const std::filesystem::path& folder,
                   FenestraScene::Contents& contents);
/// All segments, hidden and unsaved ones, too. Those of `focus` must be there and not empty.
void TakeSegmentation(vtkMRMLSegmentationNode* segmentation, const std::vector<std::string>& focus,
                      FenestraScene::Contents& contents);
} // namespace vtkSlicerFenestraSnapshot

#endif
