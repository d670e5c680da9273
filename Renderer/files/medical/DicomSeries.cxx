#include "files/medical/DicomSeries.h"

#include "base/Error.h"
#include "files/medical/DicomReader.h"
#include "io/InputRegistry.h"
#include "io/MessageText.h"

#include <algorithm>
#include <map>
#include <tuple>

namespace fenestra {
namespace {

namespace fs = std::filesystem;
using Path = fs::path;
using Paths = std::vector<Path>;

/// Files in the folder; if there are none, those in its subfolders. Registers them as inputs.
Paths listCandidates(const Path& folder) {
  auto [files, folders] = listFolder(folder);
  if (files.empty())
    for (const Path& subfolder : folders)
      std::ranges::move(listFolder(subfolder).files, std::back_inserter(files));
  for (const Path& file : files)
    requireFile(file, "give only the folder");
  return files;
}

std::string describeSeries(const DicomSeries& series) {
  std::string text = series.number.empty() ? "" : "number " + sanitize(series.number) + " ";
  if (!series.description.empty())
    text += "\"" + sanitize(series.description) + "\" ";
  text += series.modality.empty() ? "" : sanitize(series.modality) + " ";
  const std::size_t count = series.files.size();
  return concat(text, sanitize(series.uid), " (", count, count == 1 ? " file)" : " files)");
}

std::string formatSeries(const std::vector<DicomSeries>& series) {
  constexpr std::size_t maxListed = 40;
  return join(series, "; ", describeSeries, maxListed);
}

} // namespace

std::vector<DicomSeries> findDicomSeries(const Path& folder) {
  DicomReader files;
  std::map<std::string, DicomSeries> byUid;
  for (const Path& file : listCandidates(folder)) {
    const auto header = files.readHeader(file);
    const bool isVolume = header && header->modality != "SEG"; // a segmentation has pixels, too
    if (!isVolume || header->seriesUid.empty() || (header->isComplete && !isImage(*header)))
      continue;
    DicomSeries& series = byUid[header->seriesUid];
    if (series.files.empty())
      series = {
          header->seriesUid, header->seriesNumber, header->seriesDescription, header->modality, {}};
    series.files.push_back(file);
  }
  if (byUid.empty())
    throw inputError(ErrorCode::unsupportedFile, folder,
                     "folder has no DICOM image series; give one that does, or a volume file");
  std::vector<DicomSeries> all;
  for (auto& [uid, series] : byUid)
    all.push_back(std::move(series));
  std::ranges::sort(all, {}, [](const DicomSeries& series) { // shorter first: numeric order
    return std::tuple(series.number.size(), series.number, series.uid);
  });
  return all;
}

DicomSeries chooseSeries(const std::vector<DicomSeries>& series,
                         const std::optional<std::string>& selector, const std::string& folder) {
  if (!selector && series.size() == 1)
    return series.front();
  if (!selector)
    throw inputError(ErrorCode::ambiguousVolume, folder, "has ", series.size(),
                     " DICOM series: ", formatSeries(series));
  for (const auto field : {&DicomSeries::uid, &DicomSeries::number, &DicomSeries::description}) {
    std::vector<DicomSeries> found;
    std::ranges::copy_if(series, std::back_inserter(found),
                         [&](const DicomSeries& one) { return one.*field == *selector; });
    if (found.size() == 1)
      return found.front();
    if (found.size() > 1)
      throw inputError(ErrorCode::ambiguousName, folder, "\"", sanitize(*selector),
                       "\" matches several: ", formatSeries(found), "; choose one by its uid");
  }
  throw inputError(ErrorCode::unknownName, folder, "\"", sanitize(*selector),
                   "\" matches no DICOM series; it has ", formatSeries(series));
}

} // namespace fenestra
