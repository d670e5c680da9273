#include "program/ErrorAdvice.h"

#include "scene/Inspection.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

namespace fenestra::core {
namespace {

constexpr auto adviceTable = [] {
  using enum ErrorCode;
  return std::to_array<std::pair<ErrorCode, std::string_view>>({
      {ambiguousPreset, "choose one with --preset"},
      {ambiguousSegmentation,
       "choose one with --segmentation, by name or id, or a --focus that only one has"},
      {ambiguousVolume, "choose one with --volume, by name, id or number"},
      {angleOfOrthographicCamera, "use --scale, or add --projection perspective"},
      {assumedForm, "--nifti-form chooses the other for a volume"},
      {assumedFrame, "--frame N chooses another"},
      {conflictingLabels, "remove --labels"},
      {emptyImagePlane, "use a larger --scale, --angle or --size"},
      {emptyShapedFocus, "use a --margin closer to 0, or less --label-smoothing"},
      {excessiveExtinction, "reduce it, or --density-scale"},
      {focusOutsideImage, "change --view, --target or --scale"},
      {focusRequired, "add --focus, or change this field"},
      {foreignOutput, "move it away, or choose another --output"},
      {hiddenFocus, "choose another --focus or --view"},
      {implausibleModality, "move it with --transfer-shift, or choose another with --transfer"},
      {implausiblePresetModality, "--transfer names another"},
      {invalidCamera, "change --position, --target or --up"},
      {invalidSceneCamera, "give --view"},
      {largeShapedFocus, "choose a smaller --margin or --label-smoothing"},
      {missingTransferPoints, "save the volume property, or give --transfer"},
      {noMatchingPreset, "choose another --preset, or add --focus A,B,..."},
      {noVoxelToColor, "remove --materials"},
      {possibleHounsfieldOffset, "--transfer-shift 1024 adapts a CT transfer function"},
      {removedHounsfieldOffset, "--transfer-shift -1024 reverts this"},
      {removedTable, "--table keep shows it"},
      {scaleOfPerspectiveCamera, "use --angle, or add --projection orthographic"},
      {segmentationAsVolume, "give its volume, and this file as --segmentation"},
      {segmentationRequired, "give --segmentation FILE"},
      {spacingRequired, "give --spacing X,Y,Z in mm"},
      {tinyFocus, "use a larger --size, or a --view that frames the focus"},
      {tooManyMaterials, "assign one material to several with --materials FILE"},
      {transparentFocus, "choose another with --transfer or --preset"},
      {unknownForm, "give another --nifti-form, or none"},
      {unknownFrame, "give another --frame, or none"},
      {unknownLabelVersion, "give --labels totalsegmentator1 or totalsegmentator2"},
      {unmatchedLabels, "give the table of this label map as --labels"},
      {unnamedSegments, "--labels can name the values, and --focus takes values"},
      {unusedLabels, "--labels FILE forces its use"},
      {unusedSegmentation, "--focus NAME or --segmentation FILE uses it"},
  });
}();

} // namespace

std::string_view findAdvice(ErrorCode code) {
  const auto* const found =
      std::ranges::find(adviceTable, code, &std::pair<ErrorCode, std::string_view>::first);
  return found == adviceTable.end() ? std::string_view() : found->second;
}

std::string composeMessage(const Message& message) {
  const std::string_view advice = findAdvice(message.code);
  return advice.empty() ? message.text() : concat(message.text(), "; ", advice);
}

std::vector<std::string> composeMessages(const std::vector<Message>& messages) {
  std::vector<std::string> lines;
  std::ranges::transform(messages, std::back_inserter(lines), composeMessage);
  return lines;
}

void composeReport(nlohmann::ordered_json& report) {
  if (report.contains("detail"))
    report = composeMessage(report.get<Message>());
  else if (report.is_structured()) // iterating over any other value visits that value
    for (nlohmann::ordered_json& part : report)
      composeReport(part);
}

} // namespace fenestra::core
