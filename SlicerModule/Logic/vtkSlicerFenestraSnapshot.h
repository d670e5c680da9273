#ifndef __vtkSlicerFenestraSnapshot_h
#define __vtkSlicerFenestraSnapshot_h

#include "FenestraSceneFiles.h"

#include <string>
#include <vector>

class vtkMRMLScalarVolumeNode;
class vtkMRMLSegmentationNode;

/// Data of Slicer's nodes for the renderer, without copies of voxels: arrays are shared, and freed
/// with their last owner. Functions throw SlicerExport::Complaint.
namespace vtkSlicerFenestraSnapshot {
void TakeVolume(vtkMRMLScalarVolumeNode* volume, SlicerExport::Contents& contents);
/// Takes the user's volume rendering, if any: its crop box and its property, which passes through a
/// file in the private `folder`.
void TakeRendering(vtkMRMLScalarVolumeNode* volume, const std::filesystem::path& folder,
                   SlicerExport::Contents& contents);
/// Takes all segments, also hidden and unsaved ones. Segments in `focus` must exist and not be
/// empty.
void TakeSegmentation(vtkMRMLSegmentationNode* segmentation, const std::vector<std::string>& focus,
                      SlicerExport::Contents& contents);
/// All segments, also empty ones, without places of their labels.
std::vector<SlicerExport::Segment> ListSegments(vtkMRMLSegmentationNode* segmentation);
} // namespace vtkSlicerFenestraSnapshot

#endif
