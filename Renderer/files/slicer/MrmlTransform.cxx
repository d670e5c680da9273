// Transforms above nodes, and camera poses, which depend on them.

#include "files/slicer/MrmlScene.h"
#include "files/slicer/TransformFile.h"
#include "model/camera/Camera.h"

#include <algorithm>

namespace fenestra::core {
namespace {

constexpr std::size_t maxDepth = 1000; ///< maximum number of transforms above a node

/// Reads an invertible affine map from 16 numbers, row by row; nullopt: attribute missing. Throws
/// Error (input) for any other value.
std::optional<Affine> readMatrix(const MrmlScene& scene, const MrmlNode& node,
                                 const std::string& attribute) {
  if (!node.find(attribute))
    return std::nullopt;
  const auto numbers = node.numbers(attribute);
  const MakeError makeError =
      scene.document.bindError(node, attribute + ": ", "; fix it in the Transforms module");
  if (!numbers || numbers->size() != 16)
    throw makeError("must be 16 numbers");
  const auto row = [&numbers](std::size_t i) { // first three of the row's four numbers
    return Vec3((*numbers)[4 * i], (*numbers)[4 * i + 1], (*numbers)[4 * i + 2]);
  };
  if (row(3) != Vec3::Zero() || numbers->back() != 1.0)
    throw makeError("its last row must be 0 0 0 1");
  const Vec3 translation((*numbers)[3], (*numbers)[7], (*numbers)[11]);
  return checkAffine(Affine(Mat3::FromRows(row(0), row(1), row(2)), translation), makeError);
}

/// True if a node's file maps to the parent, as in some old scenes. Linear transforms stored that
/// attribute inverted (vtkMRMLLinearTransformNode::ReadXMLAttributes).
bool isFileToParent(const MrmlNode& node) {
  const std::string* value = node.find("readWriteAsTransformToParent");
  return value && (*value == "true") != (node.tag == "LinearTransform");
}

std::optional<Affine> readInlineMatrix(const MrmlScene& scene, const MrmlNode& node) {
  if (auto toParent = readMatrix(scene, node, "matrixTransformToParent"))
    return toParent;
  if (const auto fromParent = readMatrix(scene, node, "matrixTransformFromParent"))
    return fromParent->inverse();
  return std::nullopt;
}

std::variant<Affine, Error> tryReadTransform(MrmlScene& scene, const std::string& file) {
  try {
    return scene.files.read({file},
                            [](const auto& files) { return readLinearTransform(files.front()); });
  } catch (const Error& error) {
    return error;
  }
}

Affine loadTransform(MrmlScene& scene, const std::string& file) {
  auto known = scene.transformFiles.find(file);
  if (known == scene.transformFiles.end())
    known = scene.transformFiles.emplace(file, tryReadTransform(scene, file)).first;
  else if (scene.files.contains(file))
    scene.files.locate(file); // records that the scene uses the file
  if (const Error* error = std::get_if<Error>(&known->second))
    throw *error;
  return std::get<Affine>(known->second);
}

Affine toParent(MrmlScene& scene, const MrmlNode& node) {
  if (node.tag != "LinearTransform" && node.tag != "Transform")
    throw scene.document.error(
        node, "is not linear; harden it in Slicer (Transforms module), then save the scene");
  const auto matrix = readInlineMatrix(scene, node);
  const std::vector<std::string> names = listStorageFiles(scene, node);
  if (names.empty()) {
    if (!matrix)
      throw scene.document.error(node, "has neither a matrix nor a file; save the transform again");
    return *matrix;
  }
  const Affine stored = loadTransform(scene, names.front());
  return isFileToParent(node) ? stored : stored.inverse();
}

} // namespace

std::vector<std::string> listParentTransforms(const MrmlDocument& document, const MrmlNode& node) {
  std::vector<std::string> ids;
  for (const MrmlNode* above = document.follow(node, "transform");
       above && ids.size() < maxDepth && std::find(ids.begin(), ids.end(), above->id) == ids.end();
       above = document.follow(*above, "transform"))
    ids.push_back(above->id);
  return ids;
}

Affine toWorld(MrmlScene& scene, const MrmlNode& node) {
  Affine result = Affine::Identity();
  const MrmlNode* above = scene.document.follow(node, "transform");
  for (std::size_t level = 0; above; above = scene.document.follow(*above, "transform"), ++level) {
    if (level == maxDepth)
      throw scene.document.error(node, "the transforms above it form a loop, or too long a chain; "
                                       "fix them in the Transforms module");
    result = toParent(scene, *above) * result;
  }
  return checkAffine(result,
                     scene.document.bindError(node, "the product of the transforms above it ",
                                              "; fix them in the Transforms module"));
}

CameraPose readSceneCamera(MrmlScene& scene, const MrmlNode& camera) {
  const auto triple = [&](const std::string& attribute) {
    if (const auto numbers = camera.triple(attribute))
      return *numbers;
    throw scene.document.error(camera, attribute + ": must be three numbers",
                               ErrorCode::invalidSceneCamera);
  };
  const auto number = [&](const std::string& attribute, double fallback, double maxValue) {
    const double number =
        camera.number(attribute).value_or(camera.find(attribute) ? 0.0 : fallback);
    if (!(number > 0.0 && number <= maxValue))
      throw scene.document.error(camera, attribute + ": is out of range",
                                 ErrorCode::invalidSceneCamera);
    return number;
  };
  CameraPose pose;
  pose.projection = camera.boolean("parallelProjection", false) ? Projection::orthographic
                                                                : Projection::perspective;
  pose.position = triple("position");
  pose.target = triple("focalPoint");
  pose.up = triple("viewUp");
  pose.scale = number("parallelScale", pose.scale, 1e9);
  pose.angle = number("viewAngle", pose.angle, 179.0);

  // The stored pose is in world space and includes `appliedTransform`. Only changes of the camera's
  // transform since then still move the camera (vtkMRMLCameraNode::TransformPoints).
  if (camera.references.contains("transform")) {
    const Affine applied =
        readMatrix(scene, camera, "appliedTransform").value_or(Affine::Identity());
    const Affine change = toWorld(scene, camera) * applied.inverse();
    pose.position = change * pose.position;
    pose.target = change * pose.target;
    pose.up = change.linear() * pose.up;
  }
  return validatePose(pose, scene.document.bindError(camera, "has a bad pose: ", "",
                                                     ErrorCode::invalidSceneCamera));
}

} // namespace fenestra::core
