#include "files/segments/MaskFolder.h"

#include "base/Text.h"
#include "files/medical/DicomReader.h"
#include "files/medical/MedicalHeader.h"
#include "files/medical/NiftiForms.h"
#include "files/segments/LabelSearch.h"
#include "files/segments/MaskPacking.h"
#include "io/InputRegistry.h"
#include "io/MessageText.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

namespace fenestra::core {
namespace {

namespace fs = std::filesystem;
using Paths = std::vector<fs::path>;

Paths selectVolumeFiles(Paths files) {
  std::erase_if(files, [](const fs::path& file) {
    return file.filename().string().starts_with('.') || !findMedicalFormat(file) ||
           findNiftiFiles(file).header != file; // a pair is read by its header
  });
  return files;
}

Error makeNoMasksError(const fs::path& folder) {
  const auto [files, folders] = listFolder(folder);
  if (std::ranges::any_of(files, isDicomFile))
    return inputError(ErrorCode::unsupportedFile, folder,
                      "is a folder of DICOM files, not of masks; name its SEG or RTSTRUCT file");
  std::string hint = "give a folder with one structure per file (.nii.gz, .nii, .nrrd, .mha), as "
                     "TotalSegmentator writes it";
  for (const fs::path& subfolder : folders)
    if (!selectVolumeFiles(listFolder(subfolder).files).empty()) {
      hint = "give its folder " + toOneLine(subfolder.filename().string());
      break;
    }
  return inputError(ErrorCode::unsupportedFile, folder, "is a folder without masks; ", hint);
}

/// Volume files of the folder. Throws Error (input) if there are none, or too many.
Paths requireMaskFiles(const fs::path& folder) {
  constexpr std::size_t maxFiles = 4096;
  Paths files = listMaskFiles(folder);
  if (files.empty())
    throw makeNoMasksError(folder);
  if (files.size() > maxFiles)
    throw inputError(ErrorCode::limitExceeded, folder, "has more than ", maxFiles,
                     " volume files; give a folder of masks");
  registerInput(folder);
  return files;
}

/// Segments by file; the id is the name unless several files have it.
std::vector<SegmentInfo> makeSegments(const Paths& files) {
  std::vector<SegmentInfo> segments;
  std::multiset<std::string> names;
  for (const fs::path& file : files) {
    std::string name = stripExtensions(file).filename().string();
    if (name.ends_with(".seg"))
      name.erase(name.size() - 4);
    names.insert(name);
    segments.push_back(
        {.id = name, .name = name, .labelValue = static_cast<std::int32_t>(segments.size() + 1)});
  }
  for (std::size_t i = 0; i < files.size(); ++i)
    if (names.count(segments[i].name) > 1)
      segments[i].id = files[i].filename().string();
  return segments;
}

/// Reads the files in parallel. Warns once about each problem of the geometry, and about each file
/// that is no mask.
std::vector<NamedMask> readMasks(const fs::path& folder, const Grid* reference,
                                 std::vector<Message>& warnings) {
  const Paths files = requireMaskFiles(folder);
  const std::vector<SegmentInfo> segments = makeSegments(files);
  std::vector<std::optional<MaskRuns>> read(files.size());
  std::vector<Message> problems(files.size());
  tbb::parallel_for(std::size_t{0}, files.size(), [&](std::size_t i) {
    try {
      read[i] = readMask(files[i], chooseFormByVolume(files[i], reference));
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::input || error.message().code == ErrorCode::outOfMemory)
        throw;
      problems[i] = error.message();
    }
  });
  std::vector<NamedMask> masks;
  std::set<std::string> known;
  for (std::size_t i = 0; i < files.size(); ++i) {
    if (!read[i]) {
      problems[i].detail += " (it is left out)";
      warnings.push_back(problems[i]);
      continue;
    }
    for (const Message& warning : read[i]->warnings)
      if (known.insert(warning.detail).second)
        warnings.push_back(warning);
    masks.push_back({segments[i], std::move(*read[i])});
  }
  if (masks.empty())
    throw inputError(ErrorCode::unsupportedFile, folder,
                     "is a folder without masks: ", warnings.front().subject, ' ',
                     warnings.front().detail);
  return masks;
}

} // namespace

Paths listMaskFiles(const fs::path& folder) {
  return selectVolumeFiles(listFolder(folder).files);
}

std::vector<SegmentInfo> readMaskFolderInfos(const fs::path& folder) {
  return makeSegments(requireMaskFiles(folder));
}

Segmentation readMaskFolder(const fs::path& folder, const Grid* reference) {
  std::vector<Message> warnings;
  std::vector<NamedMask> masks = readMasks(folder, reference, warnings);
  Segmentation all = packMasks(folder.string(), std::move(masks));
  all.addWarnings(warnings);
  return all;
}

} // namespace fenestra::core
