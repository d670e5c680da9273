#include "files/slicer/SceneFiles.h"

#include "files/medical/ReferencedFiles.h"
#include "io/InputRegistry.h"
#include "io/JsonNode.h"
#include "io/MessageText.h"
#include "io/platform/SystemErrors.h"

#include <zip.h>

#include <algorithm>
#include <array>
#include <climits>
#include <fstream>
#include <functional>
#include <string_view>

namespace fenestra::core {
namespace {

constexpr std::uint64_t maxSceneBytes = std::uint64_t{64} << 20; ///< size of a .mrml, bytes
constexpr std::int64_t maxEntries = 1'000'000;

/// Maximum ratio of unpacked to packed bytes with deflate. No archive from Slicer exceeds it.
constexpr std::uint64_t maxRatio = 1032;

/// Limit of the total unpacked size of an archive. A single volume of zeros compresses better than
/// 100 to 1, a complete scene does not.
std::uint64_t maxUnpackedBytes(std::uint64_t archiveBytes) {
  return (std::uint64_t{1} << 30) + 100 * archiveBytes;
}

bool isOutside(const std::filesystem::path& name) {
  return name.is_absolute() ||
         std::any_of(name.begin(), name.end(), [](const auto& part) { return part == ".."; });
}

} // namespace

/// A zip archive with a scene and its files.
class SceneArchive {
public:
  /// Throws Error (input) if `path` is not an archive, or an entry's name leads out of it.
  explicit SceneArchive(const std::filesystem::path& path);

  /// Entry index of each file, by normalized relative path; the first of several with equal paths.
  const std::map<std::filesystem::path, std::uint64_t>& files() const { return m_files; }

  /// Writes one of files() into an existing, empty file. Throws Error: input if the entry is
  /// damaged, encrypted or larger than its packed bytes allow; output if the disk is full.
  void extract(const std::filesystem::path& file, const std::filesystem::path& destination);
  /// Content of one of files(). Throws Error (input) as extract does, and for more than `maxBytes`
  /// bytes.
  std::string text(const std::filesystem::path& file, std::uint64_t maxBytes) const;

private:
  struct Close {
    void operator()(zip_t* archive) const { zip_discard(archive); }
    void operator()(zip_file_t* file) const { zip_fclose(file); }
  };
  using Chunk = std::function<void(std::string_view)>;

  Error error(ErrorCode code, const std::filesystem::path& file, const std::string& what) const {
    return inputError(code, concat(m_source, ": ", toOneLine(file.string())), what);
  }
  Error makeDamagedError(const std::filesystem::path& file) const {
    return error(ErrorCode::damagedFile, file, "is damaged; save the scene again");
  }

  zip_stat_t stat(std::uint64_t entry, const std::filesystem::path& file) const {
    zip_stat_t stat;
    zip_stat_init(&stat);
    constexpr zip_uint64_t needed = ZIP_STAT_SIZE | ZIP_STAT_COMP_SIZE | ZIP_STAT_ENCRYPTION_METHOD;
    if (zip_stat_index(m_archive.get(), entry, 0, &stat) != 0 || (stat.valid & needed) != needed)
      throw makeDamagedError(file);
    if (stat.encryption_method != ZIP_EM_NONE)
      throw error(ErrorCode::unsupportedFile, file,
                  "is encrypted; save the scene without a password");
    if (stat.size / maxRatio > stat.comp_size)
      throw error(ErrorCode::damagedFile, file,
                  "declares more bytes than it can hold; save the scene again");
    return stat;
  }

  /// Passes the entry's bytes to `consume`. Throws Error (input) unless there are exactly `size`
  /// bytes with the right checksum.
  void read(std::uint64_t entry, const std::filesystem::path& file, std::uint64_t size,
            const Chunk& consume) const {
    const std::unique_ptr<zip_file_t, Close> stream(zip_fopen_index(m_archive.get(), entry, 0));
    if (!stream)
      throw makeDamagedError(file);
    std::array<char, 1 << 16> buffer;
    std::uint64_t rest = size;
    for (;;) { // read to the end of the stream, where libzip verifies the checksum
      const zip_int64_t count = zip_fread(stream.get(), buffer.data(), buffer.size());
      if (count < 0 || static_cast<std::uint64_t>(count) > rest)
        throw makeDamagedError(file);
      if (count == 0)
        break;
      rest -= static_cast<std::uint64_t>(count);
      consume({buffer.data(), static_cast<std::size_t>(count)});
    }
    if (rest > 0)
      throw makeDamagedError(file);
  }

  std::string m_source;
  std::unique_ptr<zip_t, Close> m_archive;
  std::uint64_t m_remainingBytes = 0; ///< bytes that may still be extracted
  std::map<std::filesystem::path, std::uint64_t> m_files;
};

SceneArchive::SceneArchive(const std::filesystem::path& path) : m_source(path.string()) {
  int failure = 0;
  errno = 0;
  zip_t* zip = zip_open(path.c_str(), ZIP_RDONLY, &failure);
  if (!zip && (failure == ZIP_ER_OPEN || failure == ZIP_ER_READ) && errno != 0)
    throw readError(path, errno, "check its permissions");
  if (!zip)
    throw inputError(ErrorCode::damagedFile, m_source,
                     "is not a complete archive; save the scene again, or use its .mrml");
  m_archive.reset(zip);
  m_remainingBytes = maxUnpackedBytes(std::filesystem::file_size(path));
  const zip_int64_t count = zip_get_num_entries(zip, 0);
  if (count > maxEntries)
    throw inputError(ErrorCode::limitExceeded, m_source,
                     "has more than a million files; save a smaller scene");

  for (std::uint64_t entry = 0; entry < static_cast<std::uint64_t>(count); ++entry) {
    const char* name = zip_get_name(zip, entry, 0);
    if (!name)
      throw inputError(m_source, "has an entry without a name; save the scene again");
    const std::filesystem::path file = name;
    if (isOutside(file))
      throw inputError(ErrorCode::outsideArchive, m_source,
                       "has an entry that leads out of the archive (", sanitize(file.string()),
                       "), which Slicer never writes; do not trust this archive");
    if (!file.empty() && file.has_filename())
      m_files.try_emplace(file.lexically_normal(), entry);
  }
}

void SceneArchive::extract(const std::filesystem::path& file,
                           const std::filesystem::path& destination) {
  const std::uint64_t entry = m_files.at(file);
  const std::uint64_t size = stat(entry, file).size;
  if (size > m_remainingBytes)
    throw error(ErrorCode::limitExceeded, file,
                "unpacks, together with the files before it, to more than the limit for an "
                "archive of this size; save the scene again, or unpack it yourself");
  m_remainingBytes -= size;
  const auto makeUnpackError = [&](int code) {
    return outputError(toOneLine(destination.string()), toOneLine(file.string()),
                       " cannot be unpacked: ", systemMessage(code), "; ",
                       writeHint(code, "set TMPDIR to another folder"));
  };
  std::error_code unknown;
  if (size > std::filesystem::space(destination.parent_path(), unknown).available && !unknown)
    throw makeUnpackError(ENOSPC);
  errno = 0;
  // Mode `in` does not recreate the file if the exit or signal handler has removed it.
  std::ofstream out(destination, std::ios::binary | std::ios::in);
  read(entry, file, size, [&](std::string_view chunk) {
    if (!out.write(chunk.data(), static_cast<std::streamsize>(chunk.size())))
      throw makeUnpackError(errno);
  });
  out.close();
  if (!out)
    throw makeUnpackError(errno);
}

std::string SceneArchive::text(const std::filesystem::path& file, std::uint64_t maxBytes) const {
  const std::uint64_t entry = m_files.at(file);
  const std::uint64_t size = stat(entry, file).size;
  if (size > maxBytes)
    throw error(ErrorCode::limitExceeded, file,
                concat("is larger than ", maxBytes >> 20, " MB; save a smaller scene"));
  std::string text;
  read(entry, file, size, [&](std::string_view chunk) { text += chunk; });
  return text;
}

namespace {

std::ptrdiff_t countParts(const std::filesystem::path& file) {
  return std::distance(file.begin(), file.end());
}

/// True for names beyond Linux's limits, which an archive can contain.
bool isTooLong(const std::filesystem::path& path) {
  return path.native().size() >= PATH_MAX ||
         std::any_of(path.begin(), path.end(),
                     [](const auto& part) { return part.native().size() > NAME_MAX; });
}

/// The scene closest to the root, as in Slicer; deeper ones belong to sequences.
std::filesystem::path findMainScene(const SceneArchive& archive,
                                    const std::filesystem::path& path) {
  std::vector<std::filesystem::path> closest;
  for (const auto& [file, entry] : archive.files())
    if (lowercaseExtension(file) == ".mrml")
      closest.push_back(file);
  if (closest.empty())
    throw inputError(ErrorCode::unsupportedFile, path,
                     "has no .mrml, so it is not a scene; save it again from Slicer");
  const auto least = countParts(*std::ranges::min_element(closest, {}, countParts));
  std::erase_if(closest, [least](const auto& file) { return countParts(file) > least; });
  if (closest.size() == 1)
    return closest.front();
  std::vector<std::filesystem::path> named;
  std::ranges::copy_if(closest, std::back_inserter(named), [&path](const auto& file) {
    return file.stem() == path.stem() || file.stem() == file.parent_path().filename();
  });
  if (named.size() == 1)
    return named.front();
  const std::string names =
      join(closest, ", ", [](const auto& file) { return toOneLine(file.string()); });
  throw inputError(ErrorCode::ambiguousName, path, "has several scenes (", names.substr(0, 300),
                   "); unpack it and give one of them");
}

} // namespace

std::string decodeUrl(std::string text) {
  // Slicer escapes % first, so it must be decoded last.
  constexpr std::pair<std::string_view, std::string_view> escapes[] = {
      {"%22", "\""}, {"%3C", "<"}, {"%3E", ">"}, {"%27", "'"}, {"%20", " "}, {"%25", "%"}};
  for (const auto& [escape, character] : escapes)
    text = replaceAll(text, escape, character);
  return text;
}

bool isSceneFile(const std::filesystem::path& path) {
  const std::string extension = lowercaseExtension(path);
  return extension == ".mrml" || extension == ".mrb";
}

SceneFiles::SceneFiles(const std::filesystem::path& path) : m_source(path.string()) {
  requireFile(path, "give the .mrml or .mrb in it");
  if (lowercaseExtension(path) == ".mrb") {
    m_archive = std::make_unique<SceneArchive>(path);
    const std::filesystem::path scene = findMainScene(*m_archive, path);
    m_sceneText = m_archive->text(scene, maxSceneBytes);
    m_folder = scene.parent_path();
  } else {
    m_sceneText = readText(path, maxSceneBytes);
    m_folder = path.parent_path();
  }
}

SceneFiles::~SceneFiles() = default;

std::filesystem::path SceneFiles::resolve(const std::string& fileName) const {
  return (m_folder / decodeUrl(fileName)).lexically_normal(); // an absolute name replaces m_folder
}

void SceneFiles::registerInputs(const std::string& fileName) const {
  if (m_archive)
    return;
  const std::filesystem::path file = resolve(fileName);
  registerInput(file);
  for (const std::filesystem::path& part : findReferencedFiles(file))
    registerInput(part);
}

bool SceneFiles::contains(const std::string& fileName) const {
  std::error_code failed;
  const std::filesystem::path file = resolve(fileName);
  return m_archive ? m_archive->files().contains(file) : std::filesystem::exists(file, failed);
}

std::filesystem::path SceneFiles::locate(const std::string& fileName) {
  const std::filesystem::path name = decodeUrl(fileName);
  std::filesystem::path file = resolve(fileName);
  const auto makeError = [this](ErrorCode code, const std::filesystem::path& named,
                                const std::string& why) {
    return inputError(code, concat(m_source, ": ", toOneLine(named.string())), why);
  };
  if (!m_archive) {
    std::error_code failed;
    const bool exists = std::filesystem::exists(file, failed);
    if (failed)
      throw makeError(ErrorCode::unreadableFile, file,
                      concat("cannot be read: ", systemMessage(failed.value()), "; ",
                             readHint(failed.value(), "check the permissions of its folder")));
    if (!exists)
      throw makeError(ErrorCode::missingFile, file,
                      "does not exist; restore it, or save the scene again");
    m_usedFiles.insert(file);
    return file;
  }
  if (name.is_absolute() || *file.begin() == "..")
    throw makeError(ErrorCode::outsideArchive, name,
                    "is outside the archive; save the scene again");
  if (!m_archive->files().contains(file))
    throw makeError(ErrorCode::missingFile, file, "is not in the archive; save the scene again");
  std::filesystem::path unpacked = unpack(file);
  const std::filesystem::path root = m_unpackFolder->path().lexically_normal();
  for (const std::filesystem::path& part : findReferencedFiles(unpacked))
    if (const auto beside = part.lexically_normal().lexically_relative(root);
        m_archive->files().contains(beside))
      unpack(beside);
  return unpacked;
}

std::filesystem::path SceneFiles::unpack(const std::filesystem::path& file) {
  m_usedFiles.insert(file);
  if (const auto known = m_unpackedFiles.find(file); known != m_unpackedFiles.end())
    return known->second;
  if (!m_unpackFolder)
    m_unpackFolder.emplace();
  if (isTooLong(m_unpackFolder->path() / file))
    throw inputError(ErrorCode::limitExceeded, concat(m_source, ": ", sanitize(file.string())),
                     "exceeds the system's limit for file names; save the scene again with "
                     "shorter names");
  const std::filesystem::path destination = m_unpackFolder->add(file);
  m_archive->extract(file, destination);
  return m_unpackedFiles[file] = destination;
}

std::vector<std::string> SceneFiles::usedFiles() const {
  std::vector<std::string> files = {m_source};
  for (const std::filesystem::path& file : m_usedFiles)
    files.push_back(m_archive ? m_source + "/" + file.string() : file.string());
  return files;
}

std::string SceneFiles::translatePaths(std::string text) const {
  if (m_unpackFolder)
    text = replaceAll(text, m_unpackFolder->path().string(), m_source);
  return toOneLine(std::move(text));
}

} // namespace fenestra::core
