#include "files/slicer/SceneArchive.h"

#include "base/Error.h"
#include "base/safe/ShownText.h"
#include "base/safe/SystemCalls.h"

#include <zip.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <functional>
#include <string_view>

namespace fenestra {
namespace {

constexpr std::int64_t mostEntries = 1'000'000;

/// Deflate's greatest ratio, unpacked to packed bytes. No archive of Slicer's claims more.
constexpr std::uint64_t greatestRatio = 1032;

/// Most bytes that all files of an archive may unpack to: a volume of zeros packs better than 100
/// to 1, a whole scene does not.
std::uint64_t mostUnpacked(std::uint64_t archiveBytes) {
  return (std::uint64_t{1} << 30) + 100 * archiveBytes;
}

bool leadsOut(const std::filesystem::path& name) {
  return name.is_absolute() ||
         std::any_of(name.begin(), name.end(), [](const auto& part) { return part == ".."; });
}

using Chunk = std::function<void(std::string_view)>;

} // namespace

struct SceneArchive::Zip {
  struct Close {
    void operator()(zip_t* archive) const { zip_discard(archive); }
    void operator()(zip_file_t* file) const { zip_fclose(file); }
  };

  std::unique_ptr<zip_t, Close> archive;
  std::string source;
  std::uint64_t unpackable = 0; ///< bytes that may still be extracted

  Error error(const std::filesystem::path& file, const std::string& what) const {
    return inputError(source, oneLine(file.string()) + " in it " + what);
  }
  Error damaged(const std::filesystem::path& file) const {
    return error(file, "is damaged; save the scene again");
  }

  zip_stat_t stat(std::uint64_t entry, const std::filesystem::path& file) const {
    zip_stat_t stat;
    zip_stat_init(&stat);
    constexpr zip_uint64_t needed = ZIP_STAT_SIZE | ZIP_STAT_COMP_SIZE | ZIP_STAT_ENCRYPTION_METHOD;
    if (zip_stat_index(archive.get(), entry, 0, &stat) != 0 || (stat.valid & needed) != needed)
      throw damaged(file);
    if (stat.encryption_method != ZIP_EM_NONE)
      throw error(file, "is encrypted; save the scene without a password");
    if (stat.size / greatestRatio > stat.comp_size)
      throw error(file, "claims more bytes than it can hold; save the scene again");
    return stat;
  }

  /// Passes the entry's bytes to `take`. Throws Error (input) unless they are `size` bytes with the
  /// right checksum.
  void read(std::uint64_t entry, const std::filesystem::path& file, std::uint64_t size,
            const Chunk& take) const {
    const std::unique_ptr<zip_file_t, Close> stream(zip_fopen_index(archive.get(), entry, 0));
    if (!stream)
      throw damaged(file);
    std::array<char, 1 << 16> buffer;
    std::uint64_t rest = size;
    for (;;) { // to the end of the stream, where the checksum is
      const zip_int64_t count = zip_fread(stream.get(), buffer.data(), buffer.size());
      if (count < 0 || static_cast<std::uint64_t>(count) > rest)
        throw damaged(file);
      if (count == 0)
        break;
      rest -= static_cast<std::uint64_t>(count);
      take({buffer.data(), static_cast<std::size_t>(count)});
    }
    if (rest > 0)
      throw damaged(file);
  }
};

SceneArchive::SceneArchive(const std::filesystem::path& path) : m_zip(std::make_unique<Zip>()) {
  int failure = 0;
  const std::string& source = m_zip->source = path.string();
  errno = 0;
  zip_t* zip = zip_open(path.c_str(), ZIP_RDONLY, &failure);
  if (!zip && (failure == ZIP_ER_OPEN || failure == ZIP_ER_READ) && errno != 0)
    throw readingError(path, errno, "check its permissions");
  if (!zip)
    throw inputError(source, "is no whole archive; save the scene again, or name its .mrml");
  m_zip->unpackable = mostUnpacked(std::filesystem::file_size(path));
  m_zip->archive.reset(zip);
  const zip_int64_t count = zip_get_num_entries(zip, 0);
  if (count > mostEntries)
    throw inputError(source, "holds more than a million files; save a smaller scene");

  for (std::uint64_t entry = 0; entry < static_cast<std::uint64_t>(count); ++entry) {
    const char* name = zip_get_name(zip, entry, 0);
    if (!name)
      throw inputError(source, "has an entry without a name; save the scene again");
    const std::filesystem::path file = name;
    if (leadsOut(file))
      throw inputError(source, "holds an entry that leads out of the archive (" +
                                   shown(file.string()) +
                                   "); Slicer writes no such archive, so do not trust it");
    if (!file.empty() && file.has_filename())
      m_files.try_emplace(file.lexically_normal(), entry);
  }
}

SceneArchive::~SceneArchive() = default;

void SceneArchive::extract(const std::filesystem::path& file,
                           const std::filesystem::path& destination) const {
  const std::uint64_t entry = m_files.at(file);
  const std::uint64_t size = m_zip->stat(entry, file).size;
  if (size > m_zip->unpackable)
    throw m_zip->error(file,
                       "and what was unpacked before have more bytes than a scene packs into "
                       "an archive of this size; save the scene again, or unpack it yourself");
  m_zip->unpackable -= size;
  const auto cannotUnpack = [&](int code) {
    return outputError(oneLine(destination.string()),
                       oneLine(file.string()) + " cannot be unpacked: " + systemMessage(code) +
                           "; " + writingMend(code, "set TMPDIR to another folder"));
  };
  std::error_code unknown;
  if (size > std::filesystem::space(destination.parent_path(), unknown).available && !unknown)
    throw cannotUnpack(ENOSPC);
  errno = 0;
  // Mode `in`: does not make the file again if the end of the process has removed it.
  std::ofstream out(destination, std::ios::binary | std::ios::in);
  m_zip->read(entry, file, size, [&](std::string_view chunk) {
    if (!out.write(chunk.data(), static_cast<std::streamsize>(chunk.size())))
      throw cannotUnpack(errno);
  });
  out.close();
  if (!out)
    throw cannotUnpack(errno);
}

std::string SceneArchive::text(const std::filesystem::path& file, std::uint64_t most) const {
  const std::uint64_t entry = m_files.at(file);
  const std::uint64_t size = m_zip->stat(entry, file).size;
  if (size > most)
    throw m_zip->error(file, "is larger than " + std::to_string(most >> 20) +
                                 " MB; save a smaller scene");
  std::string text;
  m_zip->read(entry, file, size, [&](std::string_view chunk) { text += chunk; });
  return text;
}

} // namespace fenestra
