#ifndef __vtkSlicerFenestraSnapshot_h
#define __vtkSlicerFenestraSnapshot_h

#include "FenestraSceneFiles.h"

#include <string>
#include <vector>

class vtkMRMLScalarVolumeNode;
class vtkMRMLSegmentationNode;

/// Reads Slicer's nodes for the renderer without copying voxels: arrays are shared, and freed with
/// their last owner. Functions throw SlicerExport::UserError.
namespace vtkSlicerFenestraSnapshot {
void TakeVolume(vtkMRMLScalarVolumeNode* volume, SlicerExport::Contents& contents);
/// Takes crop box and property of the volume rendering, if any. The property passes through a file
/// in the private `folder`.
void TakeRendering(vtkMRMLScalarVolumeNode* volume, const std::filesystem::path& folder,
                   SlicerExport::Contents& contents);
/// Takes all segments, including hidden and unsaved ones. Segments in `focus` must exist and not be
/// empty.
void TakeSegmentation(vtkMRMLSegmentationNode* segmentation, const std::vector<std::string>& focus,
                      SlicerExport::Contents& contents);
/// All segments, including empty ones; their layers are not set.
std::vector<SlicerExport::Segment> ListSegments(vtkMRMLSegmentationNode* segmentation);
} // namespace vtkSlicerFenestraSnapshot

#endif
