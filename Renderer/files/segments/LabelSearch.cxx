#include "files/segments/LabelSearch.h"

#include "base/Error.h"
#include "base/Text.h"
#include "io/InputRegistry.h"
#include "io/MessageText.h"

#include <algorithm>

namespace fenestra::core {
namespace {

struct SiblingTable {
  std::filesystem::path file;
  bool mustMatchExactly; ///< must name exactly the label map's values, since many label maps may
                         ///< share it
};

/// Existing tables in the label map's folder that may belong to it.
std::vector<SiblingTable> findSiblingTables(const std::filesystem::path& path) {
  std::vector<SiblingTable> tables;
  const std::filesystem::path stem = stripExtensions(path);
  for (const char* extension : {".ctbl", ".label", ".json", ".csv", ".tsv"})
    tables.push_back({stem.string() + extension, false});
  tables.push_back({concat(stem.string(), '_', "ColorTable.ctbl"), false}); // by Slicer's export
  tables.push_back({path.parent_path() / "seg_labels.json", true});
  std::erase_if(tables, [](const SiblingTable& table) { return !fileExists(table.file); });
  return tables;
}

std::size_t countNamed(const LabelNames& names, const std::set<std::int32_t>& values) {
  return static_cast<std::size_t>(
      std::ranges::count_if(values, [&](std::int32_t value) { return names.contains(value); }));
}

/// Version of TotalSegmentator whose class names match; empty: neither.
std::string findVersion(const LabelNames& names) {
  for (const char* version : {"totalsegmentator2", "totalsegmentator1"}) {
    const LabelNames table = *findBuiltInLabelNames(version);
    if (std::ranges::all_of(names, [&](const auto& one) {
          const auto known = table.find(one.first);
          return known != table.end() && known->second.name == one.second.name;
        }))
      return version;
  }
  return {};
}

FoundNames readRequestedNames(const std::filesystem::path& path, const std::string& extensions,
                              const std::string& requested) {
  if (requested == "totalsegmentator") {
    const auto inFile = parseLabelNamesXml(extensions, path.string());
    const std::string version = inFile ? findVersion(*inFile) : "";
    if (version.empty())
      throw inputError(ErrorCode::unknownLabelVersion, path,
                       "does not state its TotalSegmentator version, and versions number organs "
                       "differently");
    return {*inFile, version};
  }
  if (auto table = findBuiltInLabelNames(requested))
    return {*table, requested};
  if (!fileExists(requested))
    throw requestError(ErrorCode::unknownName, concat("labels ", sanitize(requested)),
                       "is neither a file nor a built-in table; give a file, totalsegmentator, ",
                       join(listBuiltInLabelTables(), ", "));
  const InputConfinement anywhere(std::nullopt); // the user named the file: not only in an archive
  return {readLabelNames(requested), requested};
}

FoundNames readSiblingNames(const std::filesystem::path& path,
                            const std::set<std::int32_t>& values) {
  FoundNames found;
  for (const SiblingTable& table : findSiblingTables(path)) {
    const std::string file = table.file.string();
    try {
      LabelNames names = readLabelNames(table.file);
      const bool isMatch = countNamed(names, values) == values.size() &&
                           (!table.mustMatchExactly || names.size() == values.size());
      if (isMatch)
        return {std::move(names), file, std::move(found.warnings)};
      found.warnings.push_back(makeMessage(ErrorCode::unusedLabels, file,
                                           "does not match the values of ", path.filename(),
                                           " and is not used"));
    } catch (const Error& error) {
      found.warnings.push_back(error.message());
      found.warnings.back().detail += " (it is not used)";
    }
  }
  return found;
}

/// The names in the file itself, else those beside it.
FoundNames findOwnNames(const std::filesystem::path& path, const std::set<std::int32_t>& values,
                        const std::string& extensions) {
  if (auto inFile = parseLabelNamesXml(extensions, path.string()))
    return {*inFile, path.string()};
  return readSiblingNames(path, values);
}

/// Warning if the label map's own names differ from those of the built-in table `requested` by more
/// than the order and the separation of words.
std::vector<Message> findContradiction(const std::filesystem::path& path, const FoundNames& own,
                                       const std::string& requested, const LabelNames& names) {
  const auto listWords = [](const std::string& name) {
    std::vector<std::string> words = splitName(name);
    std::ranges::sort(words);
    return words;
  };
  for (const auto& [value, ownName] : own.names)
    if (const auto other = names.find(value);
        other != names.end() && listWords(ownName.name) != listWords(other->second.name))
      return {
          makeMessage(ErrorCode::unmatchedLabels, path, "the label table ", sanitize(requested),
                      " calls the value ", value, " ", other->second.name, ", but ",
                      sanitize(own.source), " calls it ", sanitize(ownName.name),
                      "; if the table belongs to another label map, segments have wrong names")};
  return {};
}

} // namespace

std::filesystem::path stripExtensions(const std::filesystem::path& path) {
  const std::filesystem::path stem = path.stem();
  return path.parent_path() / (lowercaseExtension(path) == ".gz" ? stem.stem() : stem);
}

FoundNames findLabelNames(const std::filesystem::path& path, const std::set<std::int32_t>& values,
                          const std::string& extensions,
                          const std::optional<std::string>& requested) {
  if (!requested) {
    FoundNames own = findOwnNames(path, values, extensions);
    if (own.names.empty() && values.size() == 1) // a mask, as of a structure per file
      own.names[*values.begin()].name = stripExtensions(path).filename();
    return own;
  }
  constexpr std::size_t maxListed = 8;
  FoundNames found = readRequestedNames(path, extensions, *requested);
  std::vector<std::int32_t> unnamed;
  std::ranges::copy_if(values, std::back_inserter(unnamed),
                       [&](std::int32_t value) { return !found.names.contains(value); });
  const std::string list = join(
      unnamed, ", ", [](std::int32_t value) { return concat(value); }, maxListed);
  if (!values.empty() && unnamed.size() == values.size())
    throw inputError(ErrorCode::unmatchedLabels, path, "the label table ", sanitize(*requested),
                     " names none of the label values (", list, ")");
  if (!unnamed.empty())
    found.warnings.push_back(
        makeMessage(ErrorCode::unmatchedLabels, path, "the label table ", sanitize(*requested),
                    " does not name all label values (not ", list,
                    "); if it belongs to another label map, segments have wrong names"));
  if (findBuiltInLabelNames(*requested))
    for (Message& warning :
         findContradiction(path, findOwnNames(path, values, extensions), *requested, found.names))
      found.warnings.push_back(std::move(warning));
  return found;
}

} // namespace fenestra::core
