#include "phantoms/PhantomScene.h"

#include "base/TextStream.h"
#include "base/safe/Mark.h"
#include "files/looks/PropertyWriter.h"

#include <nlohmann/json.hpp>
#include <pugixml.hpp>

#include <cstdlib>
#include <new>

namespace fenestra {

namespace {

using Attributes = std::vector<std::pair<const char*, std::string>>;

constexpr const char* volumeId = "vtkMRMLScalarVolumeNode1";
constexpr const char* volumeDisplayId = "vtkMRMLScalarVolumeDisplayNode1";
constexpr const char* volumeStorageId = "vtkMRMLVolumeArchetypeStorageNode1";
constexpr const char* segmentationId = "vtkMRMLSegmentationNode1";
constexpr const char* segmentationDisplayId = "vtkMRMLSegmentationDisplayNode1";
constexpr const char* segmentationStorageId = "vtkMRMLSegmentationStorageNode1";
constexpr const char* renderingId = "vtkMRMLGPURayCastVolumeRenderingDisplayNode1";
constexpr const char* propertyId = "vtkMRMLVolumePropertyNode1";
constexpr const char* propertyStorageId = "vtkMRMLVolumePropertyStorageNode1";
constexpr const char* roiId = "vtkMRMLMarkupsROINode1";
constexpr const char* roiDisplayId = "vtkMRMLMarkupsROIDisplayNode1";
constexpr const char* roiStorageId = "vtkMRMLMarkupsROIJsonStorageNode1";
constexpr const char* viewId = "vtkMRMLViewNode1";
constexpr const char* cameraId = "vtkMRMLCameraNode1";
constexpr const char* roiName = "Volume rendering ROI";

/// Numbers as Slicer writes them: a stream's six digits, separated by blanks.
template <typename... Numbers>
std::string text(const Numbers&... numbers) {
  TextWriter stream;
  const char* separator = "";
  ((stream << separator << numbers, separator = " "), ...);
  return stream.str();
}
std::string text(const Vec3& v) {
  return text(v.x(), v.y(), v.z());
}

pugi::xml_node addNode(pugi::xml_node scene, const char* tag, const char* id,
                       const std::string& name, bool hidden) {
  pugi::xml_node node = scene.append_child(tag);
  node.append_attribute("id") = id;
  node.append_attribute("name") = name.c_str();
  node.append_attribute("hideFromEditors") = hidden;
  node.append_attribute("selectable") = true;
  node.append_attribute("selected") = false;
  return node;
}

void set(pugi::xml_node node, const Attributes& attributes) {
  for (const auto& [name, value] : attributes)
    node.append_attribute(name) = value.c_str();
}

/// Makes pugixml throw std::bad_alloc. Otherwise it drops attributes for want of memory, and
/// returns that in results that nobody checks.
void throwWithoutMemory() {
  const auto allocate = [](std::size_t size) {
    void* const memory = std::malloc(size);
    return memory ? memory : throw std::bad_alloc();
  };
  pugi::set_memory_management_functions(allocate, std::free);
}

std::string reference(const char* role, const std::string& ids) {
  return std::string(role) + ":" + ids + ";";
}

/// Sets what vtkMRMLDisplayNode writes for every display node; `colors`: id of a colour table;
/// null: none.
void setDisplay(pugi::xml_node node, const char* color, const char* visibility,
                const char* visibility2D, const char* view = "", const char* colors = nullptr) {
  set(node, {{"color", color},
             {"edgeColor", "0 0 0"},
             {"selectedColor", "1 0 0"},
             {"selectedAmbient", "0.4"},
             {"ambient", "0"},
             {"diffuse", "1"},
             {"selectedSpecular", "0.5"},
             {"specular", "0"},
             {"power", "1"},
             {"metallic", "0"},
             {"roughness", "0.5"},
             {"opacity", "1"},
             {"sliceIntersectionOpacity", "1"},
             {"pointSize", "1"},
             {"lineWidth", "1"},
             {"representation", "2"},
             {"lighting", "true"},
             {"interpolation", "1"},
             {"shading", "true"},
             {"visibility", visibility},
             {"visibility2D", visibility2D},
             {"visibility3D", "true"},
             {"edgeVisibility", "false"},
             {"clipping", "false"},
             {"sliceIntersectionThickness", "1"},
             {"frontfaceCulling", "false"},
             {"backfaceCulling", "false"},
             {"scalarVisibility", "false"},
             {"vectorVisibility", "false"},
             {"tensorVisibility", "false"},
             {"interpolateTexture", "false"},
             {"scalarRangeFlag", "UseData"},
             {"scalarRange", "0 100"}});
  if (colors)
    set(node, {{"colorNodeID", colors}});
  set(node, {{"activeAttributeLocation", "point"},
             {"viewNodeRef", view},
             {"folderDisplayOverrideAllowed", "true"}});
}

constexpr const char* defaultColor = "0.9 0.9 0.3";

pugi::xml_node addStorage(pugi::xml_node scene, const char* tag, const char* id,
                          const std::string& file, const char* extension) {
  pugi::xml_node node = addNode(scene, tag, id, tag, true);
  set(node, {{"fileName", urlEncoded(file)},
             {"useCompression", "1"},
             {"defaultWriteFileExtension", extension},
             {"readState", "0"},
             {"writeState", "4"}});
  return node;
}

/// Pose of a parallel camera that frames the volume's box in a square, with a margin of a
/// twentieth.
struct Framing {
  Vec3 backward, up;
  double scale; ///< half the height, mm

  explicit Framing(const Phantom& phantom)
      : backward(phantom.towardViewer.normalized()), up(Vec3::UnitZ()), scale(0.0) {
    const Vec3 right = Vec3::UnitZ().cross(backward).normalized();
    up = backward.cross(right);
    const Grid& grid = phantom.volume.grid;
    for (int i = 0; i < 8; ++i) {
      const Vec3 offset = grid.worldCorner(i) - grid.worldCenter();
      scale =
          std::max({scale, 1.05 * std::abs(offset.dot(up)), 1.05 * std::abs(offset.dot(right))});
    }
  }
};

/// Adds a view and its camera, paired by their singleton tag, which is the layout's name for them.
/// Slicer makes the camera parallel by the view's render mode, and then takes its scale from the
/// view's field of view (vtkMRMLViewDisplayableManager::UpdateRenderMode).
void addView(pugi::xml_node scene, const Framing& framing) {
  pugi::xml_node view = addNode(scene, "View", viewId, "View1", false);
  set(view, {{"singletonTag", "1"},
             {"attributes", "MappedInLayout:1"},
             {"layoutLabel", "1"},
             {"layoutName", "1"},
             {"active", "false"},
             {"visibility", "true"},
             {"backgroundColor", "0.756863 0.764706 0.909804"},
             {"backgroundColor2", "0.454902 0.470588 0.745098"},
             {"layoutColor", "0.454902 0.513725 0.913725"},
             {"orientationMarkerType", "none"},
             {"orientationMarkerSize", "medium"},
             {"rulerType", "none"},
             {"rulerColor", "white"},
             {"AxisLabels", "L;R;P;A;I;S"},
             {"fieldOfView", text(framing.scale)},
             {"letterSize", "0.05"},
             {"boxVisible", "true"},
             {"boxColor", "1 0 1"},
             {"fiducialsVisible", "true"},
             {"fiducialLabelsVisible", "true"},
             {"axisLabelsVisible", "true"},
             {"axisLabelsCameraDependent", "true"},
             {"animationMode", "Off"},
             {"viewAxisMode", "LookFrom"},
             {"spinDegrees", "2"},
             {"spinMs", "5"},
             {"spinDirection", "YawLeft"},
             {"rotateDegrees", "5"},
             {"rockLength", "200"},
             {"rockCount", "0"},
             {"stereoType", "NoStereo"},
             {"renderMode", "Orthographic"},
             {"useDepthPeeling", "1"},
             {"gpuMemorySize", "0"},
             {"autoReleaseGraphicsResources", "false"},
             {"expectedFPS", "8"},
             {"volumeRenderingQuality", "Normal"},
             {"raycastTechnique", "Composite"},
             {"volumeRenderingSurfaceSmoothing", "0"},
             {"volumeRenderingOversamplingFactor", "2"},
             {"linkedControl", "0"}});
}

void addCamera(pugi::xml_node scene, const Grid& grid, const Framing& framing) {
  const Vec3 center = grid.worldCenter();
  const double distance = 4.0 * grid.boundingRadius();
  const auto rounded = [&](const Vec3& v) { // no 1e-17 where 0 is meant
    return Vec3(v.unaryExpr([&](double x) { return std::abs(x) < 1e-9 * distance ? 0.0 : x; }));
  };
  pugi::xml_node camera = addNode(scene, "Camera", cameraId, "Camera", false);
  set(camera, {{"singletonTag", "1"},
               {"userTags", ""},
               {"position", text(rounded(center + distance * framing.backward))},
               {"focalPoint", text(rounded(center))},
               {"viewUp", text(framing.up)},
               {"parallelProjection", "true"},
               {"parallelScale", text(framing.scale)},
               {"viewAngle", "30"},
               {"appliedTransform", "1 0 0 0  0 1 0 0  0 0 1 0  0 0 0 1"}});
}

void addVolume(pugi::xml_node scene, const Phantom& phantom, const std::string& name,
               const std::string& file) {
  const Volume& volume = phantom.volume;
  pugi::xml_node display = addNode(scene, "VolumeDisplay", volumeDisplayId, "VolumeDisplay", true);
  setDisplay(display, defaultColor, "true", "false", "", "vtkMRMLColorTableNodeGrey");
  set(display, {{"window", text(volume.maximum - volume.minimum)},
                {"level", text(0.5 * (volume.maximum + volume.minimum))},
                {"upperThreshold", "32767"},
                {"lowerThreshold", "-32768"},
                {"interpolate", "1"},
                {"windowLevelLocked", "false"},
                {"autoWindowLevel", "1"},
                {"applyThreshold", "0"},
                {"autoThreshold", "0"}});
  pugi::xml_node storage =
      addStorage(scene, "VolumeArchetypeStorage", volumeStorageId, file, "nrrd");
  set(storage, {{"centerImage", "0"}, {"UseOrientationFromFile", "1"}});

  const Grid& grid = volume.grid;
  const Mat3 directions = grid.indexToWorld.linear().normalizedColumns() + Mat3::Zero(); // no "-0"
  std::string directionsText;
  for (int row = 0; row < 3; ++row)
    directionsText += text(directions.row(row)) + " ";
  pugi::xml_node node = addNode(scene, "Volume", volumeId, name, false);
  set(node, {{"references", reference("display", std::string(volumeDisplayId) + " " + renderingId) +
                                reference("storage", volumeStorageId)},
             {"userTags", ""},
             {"spacing", text(grid.spacing())},
             {"origin", text(Vec3(grid.indexToWorld.translation()))},
             {"voxelVectorType", "undefined"},
             {"ijkToRASDirections", directionsText}});
}

/// Adds the segmentation, with both names of the source representation: "Master" until 5.2,
/// "Source" since.
void addSegmentation(pugi::xml_node scene, const Phantom& phantom, const std::string& name,
                     const std::string& file) {
  std::string properties;
  for (const PhantomSegment& segment : phantom.segments)
    properties += urlEncoded(segment.id) +
                  " OverrideColorR:-1 OverrideColorG:-1 OverrideColorB:-1 Visible:true "
                  "Visible3D:true Visible2DFill:true Visible2DOutline:true Opacity3D:1 "
                  "Opacity2DFill:1 Opacity2DOutline:1|";
  pugi::xml_node display =
      addNode(scene, "SegmentationDisplay", segmentationDisplayId, "SegmentationDisplay", true);
  setDisplay(display, defaultColor, "true", "true");
  set(display, {{"PreferredDisplayRepresentationName2D", ""},
                {"PreferredDisplayRepresentationName3D", ""},
                {"Visibility2DFill", "true"},
                {"Visibility2DOutline", "true"},
                {"Opacity3D", "1"},
                {"Opacity2DFill", "0.5"},
                {"Opacity2DOutline", "1"},
                {"SegmentationDisplayProperties", properties}});
  pugi::xml_node storage =
      addStorage(scene, "SegmentationStorage", segmentationStorageId, file, "seg.nrrd");
  set(storage, {{"CropToMinimumExtent", "false"}});
  pugi::xml_node node = addNode(scene, "Segmentation", segmentationId, name + " segments", false);
  set(node, {{"references", reference("display", segmentationDisplayId) +
                                reference("storage", segmentationStorageId)},
             {"userTags", ""},
             {"MasterRepresentationName", "Binary labelmap"},
             {"SourceRepresentationName", "Binary labelmap"},
             {"segmentListFilterEnabled", "false"},
             {"segmentListFilterOptions", ""}});
}

/// Adds the rendering. The property's functions stand in the scene, where 5.2 writes them, and in a
/// .vp, the one file of a property that all versions read.
void addRendering(pugi::xml_node scene, const Phantom& phantom, const std::string& name,
                  const std::string& file) {
  pugi::xml_node display =
      addNode(scene, "GPURayCastVolumeRendering", renderingId, "VolumeRendering", true);
  set(display, {{"references", reference("roi", roiId) + reference("volumeProperty", propertyId)}});
  setDisplay(display, defaultColor, "true", "false", viewId);
  set(display, {{"croppingEnabled", "0"},
                {"threshold", "0 1"},
                {"windowLevel", "0 0"},
                {"followVolumeDisplayNode", "0"},
                {"ignoreVolumeDisplayNodeThreshold", "0"},
                {"useSingleVolumeProperty", "0"}});

  const VolumeProperty& property = phantom.property;
  const PropertyTexts texts = propertyTexts(property);
  pugi::xml_node node = addNode(scene, "VolumeProperty", propertyId, name + " property", false);
  set(node, {{"references", reference("storage", propertyStorageId)},
             {"userTags", ""},
             {"interpolation", "1"},
             {"shade", property.shade ? "1" : "0"},
             {"diffuse", text(property.diffuse)},
             {"ambient", text(ambientLight)},
             {"specular", text(property.specular)},
             {"specularPower", text(property.specularPower)},
             {"scalarOpacity", texts.scalarOpacity},
             {"gradientOpacity", texts.gradientOpacity},
             {"colorTransfer", texts.color},
             {"effectiveRange", text(phantom.volume.minimum, phantom.volume.maximum)}});
  addStorage(scene, "VolumePropertyStorage", propertyStorageId, file, "vp");
}

void addRoi(pugi::xml_node scene, const Phantom& phantom, const std::string& file) {
  pugi::xml_node node = addNode(scene, "MarkupsROI", roiId, roiName, false);
  const Vec3 center = phantom.volume.grid.worldCenter();
  const std::string handles = "1 0 0 " + text(center.x()) + "  0 1 0 " + text(center.y()) +
                              "  0 0 1 " + text(center.z()) + "  0 0 0 1";
  set(node,
      {{"references", reference("display", roiDisplayId) + reference("storage", roiStorageId)},
       {"userTags", ""},
       {"locked", "false"},
       {"controlPointLabelFormat", "%N-%d"},
       {"interactionHandleToWorldMatrix", handles}});
  pugi::xml_node display =
      addNode(scene, "MarkupsROIDisplay", roiDisplayId, "MarkupsROIDisplay", true);
  setDisplay(display, "0.4 1 1", "false", "true");
  set(display, {{"propertiesLabelVisibility", "true"},
                {"pointLabelsVisibility", "false"},
                {"textScale", "3"},
                {"glyphScale", "3"},
                {"glyphSize", "5"},
                {"useGlyphScale", "true"},
                {"glyphType", "Sphere3D"},
                {"snapMode", "toVisibleSurface"},
                {"handlesInteractive", "true"},
                {"fillVisibility", "false"},
                {"outlineVisibility", "true"},
                {"activeColor", "0.4 1 0"}});
  pugi::xml_node storage =
      addStorage(scene, "MarkupsROIJsonStorage", roiStorageId, file, "mrk.json");
  set(storage, {{"coordinateSystem", "LPS"}});
}

} // namespace

std::string phantomScene(const Phantom& phantom, const std::string& name,
                         const PhantomFileNames& files) {
  throwWithoutMemory();
  pugi::xml_document document;
  pugi::xml_node declaration = document.append_child(pugi::node_declaration);
  set(declaration, {{"version", "1.0"}, {"encoding", "UTF-8"}});
  pugi::xml_node scene = document.append_child("MRML");
  set(scene, {{"version", "Slicer 5.2.2 31383"}, {"userTags", ""}});
  const Framing framing(phantom);
  addView(scene, framing);
  addCamera(scene, phantom.volume.grid, framing);
  addVolume(scene, phantom, name, files.volume);
  addSegmentation(scene, phantom, name, files.segmentation);
  addRendering(scene, phantom, name, files.property);
  addRoi(scene, phantom, files.roi);
  document.append_child(pugi::node_comment)
      .set_value((" " + std::string(unsealedMark) + " ").c_str());
  TextWriter stream;
  document.save(stream, " ");
  return sealed(stream.str());
}

std::string phantomRoi(const Phantom& phantom) {
  using Json = nlohmann::ordered_json;
  const Grid& grid = phantom.volume.grid;
  const Mat3 axes =
      (lpsToRas * grid.indexToWorld.linear()).normalizedColumns() + Mat3::Zero(); // no "-0"
  const Vec3 center = (lpsToRas * grid.worldCenter()).array() + 0.0;
  const Vec3 size = grid.spacing().cwiseProduct(grid.size.cast<double>());
  Json orientation = Json::array();
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      orientation.push_back(axes(row, column));
  const Json place = {center.x(), center.y(), center.z()};
  const Json point = {{"id", "1"},          {"label", std::string(roiName) + "-1"},
                      {"description", ""},  {"associatedNodeID", ""},
                      {"position", place},  {"orientation", orientation},
                      {"selected", true},   {"locked", false},
                      {"visibility", true}, {"positionStatus", "defined"}};
  const Json markup = {{"type", "ROI"},
                       {"coordinateSystem", "LPS"},
                       {"coordinateUnits", "mm"},
                       {"locked", false},
                       {"fixedNumberOfControlPoints", false},
                       {"labelFormat", "%N-%d"},
                       {"lastUsedControlPointNumber", 1},
                       {"roiType", "Box"},
                       {"center", place},
                       {"orientation", orientation},
                       {"size", {size.x(), size.y(), size.z()}},
                       {"insideOut", false},
                       {"controlPoints", Json::array({point})},
                       {"measurements", Json::array()},
                       {"display", {{"visibility", false}, {"color", {0.4, 1.0, 1.0}}}}};
  const Json file = {{"@schema",
                      "https://raw.githubusercontent.com/slicer/slicer/master/Modules/Loadable/"
                      "Markups/Resources/Schema/markups-schema-v1.0.3.json#"},
                     {"generator", unsealedMark},
                     {"markups", Json::array({markup})}};
  return sealed(file.dump(4) + "\n");
}

std::string urlEncoded(const std::string& text) {
  TextWriter encoded;
  encoded << std::hex << std::uppercase;
  for (const char c : text) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    if (plain || std::string("-_./").find(c) != std::string::npos)
      encoded << c;
    else
      encoded << '%' << (static_cast<unsigned char>(c) >> 4)
              << (static_cast<unsigned char>(c) & 15);
  }
  return encoded.str();
}

} // namespace fenestra
