#include "files/medical/DicomSeries.h"

#include "base/Error.h"
#include "io/InputRegistry.h"
#include "io/MessageText.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <tuple>

namespace fenestra::core {
namespace {

namespace fs = std::filesystem;
using Path = fs::path;
using Paths = std::vector<Path>;

/// Files in a folder and its subfolders, which may be links.
class FileTree {
public:
  /// Throws Error (input) if the folder cannot be read, or has too many files.
  explicit FileTree(const Path& root) : m_root(root) { add(root, 0); }

  const Paths& files() const { return m_files; }

private:
  void add(const Path& folder, int depth) {
    constexpr int maxDepth = 16;
    constexpr std::size_t maxFiles = 200'000;
    const auto id = fileId(folder);
    if (depth > maxDepth || (id && !m_visited.insert(*id).second))
      return;
    const auto [files, folders] = listFolder(folder);
    m_files.insert(m_files.end(), files.begin(), files.end());
    if (m_files.size() > maxFiles)
      throw inputError(ErrorCode::limitExceeded, m_root, "folder has more than ", maxFiles,
                       " files; give the folder of one study");
    for (const Path& subfolder : folders)
      add(subfolder, depth + 1);
  }

  const Path& m_root;
  Paths m_files;
  std::set<FileId> m_visited;
};

/// What the slices of one series have in common.
std::string getSeriesKey(const DicomHeader& h) {
  if (!h.seriesUid.empty())
    return h.seriesUid;
  return concat("\n", h.frameOfReference, '\n', h.rows, '\n', h.columns, '\n',
                joinNumbers(h.orientation, "\\", 3), '\n', h.seriesNumber, '\n',
                h.seriesDescription, '\n', h.modality);
}

/// Headers of the files of a folder. Files on which the reader fails are left out with a warning.
class FolderHeaders {
public:
  std::vector<DicomHeader> read(const Path& file) {
    constexpr std::size_t mostFailures = 16; // each takes a new process
    try {
      return m_reader.readHeaders(file);
    } catch (const Error& error) {
      if (error.message().code == ErrorCode::unsupportedFile) {
        m_unsupported = m_unsupportedCount++ == 0 ? error : m_unsupported;
        return {};
      }
      if (error.message().code != ErrorCode::unreadableFile || m_failures.size() == mostFailures)
        throw;
      m_failures.push_back(
          makeMessage(ErrorCode::omittedSlices, file, "cannot be read, and is left out"));
      return {};
    }
  }

  std::vector<Message> warnings() const {
    std::vector<Message> all = m_failures;
    if (m_unsupported)
      all.push_back(makeMessage(ErrorCode::omittedSlices, m_unsupported->message().subject,
                                m_unsupported->message().detail, "; ", m_unsupportedCount,
                                m_unsupportedCount == 1 ? " such file is" : " such files are",
                                " left out"));
    return all;
  }
  /// Throws the error about the first file of an unsupported transfer syntax, if there is one.
  void requireSupported() const {
    if (m_unsupported)
      throw Error(*m_unsupported);
  }

private:
  DicomReader m_reader;
  std::vector<Message> m_failures;
  std::optional<Error> m_unsupported; ///< the first
  std::size_t m_unsupportedCount = 0;
};

/// `subject`: the folder in messages.
DicomFolder groupFiles(const Paths& files, const std::string& subject) {
  FolderHeaders headers;
  DicomFolder folder;
  std::map<std::string, DicomSlices> bySeries;
  for (const Path& file : files)
    for (DicomHeader& header : headers.read(file))
      if (isDicomSegmentation(header)) {
        folder.segmentations.push_back({file, std::move(header)});
      } else if (!header.isComplete || isImage(header)) {
        DicomSlices& slices = bySeries[getSeriesKey(header)];
        slices.push_back({file, std::move(header)});
      }
  for (auto& [key, slices] : bySeries)
    std::ranges::move(splitSeries(std::move(slices), subject), std::back_inserter(folder.series));
  if (folder.series.empty())
    headers.requireSupported();
  const std::vector<Message> warnings = headers.warnings();
  for (DicomSeries& series : folder.series)
    std::ranges::copy(warnings, std::back_inserter(series.warnings));
  const auto isVolume = [](const DicomSeries& series) { return series.isVolume; };
  if (std::ranges::any_of(folder.series, isVolume))
    std::erase_if(folder.series, std::not_fn(isVolume));
  std::ranges::stable_sort(folder.series, {}, [](const DicomSeries& series) {
    return std::tuple(series.number.size(), series.number, series.uid); // shorter first: numeric
  });
  return folder;
}

/// An object that is no image of a scan, for a message.
std::string nameObject(const std::string& modality) {
  constexpr std::array<std::pair<std::string_view, const char*>, 6> names = {
      {{"RTDOSE", "an RT Dose"},
       {"RTPLAN", "an RT Plan"},
       {"SR", "a structured report"},
       {"PR", "a presentation state"},
       {"KO", "a key object selection"},
       {"REG", "a registration"}}};
  const auto known =
      std::ranges::find(names, modality, [](const auto& name) { return name.first; });
  return known == names.end() ? "a DICOM file without an image"
                              : concat(known->second, ", not an image of a scan");
}

std::size_t countSlices(const DicomSeries& series) {
  std::size_t count = 0;
  for (const DicomSlices& frame : series.frames)
    count += frame.size();
  return count;
}

std::string describeSeries(const DicomSeries& series) {
  std::string text = series.number.empty() ? "" : "number " + sanitize(series.number) + " ";
  if (!series.part.empty())
    text += "\"" + sanitize(series.name()) + "\" ";
  if (!series.description.empty())
    text += "\"" + sanitize(series.description) + "\" ";
  text += series.modality.empty() ? "" : sanitize(series.modality) + " ";
  text += series.uid.empty() ? "" : sanitize(series.uid) + " ";
  const std::size_t count = countSlices(series);
  return concat(text, "(", count, count == 1 ? " slice)" : " slices)");
}

std::string formatSeries(const std::vector<DicomSeries>& series) {
  constexpr std::size_t maxListed = 40;
  return join(series, "; ", describeSeries, maxListed);
}

/// The only series, or the only one that is not a single slice.
std::optional<DicomSeries> findOnlySeries(const std::vector<DicomSeries>& series,
                                          const std::string& folder) {
  if (series.size() == 1)
    return series.front();
  std::vector<DicomSeries> stacks;
  std::ranges::copy_if(series, std::back_inserter(stacks),
                       [](const DicomSeries& one) { return one.frames.front().size() > 1; });
  if (stacks.size() != 1)
    return std::nullopt;
  stacks.front().warnings.push_back(
      makeMessage(ErrorCode::omittedSlices, folder, "the only series of several slices is used, ",
                  describeSeries(stacks.front()), "; ", series.size() - 1,
                  series.size() == 2 ? " other is a single image" : " others are single images"));
  return stacks.front();
}

} // namespace

Paths DicomSeries::files() const {
  Paths all;
  std::set<Path> known;
  for (const DicomSlices& frame : frames)
    for (const DicomSlice& slice : frame)
      if (known.insert(slice.path).second)
        all.push_back(slice.path);
  return all;
}

std::string DicomSeries::name() const {
  return concat(number, number.empty() || part.empty() ? "" : " ", part);
}

Paths DicomFolder::segmentationsOf(const DicomSeries& one) const {
  const std::string& frameOfReference = one.frames.front().front().header.frameOfReference;
  Paths found;
  for (const DicomSegmentationFile& file : segmentations) {
    const DicomHeader& h = file.header;
    const bool isInFrame = !frameOfReference.empty() && h.frameOfReference == frameOfReference;
    if (h.referencedSeries.empty() ? isInFrame : h.referencedSeries == one.uid)
      found.push_back(file.path);
  }
  return found;
}

DicomFolder findDicomSeries(const Path& folder) {
  const FileTree tree(folder);
  for (const Path& file : tree.files())
    requireFile(file, "give only the folder");
  DicomFolder found = groupFiles(tree.files(), folder.string());
  if (found.series.empty())
    throw inputError(ErrorCode::unsupportedFile, folder,
                     "folder has no DICOM image series; give one that does, or a volume file");
  return found;
}

DicomFolder findSeriesOfFile(const Path& file) {
  requireFile(file, "give only the folder");
  const std::vector<DicomHeader> headers = DicomReader().readHeaders(file);
  if (!headers.empty() && isDicomSegmentation(headers.front()))
    throw inputError(ErrorCode::segmentationAsVolume, file, "is a segmentation");
  const Path parent = file.has_parent_path() ? file.parent_path() : Path(".");
  if (!headers.empty() && headers.front().isDirectory)
    return findDicomSeries(parent);
  if (headers.empty() || (headers.front().isComplete && !isImage(headers.front())))
    throw inputError(ErrorCode::unsupportedFile, file, "is ",
                     headers.empty() ? "a DICOM file without an image"
                                     : nameObject(headers.front().modality),
                     "; give a volume file or a DICOM series");
  const bool isAlone = headers.size() > 1;
  const Paths files = isAlone ? Paths{file} : listFolder(parent).files;
  for (const Path& one : files)
    requireFile(one, "give only the folder");
  DicomFolder found = groupFiles(files, (isAlone ? file : parent).string());
  if (isAlone)
    return found;
  std::erase_if(found.series, [&](const DicomSeries& series) {
    return std::ranges::none_of(series.files(), [&](const Path& other) {
      std::error_code failed;
      return fs::equivalent(file, other, failed);
    });
  });
  if (found.series.empty()) // left out of its series
    found.series = splitSeries({{file, headers.front()}}, file.string());
  for (DicomSeries& series : found.series)
    if (const std::size_t count = series.files().size(); count > 1)
      series.warnings.push_back(makeMessage(ErrorCode::assumedGeometry, file, "is one of ", count,
                                            " slices of its series in this folder; all are read"));
  return found;
}

DicomSeries chooseSeries(const std::vector<DicomSeries>& series,
                         const std::optional<std::string>& selector, const std::string& folder) {
  if (!selector) {
    if (const auto only = findOnlySeries(series, folder))
      return *only;
    throw inputError(ErrorCode::ambiguousVolume, folder, "has ", series.size(), " DICOM ",
                     series.front().part.empty() ? "series: " : "volumes: ", formatSeries(series));
  }
  const auto matches = [&](const DicomSeries& one, int field) {
    const std::string fields[] = {one.uid, one.number, one.description, one.part, one.name()};
    return !selector->empty() && fields[field] == *selector;
  };
  for (const int field : {0, 1, 2, 3, 4}) {
    std::vector<DicomSeries> found;
    std::ranges::copy_if(series, std::back_inserter(found),
                         [&](const DicomSeries& one) { return matches(one, field); });
    if (found.size() == 1)
      return found.front();
    if (found.size() > 1)
      throw inputError(ErrorCode::ambiguousName, folder, "\"", sanitize(*selector),
                       "\" matches several: ", formatSeries(found), "; choose one by its ",
                       found.front().part.empty() ? "uid" : "quoted name");
  }
  throw inputError(ErrorCode::unknownName, folder, "\"", sanitize(*selector),
                   "\" matches no DICOM series; it has ", formatSeries(series));
}

} // namespace fenestra::core
