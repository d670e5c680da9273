#include "files/medical/ReferencedFiles.h"

#include "files/formats/TextHeader.h"
#include "files/medical/MedicalHeader.h"
#include "io/InputRegistry.h"

#include <pugixml.hpp>

#include <string_view>

namespace fenestra::core {

using namespace header;

namespace {

namespace fs = std::filesystem;
using Paths = std::vector<fs::path>;

constexpr std::size_t maxFiles = 10'000;                  ///< references in one file
constexpr std::uint64_t maxMultiBlockBytes = 64ULL << 20; ///< size of a .vtm, bytes

/// True if the name is `start`, a number and `end`.
bool isNumbered(std::string_view name, std::string_view start, std::string_view end) {
  if (name.size() < start.size() + end.size() || !name.starts_with(start) || !name.ends_with(end))
    return false;
  name.remove_prefix(start.size());
  name.remove_suffix(end.size());
  return name.find_first_not_of("0123456789+- ") == std::string_view::npos;
}

/// Adds the existing files that match a pattern like "s%03d.raw 1 99 1", with any number.
void addSeries(const fs::path& folder, std::string_view pattern, Paths& files) {
  const std::size_t percent = pattern.find('%');
  const std::size_t conversion = pattern.find_first_not_of("0123456789+- #.", percent + 1);
  if (conversion == std::string_view::npos)
    return;
  const fs::path base = folder / pattern.substr(0, percent);
  const std::string start = base.filename().string();
  const std::string end = splitWords(pattern.substr(conversion)).front().substr(1);
  const fs::path searchFolder = base.has_parent_path() ? base.parent_path() : ".";
  std::error_code failed;
  for (fs::directory_iterator entry(searchFolder, failed), last;
       !failed && entry != last && files.size() < maxFiles; entry.increment(failed))
    if (isNumbered(entry->path().filename().string(), start, end))
      files.push_back(entry->path());
}

/// Adds the sample files that a header names: a single file, "LIST" and the files on the following
/// lines, or a pattern.
void addReferenced(const fs::path& header, std::string_view value, HeaderLines& lines,
                   Paths& files) {
  const fs::path folder = header.parent_path();
  if (value.starts_with("LIST")) {
    for (auto line = lines.next(); line && files.size() < maxFiles; line = lines.next())
      if (!trim(*line).empty())
        files.push_back(folder / trim(*line));
    return;
  }
  if (!value.empty())
    files.push_back(folder / value);
  if (value.find('%') != std::string_view::npos)
    addSeries(folder, value, files);
}

/// Files referenced by the line "data file: NAME" or "ElementDataFile = NAME".
Paths readHeaderReferences(const fs::path& path, std::string_view separator, std::string_view key) {
  Paths files;
  HeaderLines lines(path);
  for (auto line = lines.next(); line && !line->empty(); line = lines.next()) {
    const std::size_t end = line->find(separator);
    if (end == std::string_view::npos)
      continue;
    std::string found = toLower(line->substr(0, end));
    std::erase(found, ' ');
    if (found == key) {
      addReferenced(path, trim(line->substr(end + separator.size())), lines, files);
      break;
    }
  }
  return files;
}

Paths readMultiBlockReferences(const fs::path& path) {
  std::error_code failed;
  Paths files;
  pugi::xml_document document;
  if (fs::file_size(path, failed) <= maxMultiBlockBytes && document.load_file(path.c_str()))
    for (const pugi::xpath_node& found : document.select_nodes("//@file[. != '']"))
      if (files.size() < maxFiles)
        files.push_back(path.parent_path() / found.attribute().value());
  return files;
}

} // namespace

std::vector<fs::path> findReferencedFiles(const fs::path& path) {
  std::error_code failed;
  if (!fs::is_regular_file(path, failed))
    return {};
  const std::string extension = lowercaseExtension(path);
  if (extension == ".nrrd" || extension == ".nhdr")
    return readHeaderReferences(path, ": ", "datafile");
  if (extension == ".mha" || extension == ".mhd")
    return readHeaderReferences(path, "=", "elementdatafile");
  if (extension == ".vtm")
    return readMultiBlockReferences(path);
  if (const auto [header, samples] = findNiftiFiles(path); header != samples)
    return {path == header ? samples : header};
  return {};
}

} // namespace fenestra::core
