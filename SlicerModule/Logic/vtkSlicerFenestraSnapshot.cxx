#include "vtkSlicerFenestraSnapshot.h"

#include "vtkSlicerFenestraLogic.h"

#include <vtkMRMLDisplayNode.h>
#include <vtkMRMLMarkupsROINode.h>
#include <vtkMRMLScalarVolumeNode.h>
#include <vtkMRMLSegmentationNode.h>
#include <vtkMRMLTransformNode.h>
#include <vtkMRMLVolumePropertyNode.h>
#include <vtkMRMLVolumePropertyStorageNode.h>
#include <vtkMRMLVolumeRenderingDisplayNode.h>

#include <vtkOrientedImageData.h>
#include <vtkOrientedImageDataResample.h>
#include <vtkSegment.h>
#include <vtkSegmentation.h>
#include <vtkSegmentationConverter.h>

#include <vtkDataArray.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkVolumeProperty.h>
#include <vtkWeakPointer.h>
#include <vtksys/SystemTools.hxx>

#include <algorithm>
#include <fstream>
#include <sstream>

namespace {
using UserError = SlicerExport::UserError;

std::string Quote(vtkMRMLNode* node) {
  return std::string("\"") + (node->GetName() ? node->GetName() : "") + "\"";
}

/// Empty: not a type of voxels.
std::string ToNrrdType(vtkDataArray* array) {
  const int type = array->GetDataType(), bits = 8 * array->GetDataTypeSize();
  if (type == VTK_FLOAT || type == VTK_DOUBLE)
    return array->GetDataTypeAsString();
  const std::string sign = array->GetDataTypeMin() < 0.0 ? "" : "u";
  return bits == 0 ? std::string() : sign + "int" + std::to_string(bits);
}

SlicerExport::Matrix ToMatrix(vtkMatrix4x4* matrix) {
  SlicerExport::Matrix copy;
  std::copy_n(matrix->GetData(), 16, copy.begin());
  return copy;
}

/// Image that shares the array and keeps it alive. `ijkToRas` refers to index 0, but the extent may
/// begin at another index.
SlicerExport::Image ShareImage(vtkImageData* image, vtkMatrix4x4* ijkToRas) {
  SlicerExport::Image shared;
  vtkSmartPointer<vtkDataArray> array = image->GetPointData()->GetScalars();
  int extent[6];
  image->GetExtent(extent);
  shared.type = ToNrrdType(array);
  shared.ijkToRas = ToMatrix(ijkToRas);
  for (int axis = 0; axis < 3; ++axis) {
    shared.size[axis] = static_cast<size_t>(extent[2 * axis + 1] - extent[2 * axis] + 1);
    for (int row = 0; row < 3; ++row)
      shared.ijkToRas[4 * row + 3] += extent[2 * axis] * ijkToRas->GetElement(row, axis);
  }
  const void* voxels = array->GetVoidPointer(0);
  shared.data = std::shared_ptr<const void>(voxels, [array](const void*) {});
  return shared;
}

SlicerExport::Matrix GetWorldMatrix(vtkMRMLTransformableNode* node) {
  vtkMRMLTransformNode* transform = node->GetParentTransformNode();
  if (!transform)
    return SlicerExport::identity;
  if (!transform->IsTransformToWorldLinear())
    throw UserError(Quote(node) + " has a nonlinear transform. Harden the transform "
                                  "(Data module, right click), then try again.");
  vtkNew<vtkMatrix4x4> toWorld;
  transform->GetMatrixTransformToWorld(toWorld);
  return ToMatrix(toWorld);
}

/// Key that changes with the voxels, their array and their position.
std::string MakeKey(vtkObject* object, const char* id, const SlicerExport::Image& image) {
  std::ostringstream key;
  key << id << ' ' << object->GetMTime() << ' ' << image.data.get();
  for (const double element : image.ijkToRas)
    key << ' ' << element;
  return key.str();
}

vtkMRMLVolumeRenderingDisplayNode* FindRenderingDisplay(vtkMRMLScalarVolumeNode* volume) {
  vtkMRMLVolumeRenderingDisplayNode* first = nullptr;
  for (int i = 0; i < volume->GetNumberOfDisplayNodes(); ++i)
    if (auto* display =
            vtkMRMLVolumeRenderingDisplayNode::SafeDownCast(volume->GetNthDisplayNode(i))) {
      if (display->GetVisibility())
        return display;
      first = first ? first : display;
    }
  return first;
}

/// File that is removed at the end of the scope, also after an exception.
struct ScopedFile {
  explicit ScopedFile(const std::filesystem::path& file) : path(file) {}
  ~ScopedFile() {
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
  }
  ScopedFile(const ScopedFile&) = delete;
  ScopedFile& operator=(const ScopedFile&) = delete;

  std::filesystem::path path;
};

/// Property of the last snapshot, kept because most snapshots differ only in the camera.
struct CachedProperty {
  vtkWeakPointer<vtkMRMLVolumePropertyNode> node;
  vtkMTimeType time = 0;
  std::string text, extension;
};

/// Reads the property from a file that Slicer writes, since Slicer's storage node knows all fields
/// of its version.
void TakeProperty(vtkMRMLVolumePropertyNode* property, const std::filesystem::path& folder,
                  SlicerExport::Contents& contents) {
  static CachedProperty cache; // used in the main thread only
  const vtkMTimeType time =
      std::max(property->GetMTime(), property->GetVolumeProperty()->GetMTime());
  if (cache.node == property && cache.time == time) {
    contents.property = cache.text;
    contents.propertyExtension = cache.extension;
    return;
  }
  vtkNew<vtkMRMLVolumePropertyNode> copy; // writing the original would mark it as saved
  copy->Copy(property);
  const auto storage =
      vtkSmartPointer<vtkMRMLStorageNode>::Take(property->CreateDefaultStorageNode());
  const std::string extension = std::string(".") + storage->GetDefaultWriteFileExtension();
  const ScopedFile file(folder / ("passing" + extension));
  storage->SetFileName(file.path.string().c_str());
  const bool written = storage->WriteData(copy) != 0;
  std::ostringstream text;
  text << std::ifstream(file.path, std::ios::binary).rdbuf();
  if (!written || text.str().empty())
    throw UserError("The volume rendering's settings could not be written to " +
                    file.path.string() + ".");
  contents.property = text.str();
  contents.propertyExtension = extension;
  cache = {property, time, contents.property, extension};
}

void TakeRoi(vtkMRMLVolumeRenderingDisplayNode* display, SlicerExport::Contents& contents) {
  auto* roi = vtkMRMLMarkupsROINode::SafeDownCast(display->GetROINode());
  if (!roi)
    throw UserError(
        "The volume rendering is cropped by a region of interest of an old type. Create "
        "a new one in the Volume Rendering module, or turn cropping off.");
  vtkMatrix4x4* axes = roi->GetObjectToWorldMatrix();
  double size[3];
  roi->GetSize(size);
  std::ostringstream text;
  text.precision(17);
  const auto addList = [&text](const char* name, std::initializer_list<double> values) {
    text << ",\"" << name << "\":[";
    const char* separator = "";
    for (const double value : values)
      text << separator << value, separator = ",";
    text << ']';
  };
  const auto element = [axes](int row, int column) { return axes->GetElement(row, column); };
  text << R"({"markups":[{"type":"ROI","coordinateSystem":"RAS","roiType":"Box")";
  addList("center", {element(0, 3), element(1, 3), element(2, 3)});
  addList("orientation", {element(0, 0), element(0, 1), element(0, 2), element(1, 0), element(1, 1),
                          element(1, 2), element(2, 0), element(2, 1), element(2, 2)});
  addList("size", {size[0], size[1], size[2]});
  text << ",\"insideOut\":" << (roi->GetInsideOut() ? "true" : "false") << "}]}";
  contents.crop.push_back({text.str(), SlicerExport::identity});
}

/// Labels converted from surfaces, kept because most snapshots differ only in other things.
struct CachedLabels {
  vtkWeakPointer<vtkSegmentation> source;
  vtkMTimeType time = 0;
  vtkSmartPointer<vtkSegmentation> converted;
};

/// Last change of the segments and of their representations.
vtkMTimeType GetLastChange(vtkSegmentation* segmentation) {
  vtkMTimeType time = segmentation->GetMTime();
  std::vector<std::string> ids, names;
  segmentation->GetSegmentIDs(ids);
  for (const std::string& id : ids) {
    vtkSegment* segment = segmentation->GetSegment(id);
    time = std::max(time, segment->GetMTime());
    segment->GetContainedRepresentationNames(names);
    for (const std::string& name : names)
      time = std::max(time, segment->GetRepresentation(name)->GetMTime());
  }
  return time;
}

/// Segmentation with binary labelmaps; if it has only surfaces, a converted copy.
vtkSmartPointer<vtkSegmentation> GetWithBinaryLabels(vtkMRMLSegmentationNode* node) {
  const std::string labels = vtkSegmentationConverter::GetBinaryLabelmapRepresentationName();
  vtkSmartPointer<vtkSegmentation> segmentation = node->GetSegmentation();
  if (segmentation->ContainsRepresentation(labels))
    return segmentation;
  static CachedLabels cache; // used in the main thread only
  const vtkMTimeType time = GetLastChange(segmentation);
  if (cache.source.GetPointer() == segmentation.GetPointer() && cache.time == time)
    return cache.converted;
  const auto copy = vtkSmartPointer<vtkSegmentation>::New();
  copy->DeepCopy(segmentation);
  if (!copy->CreateRepresentation(labels))
    throw UserError(Quote(node) +
                    " could not be converted to a labelmap. Create its binary labelmap in the "
                    "Segmentations module, then try again.");
  cache = {segmentation.GetPointer(), time, copy};
  return copy;
}

bool IsEmpty(vtkOrientedImageData* labels) {
  return !labels || labels->IsEmpty() || !labels->GetPointData()->GetScalars() ||
         labels->GetNumberOfPoints() == 0;
}

/// Tag of the segment's terminology entry, which identifies its anatomy.
std::string GetTerminologyTag(vtkSegment* segment) {
  std::string entry;
  if (!segment->GetTag(vtkSegment::GetTerminologyEntryTagName(), entry) || entry.empty())
    return {};
  return std::string(vtkSegment::GetTerminologyEntryTagName()) + ":" + entry + "|";
}

SlicerExport::Segment ToSegment(const std::string& id, vtkSegment* segment, size_t layer) {
  const double* color = segment->GetColor();
  return {id,
          segment->GetName() ? segment->GetName() : id,
          segment->GetLabelValue(),
          layer,
          GetTerminologyTag(segment),
          {color[0], color[1], color[2]}};
}

/// Layer on the grid of the first one; labels on another grid are resampled (nearest neighbor).
SlicerExport::Layer ToLayer(vtkOrientedImageData* labels, vtkOrientedImageData* first) {
  vtkSmartPointer<vtkOrientedImageData> image = labels;
  if (!vtkOrientedImageDataResample::DoGeometriesMatch(labels, first)) {
    constexpr bool linear = false, pad = true; // keeps labels outside the reference grid
    image = vtkSmartPointer<vtkOrientedImageData>::New();
    vtkOrientedImageDataResample::ResampleOrientedImageToReferenceOrientedImage(labels, first,
                                                                                image, linear, pad);
  }
  vtkNew<vtkMatrix4x4> ijkToRas;
  image->GetImageToWorldMatrix(ijkToRas);
  SlicerExport::Layer layer;
  layer.labels = ShareImage(image, ijkToRas);
  int extent[6];
  image->GetExtent(extent);
  layer.begin = {extent[0], extent[2], extent[4]};
  return layer;
}

} // namespace

void vtkSlicerFenestraSnapshot::TakeVolume(vtkMRMLScalarVolumeNode* volume,
                                           SlicerExport::Contents& contents) {
  if (!volume)
    throw UserError("There is no volume to render. Load one, or choose one above.");
  vtkImageData* image = volume->GetImageData();
  if (!image || !image->GetPointData()->GetScalars() || image->GetNumberOfPoints() == 0)
    throw UserError("The volume " + Quote(volume) + " has no voxels. Choose another one.");
  if (image->GetNumberOfScalarComponents() != 1)
    throw UserError("The volume " + Quote(volume) +
                    " has several components per voxel. Choose a scalar volume.");
  vtkNew<vtkMatrix4x4> ijkToRas;
  volume->GetIJKToRASMatrix(ijkToRas);
  contents.volume = ShareImage(image, ijkToRas);
  if (contents.volume.type.empty())
    throw UserError("The volume " + Quote(volume) +
                    " has an unknown voxel type. Convert it in the Cast Scalar Volume module.");
  contents.volumeKey = MakeKey(image, volume->GetID(), contents.volume);
  contents.volumeToWorld = GetWorldMatrix(volume);
}

void vtkSlicerFenestraSnapshot::TakeRendering(vtkMRMLScalarVolumeNode* volume,
                                              const std::filesystem::path& folder,
                                              SlicerExport::Contents& contents) {
  vtkMRMLVolumeRenderingDisplayNode* display = FindRenderingDisplay(volume);
  if (!display)
    return;
  if (vtkMRMLVolumePropertyNode* property = display->GetVolumePropertyNode())
    TakeProperty(property, folder, contents);
  if (display->GetCroppingEnabled() && display->GetROINode())
    TakeRoi(display, contents);
}

std::vector<SlicerExport::Segment>
vtkSlicerFenestraSnapshot::ListSegments(vtkMRMLSegmentationNode* node) {
  vtkSegmentation* segmentation = node->GetSegmentation();
  std::vector<std::string> ids;
  segmentation->GetSegmentIDs(ids);
  std::vector<SlicerExport::Segment> segments;
  for (const std::string& id : ids)
    segments.push_back(ToSegment(id, segmentation->GetSegment(id), 0));
  return segments;
}

void vtkSlicerFenestraSnapshot::TakeSegmentation(vtkMRMLSegmentationNode* node,
                                                 const std::vector<std::string>& focus,
                                                 SlicerExport::Contents& contents) {
  using SlicerExport::Segment;
  const vtkSmartPointer<vtkSegmentation> segmentation = GetWithBinaryLabels(node);
  const std::string name = vtkSegmentationConverter::GetBinaryLabelmapRepresentationName();
  SlicerExport::Segmentation& result = contents.segmentation;
  std::ostringstream key;
  key << node->GetID();
  vtkOrientedImageData* first = nullptr;
  for (int i = 0; i < segmentation->GetNumberOfLayers(name); ++i) {
    auto* labels = vtkOrientedImageData::SafeDownCast(segmentation->GetLayerDataObject(i, name));
    if (IsEmpty(labels))
      continue;
    first = first ? first : labels;
    for (const std::string& id : segmentation->GetSegmentIDsForLayer(i, name)) {
      result.segments.push_back(ToSegment(id, segmentation->GetSegment(id), result.layers.size()));
      const Segment& last = result.segments.back();
      key << '\n' << id << ' ' << last.label << ' ' << last.name << ' ' << last.tags;
      for (const double component : last.color)
        key << ' ' << component;
    }
    result.layers.push_back(ToLayer(labels, first));
    SlicerExport::Image own =
        result.layers.back().labels; // which may be resampled, to another array
    own.data = {own.data, labels->GetPointData()->GetScalars()->GetVoidPointer(0)};
    key << '\n' << MakeKey(labels, "", own);
  }
  for (const std::string& name : focus) { // scripts may pass names, the panel passes ids
    const std::string idByName = segmentation->GetSegmentIdBySegmentName(name);
    const std::string id = segmentation->GetSegment(name) ? name : idByName;
    const auto isEqual = [&id](const Segment& segment) { return segment.id == id; };
    vtkSegment* segment = segmentation->GetSegment(id);
    if (!segment)
      throw UserError("The segment \"" + name + "\" was removed. Choose another focus.");
    if (std::none_of(result.segments.begin(), result.segments.end(), isEqual))
      throw UserError("The segment \"" + std::string(segment->GetName()) +
                      "\" is empty. Paint it, or choose another focus.");
  }
  contents.segmentationKey = key.str();
  result.toWorld = GetWorldMatrix(node);
}
