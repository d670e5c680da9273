// Reads crop boxes of every MRML version: markups, annotations, and the first ROI nodes.

#include "files/slicer/MrmlScene.h"
#include "io/InputRegistry.h"
#include "io/JsonNode.h"

namespace fenestra::core {
namespace {

constexpr double maxLength = 1e9; ///< mm

/// Map from [-1, 1]^3 to a box with `halfEdges` along the columns of `axes`. Throws for a flat box.
Affine makeBoxMap(const Vec3& center, const Mat3& axes, const Vec3& halfEdges,
                  const MakeError& makeError) {
  if (!(halfEdges.array() > 0.0).all())
    throw makeError("its size must be above 0 along every axis; fix it in the Markups module");
  if (!(std::abs(axes.determinant()) > 1e-6))
    throw makeError("its axes are linearly dependent; fix it in the Markups module");
  return Affine(axes * Mat3::Diagonal(halfEdges), center);
}

void rejectInsideOut(bool insideOut, const MakeError& makeError) {
  if (insideOut)
    throw makeError("is inside out, which crops everything in Slicer, too; switch that off in the "
                    "Markups module");
}

// ---- .mrk.json

bool isLps(const JsonNode& markup) {
  const auto system = markup.find("coordinateSystem");
  if (!system)
    return true;          // Slicer's default
  if (system->isNumber()) // the first version: vtkMRMLStorageNode's enumeration
    return system->number() != 0.0;
  return system->choice({"LPS", "RAS"}) == 0;
}

Affine readMarkupsJson(const std::filesystem::path& path) {
  const std::string source = path.string();
  const nlohmann::json document = parseJson(readText(path), source);
  const JsonNode markups = JsonNode(document, source).at("markups");
  const std::vector<JsonNode> elements = markups.elements();
  if (elements.empty())
    throw markups.error("is empty; save the region of interest again");
  const JsonNode& roi = elements.front();
  const auto makeError = [&roi](const std::string& what) { return roi.error(what); };
  if (roi.at("type").text() != "ROI")
    throw roi.at("type").error("must be \"ROI\"; give a region of interest");
  if (const auto insideOut = roi.find("insideOut"))
    rejectInsideOut(insideOut->boolean(), makeError);

  const Vec3 center = roi.at("center").triple(-maxLength, maxLength);
  Mat3 axes = Mat3::Identity();
  const bool lps = isLps(roi);
  if (const auto orientation = roi.find("orientation")) {
    const auto numbers = orientation->numbers(9, -maxLength, maxLength);
    const auto row = [&numbers](std::size_t i) {
      return Vec3(numbers[i], numbers[i + 1], numbers[i + 2]);
    };
    axes = Mat3::FromRows(row(0), row(3), row(6));
  }
  const Affine box =
      makeBoxMap(center, axes, 0.5 * roi.at("size").triple(-maxLength, maxLength), makeError);
  return lps ? Affine(lpsToRas) * box : box;
}

// ---- older versions: center and half edges, RAS

Affine makeAlignedBox(const std::vector<double>& centerAndRadius, const MakeError& makeError) {
  if (centerAndRadius.size() != 6)
    throw makeError("needs a center and a radius, three numbers each; save it again");
  const std::vector<double>& n = centerAndRadius;
  return makeBoxMap({n[0], n[1], n[2]}, Mat3::Identity(), {n[3], n[4], n[5]}, makeError);
}

/// Reads an annotation file: two lines "point|x|y|z|...".
Affine readAnnotation(const std::filesystem::path& path) {
  const auto makeError = [&path](const std::string& what) { return inputError(path, what); };
  std::vector<double> numbers;
  for (const std::string& line : split(readText(path), '\n')) {
    const std::vector<std::string> cells = split(line, '|');
    if (cells.empty() || cells[0] != "point")
      continue;
    for (std::size_t axis = 1; axis < std::min<std::size_t>(4, cells.size()); ++axis) {
      const auto number = parseNumbers(cells[axis]);
      if (!number || number->size() != 1)
        throw makeError("point: must have three numbers; save it again");
      numbers.push_back(number->front());
    }
  }
  return makeAlignedBox(numbers, makeError);
}

Affine readInlineRoi(const MrmlScene& scene, const MrmlNode& roi) {
  std::string text = roi.text("ctrlPtsCoord"); // "x y z|x y z"
  if (text.empty())                            // of the two spellings, one is missing
    text = roi.text("xyz") + roi.text("XYZ") + " " + roi.text("radiusXYZ") + roi.text("RadiusXYZ");
  std::replace(text.begin(), text.end(), '|', ' ');
  return makeAlignedBox(parseNumbers(text).value_or(std::vector<double>()),
                        scene.document.bindError(roi));
}

Affine readBox(MrmlScene& scene, const MrmlNode& roi) {
  rejectInsideOut(roi.boolean("insideOut", false), scene.document.bindError(roi));
  const std::vector<std::string> names = listStorageFiles(scene, roi);
  if (names.empty())
    return readInlineRoi(scene, roi);
  return scene.files.read({names.front()}, [](const auto& files) {
    const std::filesystem::path& file = files.front();
    return lowercaseExtension(file) == ".acsv" ? readAnnotation(file) : readMarkupsJson(file);
  });
}

} // namespace

CropBox readSceneRoi(MrmlScene& scene, const MrmlNode& roi) {
  return CropBox(checkAffine(
      toWorld(scene, roi) * readBox(scene, roi),
      scene.document.bindError(roi, "its world transform ", "; fix it in the Markups module")));
}

} // namespace fenestra::core
