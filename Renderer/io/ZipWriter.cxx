#include "io/ZipWriter.h"

#include "core/Error.h"
#include "io/AtomicFile.h"

#include <zip.h>

#include <memory>

namespace fenestra {

namespace {

constexpr zip_uint16_t dosTime = 0, dosDate = 0x21;   ///< 1980-01-01, the format's first day
constexpr zip_uint32_t readableFile = 0100644U << 16; ///< a Unix mode, whatever the source's is

struct DiscardZip {
  void operator()(zip_t* archive) const { zip_discard(archive); }
};

Error zipError(const std::filesystem::path& path, const std::string& reason) {
  return outputError(path.string(),
                     "cannot be written whole: " + reason + "; free some space on its disk");
}

/// What the content refers to lives until the archive is closed.
struct SourceOf {
  zip_t* archive;

  zip_source_t* operator()(const std::filesystem::path& file) const {
    return zip_source_file(archive, file.c_str(), 0, -1);
  }
  zip_source_t* operator()(const std::string& text) const {
    return zip_source_buffer(archive, text.data(), text.size(), 0);
  }
};

void addEntry(zip_t* archive, const ZipEntry& entry, const std::filesystem::path& path) {
  const auto fail = [&] { return zipError(path, zip_strerror(archive)); };
  zip_source_t* source = std::visit(SourceOf{archive}, entry.content);
  if (!source)
    throw fail();
  const zip_int64_t index = zip_file_add(archive, entry.name.c_str(), source, ZIP_FL_ENC_UTF_8);
  if (index < 0) {
    zip_source_free(source);
    throw fail();
  }
  const auto at = static_cast<zip_uint64_t>(index);
  if (zip_set_file_compression(archive, at, ZIP_CM_STORE, 0) != 0 ||
      zip_file_set_dostime(archive, at, dosTime, dosDate, 0) != 0 ||
      zip_file_set_external_attributes(archive, at, 0, ZIP_OPSYS_UNIX, readableFile) != 0)
    throw fail();
}

} // namespace

void writeZip(const std::filesystem::path& path, const std::vector<ZipEntry>& entries) {
  AtomicFile file(path);
  int code = 0;
  std::unique_ptr<zip_t, DiscardZip> archive(
      zip_open(file.temporaryPath().c_str(), ZIP_CREATE | ZIP_TRUNCATE, &code));
  if (!archive) {
    zip_error_t error;
    zip_error_init_with_code(&error, code);
    const std::string reason = zip_error_strerror(&error);
    zip_error_fini(&error);
    throw zipError(path, reason);
  }
  for (const ZipEntry& entry : entries)
    addEntry(archive.get(), entry, path);
  if (zip_close(archive.get()) != 0)
    throw zipError(path, zip_strerror(archive.get()));
  static_cast<void>(archive.release()); // closed: freed
  file.commit();
}

} // namespace fenestra
