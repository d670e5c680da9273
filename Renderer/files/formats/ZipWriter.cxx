#include "files/formats/ZipWriter.h"

#include "base/Error.h"

#include <zip.h>

#include <memory>

namespace fenestra::core {

namespace {

constexpr zip_uint16_t dosTime = 0, dosDate = 0x21;   ///< 1980-01-01, the format's first day
constexpr zip_uint32_t readableFile = 0100644U << 16; ///< Unix mode, whatever the source's is

Error zipError(const std::filesystem::path& path, const std::string& reason) {
  return outputError(path, "cannot be created: ", reason, "; close other programs");
}

std::string readContent(zip_source_t* source, const std::filesystem::path& path) {
  zip_stat_t stat;
  if (zip_source_stat(source, &stat) != 0 || zip_source_open(source) != 0)
    throw zipError(path, zip_error_strerror(zip_source_error(source)));
  std::string content(stat.size, '\0');
  const zip_int64_t count = zip_source_read(source, content.data(), content.size());
  zip_source_close(source);
  if (count != static_cast<zip_int64_t>(content.size()))
    throw zipError(path, "its content cannot be read back");
  return content;
}

} // namespace

std::string encodeZip(const std::vector<ZipEntry>& entries, const std::string& comment,
                      const std::filesystem::path& path) {
  zip_error_t error;
  zip_error_init(&error);
  const std::unique_ptr<zip_source_t, void (*)(zip_source_t*)> source(
      zip_source_buffer_create(nullptr, 0, 0, &error), zip_source_free);
  std::unique_ptr<zip_t, void (*)(zip_t*)> archive(
      source ? zip_open_from_source(source.get(), ZIP_TRUNCATE, &error) : nullptr, zip_discard);
  if (!archive)
    throw zipError(path, zip_error_strerror(&error));
  zip_source_keep(source.get()); // closing the archive frees one reference
  const auto require = [&](bool isDone) {
    if (!isDone)
      throw zipError(path, zip_strerror(archive.get()));
  };
  for (const auto& [name, content] : entries) {
    zip_source_t* const bytes = zip_source_buffer(archive.get(), content.data(), content.size(), 0);
    require(bytes != nullptr);
    const zip_int64_t added = zip_file_add(archive.get(), name.c_str(), bytes, ZIP_FL_ENC_UTF_8);
    if (added < 0)
      zip_source_free(bytes);
    require(added >= 0);
    const auto at = static_cast<zip_uint64_t>(added);
    require(zip_set_file_compression(archive.get(), at, ZIP_CM_STORE, 0) == 0);
    require(zip_file_set_dostime(archive.get(), at, dosTime, dosDate, 0) == 0);
    require(zip_file_set_external_attributes(archive.get(), at, 0, ZIP_OPSYS_UNIX, readableFile) ==
            0);
  }
  require(zip_set_archive_comment(archive.get(), comment.data(),
                                  static_cast<zip_uint16_t>(comment.size())) == 0);
  require(zip_close(archive.get()) == 0);
  static_cast<void>(archive.release()); // zip_close has freed it
  return readContent(source.get(), path);
}

} // namespace fenestra::core
