#include "files/medical/ImageStack.h"

#include "base/Error.h"
#include "base/PhysicalMemory.h"
#include "files/medical/DicomReader.h"
#include "files/medical/MedicalHeader.h"
#include "files/medical/VolumeReader.h"
#include "io/InputRegistry.h"
#include "model/volume/Grid.h"

#include <algorithm>
#include <cctype>
#include <cstring>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>

namespace fenestra::core {
namespace {

using Path = std::filesystem::path;
using Paths = std::vector<Path>;

// ---- files of a folder

bool isHidden(const Path& file) {
  return file.filename().string().starts_with('.');
}

bool isDigit(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

/// Text whose order is the natural one of the names: each number is written as a zero, its count of
/// digits and its digits.
std::string makeNaturalKey(std::string_view name) {
  std::string key;
  while (!name.empty()) {
    const auto end =
        static_cast<std::size_t>(std::ranges::find_if_not(name, isDigit) - name.begin());
    if (end == 0) {
      key += name.front();
      name.remove_prefix(1);
      continue;
    }
    std::string_view number = name.substr(0, end);
    number.remove_prefix(std::min(number.find_first_not_of('0'), end));
    key.append(1, '0').append(1, static_cast<char>(number.size())).append(number);
    name.remove_prefix(end);
  }
  return key;
}

/// PNG and TIFF files of a folder, in natural order.
Paths listSlices(const Path& folder) {
  Paths files = listFolder(folder).files;
  std::erase_if(files, [](const Path& file) { return isHidden(file) || !isSliceFile(file); });
  std::ranges::sort(files, {}, [](const Path& file) {
    const std::string name = file.filename().string();
    return std::pair(makeNaturalKey(name), name);
  });
  return files;
}

/// Last number in a file's name, before its extension.
std::optional<std::int64_t> findLastNumber(const Path& file) {
  const std::string name = file.stem().string();
  const auto last = std::ranges::find_if(name.rbegin(), name.rend(), isDigit);
  const auto first = std::find_if_not(last, name.rend(), isDigit);
  return parseInteger(std::string(first.base(), last.base()));
}

/// Warns if the numbers of the names are not evenly spaced, so slices may be missing.
void checkNumbers(ImageStack& stack) {
  std::optional<std::int64_t> step;
  for (std::size_t i = 1; i < stack.slices.size(); ++i) {
    const Path &previous = stack.slices[i - 1].file, &file = stack.slices[i].file;
    const auto before = findLastNumber(previous), number = findLastNumber(file);
    if (!before || !number)
      return;
    if (step && *number - *before != *step) {
      stack.warnings.push_back(makeMessage(ErrorCode::assumedGeometry, stack.path,
                                           "the numbers of its slices are uneven between ",
                                           previous.filename(), " and ", file.filename(),
                                           "; the slices are taken as evenly spaced"));
      return;
    }
    step = *number - *before;
  }
}

// ---- headers

/// Name of a slice in messages.
std::string describe(const ImageStack::Slice& slice) {
  return slice.page == 0 ? slice.file.string() : concat(slice.file, ": page ", slice.page + 1);
}

std::string describe(const SliceHeader& header) {
  static const std::array names = {"unsigned 8-bit", "signed 8-bit", "unsigned 16-bit",
                                   "signed 16-bit", "32-bit float"};
  return concat(header.columns, "x", header.rows, " pixels of ", names.at(header.type));
}

/// Adds a slice. Throws Error (input) if it differs from the others.
void addSlice(const ImageStack::Slice& slice, const SliceHeader& header, ImageStack& stack) {
  if (stack.slices.empty())
    stack.header = header;
  const SliceHeader& first = stack.header;
  if (header.columns != first.columns || header.rows != first.rows || header.type != first.type)
    throw inputError(describe(slice), "has ", describe(header), ", but ",
                     stack.slices.front().file.filename(), " has ", describe(first),
                     "; remove it from the stack");
  stack.slices.push_back(slice);
}

void openFolder(SliceReader& reader, ImageStack& stack) {
  const Paths files = listSlices(stack.path);
  if (std::ranges::any_of(files, isTiff) && !std::ranges::all_of(files, isTiff))
    throw inputError(stack.path, "has both PNG and TIFF slices; give a folder with only one kind");
  for (const Path& file : files) {
    const SliceHeader header = reader.readHeader(file, 0);
    if (!header.isLast)
      throw inputError(ErrorCode::unsupportedFile, file,
                       "has several pages, and is a stack itself; give this file");
    addSlice({file}, header, stack);
  }
  checkNumbers(stack);
}

void openPages(SliceReader& reader, ImageStack& stack) {
  constexpr std::uint32_t maxPages = 65535;
  bool isLast = false;
  for (std::uint32_t page = 0; !isLast; ++page) {
    if (page == maxPages)
      throw inputError(ErrorCode::limitExceeded, stack.path, "has more than ", maxPages,
                       " pages; save it as several files");
    const SliceHeader header = reader.readHeader(stack.path, page);
    addSlice({stack.path, page}, header, stack);
    isLast = header.isLast;
  }
}

// ---- samples

/// Throws Error (input) if the stack declares more samples than its files or the memory can hold.
/// Only encodings of nearly empty images exceed the ratio.
void checkBytes(const ImageStack& stack) {
  constexpr std::uint64_t ratio = 4096;
  std::uint64_t stored = 0;
  for (const Path& file : stack.files())
    stored += std::filesystem::file_size(file);
  const std::uint64_t declared = std::uint64_t{stack.header.bytes()} * stack.slices.size();
  if (declared / ratio > stored)
    throw inputError(ErrorCode::damagedFile, stack.path, "declares ", declared,
                     " bytes of samples, more than its files of ", stored, " bytes can hold");
  if (static_cast<double>(declared) > physicalMemory())
    throw inputError(ErrorCode::outOfMemory, stack.path, "has ", declared >> 20,
                     " MB of samples, more than this machine's memory; crop or resample it");
}

/// Samples of all slices, of which it keeps one.
class StackSamples {
public:
  /// Reads the first slice, so that the child belongs to this thread and not to one of a pipeline.
  explicit StackSamples(const ImageStack& stack) : m_stack(stack) { readSlice(); }

  void read(void* to, std::size_t bytes) {
    for (auto* out = static_cast<char*>(to); bytes > 0;) {
      if (m_position == m_samples.size())
        readSlice();
      const std::size_t part = std::min(bytes, m_samples.size() - m_position);
      std::memcpy(out, &m_samples[m_position], part);
      m_position += part;
      out += part;
      bytes -= part;
    }
  }

private:
  void readSlice() {
    const ImageStack::Slice& slice = m_stack.slices.at(m_next++);
    m_samples.clear();
    m_samples.shrink_to_fit();
    m_samples = m_reader.readSamples(slice.file, slice.page, m_stack.header);
    m_position = 0;
  }

  const ImageStack& m_stack;
  SliceReader m_reader;
  std::string m_samples;
  std::size_t m_position = 0, m_next = 0;
};

Volume readSlices(const ImageStack& stack, const Vec3& spacing) {
  const Size3 size = stack.size();
  StackSamples slices(stack);
  const SampleSource source{.type = sliceTypes[stack.header.type],
                            .count = static_cast<std::size_t>(size[0] * size[1] * size[2]),
                            .read = [&](void* to, std::size_t bytes) { slices.read(to, bytes); }};
  VoxelStore samples(source.count);
  readSamples(source, samples);
  const Grid grid(size, Affine(lpsToRas * Mat3::Diagonal(spacing), Vec3::Zero()));
  return makeVolume(stack.path.string(), grid, std::move(samples));
}

} // namespace

Size3 ImageStack::size() const {
  return Size3(header.columns, header.rows, std::ssize(slices));
}

Paths ImageStack::files() const {
  Paths all;
  for (const Slice& slice : slices)
    if (slice.page == 0)
      all.push_back(slice.file);
  return all;
}

bool isImageStack(const Path& path) {
  if (!isFolder(path))
    return isTiff(path) && !isDicomFile(path);
  const auto [files, folders] = listFolder(path);
  const auto isSlice = [](const Path& file) { return !isHidden(file) && isSliceFile(file); };
  const auto count = std::ranges::count_if(files, isSlice);
  return (count > 1 || (count == 1 && folders.empty())) &&
         std::ranges::none_of(files, [](const Path& file) {
           return !isHidden(file) && (findMedicalFormat(file) || isDicomFile(file));
         });
}

ImageStack openImageStack(const Path& path) {
  ImageStack stack{.path = path};
  SliceReader reader;
  if (isFolder(path))
    openFolder(reader, stack);
  else
    openPages(reader, stack);
  if (stack.slices.size() == 1)
    throw inputError(ErrorCode::unsupportedFile, stack.slices.front().file,
                     "is one image, not a volume; give a folder of several slices");
  return stack;
}

Volume readImageStack(const ImageStack& stack, const VolumeChoice& choice) {
  const std::string name = stack.path.string();
  refuseForm(name, choice);
  if (!choice.spacing)
    throw inputError(ErrorCode::spacingRequired, name, "is a stack of ", stack.slices.size(),
                     " images, which state no voxel spacing");
  std::vector<Message> warnings = stack.warnings;
  chooseFrame(name, choice.frame, 1, warnings);
  warnings.push_back(makeMessage(ErrorCode::assumedGeometry, name,
                                 "states no orientation: columns are taken toward left, rows "
                                 "toward posterior and slices toward superior"));
  checkBytes(stack);
  try {
    Volume volume = readSlices(stack, *choice.spacing);
    std::ranges::move(warnings, std::back_inserter(volume.warnings));
    return volume;
  } catch (const std::bad_alloc&) {
    throw inputError(ErrorCode::outOfMemory, name, "does not fit into memory; crop or resample it");
  }
}

} // namespace fenestra::core
