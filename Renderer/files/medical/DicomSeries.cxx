#include "files/medical/DicomSeries.h"

#include "base/Error.h"
#include "base/safe/Inputs.h"
#include "base/safe/ShownText.h"
#include "base/safe/SystemCalls.h"
#include "files/medical/DicomHeader.h"

#include <algorithm>
#include <map>
#include <tuple>

namespace fenestra {
namespace {

using Path = std::filesystem::path;
namespace fs = std::filesystem;

struct FolderContent {
  std::vector<Path> files, folders;
};

FolderContent contentOf(const Path& folder) {
  FolderContent content;
  std::error_code failed;
  for (fs::directory_iterator it(folder, failed), end; !failed && it != end; it.increment(failed)) {
    std::error_code unknown;
    if (it->is_regular_file(unknown)) {
      requireFile(it->path(), "name the folder alone");
      content.files.push_back(it->path());
    } else if (it->is_directory(unknown))
      content.folders.push_back(it->path());
  }
  if (failed)
    throw inputError(folder, "the folder cannot be read: ", failed.message(), "; ",
                     readingMend(failed.value(), "check its name and its permissions"));
  std::ranges::sort(content.files);
  std::ranges::sort(content.folders);
  return content;
}

std::vector<Path> candidates(const Path& folder) {
  FolderContent content = contentOf(folder);
  if (content.files.empty())
    for (const Path& below : content.folders) {
      const FolderContent inner = contentOf(below);
      content.files.insert(content.files.end(), inner.files.begin(), inner.files.end());
    }
  return content.files;
}

/// Key that sorts numbers as numbers: shorter ones first.
auto sortKey(const DicomSeries& series) {
  return std::tuple(series.number.size(), series.number, series.uid);
}

std::string described(const DicomSeries* one) {
  const DicomSeries& series = *one;
  std::string text = series.number.empty() ? "" : "number " + shown(series.number) + " ";
  if (!series.description.empty())
    text += "\"" + shown(series.description) + "\" ";
  text += series.modality.empty() ? "" : shown(series.modality) + " ";
  const std::size_t count = series.files.size();
  return textOf(text, shown(series.uid), " (", count, count == 1 ? " file)" : " files)");
}

std::string listed(const std::vector<const DicomSeries*>& series) {
  return joined(series, "; ", described, 40);
}

} // namespace

std::vector<DicomSeries> findDicomSeries(const Path& folder) {
  DicomFiles files;
  std::map<std::string, DicomSeries> byUid;
  for (const Path& file : candidates(folder)) {
    const auto header = files.header(file);
    if (!header || header->seriesUid.empty() || (header->whole && !isImage(*header)))
      continue;
    DicomSeries& series = byUid[header->seriesUid];
    if (series.files.empty())
      series = {
          header->seriesUid, header->seriesNumber, header->seriesDescription, header->modality, {}};
    series.files.push_back(file);
  }
  if (byUid.empty())
    throw inputError(
        folder, "the folder holds no DICOM series of images; name one that does, or a volume file");
  std::vector<DicomSeries> all;
  for (auto& [uid, series] : byUid)
    all.push_back(std::move(series));
  std::ranges::sort(all, {}, sortKey);
  return all;
}

const DicomSeries& chooseSeries(const std::vector<DicomSeries>& series,
                                const std::optional<std::string>& selector,
                                const std::string& folder) {
  const auto matching = [&](auto&& matches) {
    std::vector<const DicomSeries*> found;
    for (const DicomSeries& one : series)
      if (matches(one))
        found.push_back(&one);
    return found;
  };
  const auto all = matching([](const DicomSeries&) { return true; });
  if (!selector) {
    if (all.size() != 1)
      throw inputError(folder, "holds ", all.size(), " DICOM series: ", listed(all),
                       "; pick one with --volume, by uid, number or description");
    return *all.front();
  }
  for (const auto field : {&DicomSeries::uid, &DicomSeries::number, &DicomSeries::description}) {
    const auto found = matching([&](const DicomSeries& one) { return one.*field == *selector; });
    if (found.size() == 1)
      return *found.front();
    if (found.size() > 1)
      throw inputError(folder, "--volume \"", shown(*selector), "\" can be any of ", listed(found),
                       "; pick one by its uid");
  }
  throw inputError(folder, "--volume \"", shown(*selector), "\" names no DICOM series; there are ",
                   listed(all));
}

} // namespace fenestra
