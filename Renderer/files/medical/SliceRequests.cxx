// What the child process of SliceReader does.

#include "files/medical/SliceFile.h"

#include <png.h>
#include <tiffio.h>

#include <bit>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <memory>
#include <optional>
#include <vector>

namespace fenestra::core {
namespace {

/// A page as its file describes it.
struct Page {
  SliceProblem problem = SliceProblem::none;
  SliceHeader header = {};
};

/// Sets the type, and the problem if it is not supported or the slice is too large.
void setType(Page& page, const std::optional<std::size_t>& type) {
  if (page.problem != SliceProblem::none)
    return;
  if (!type) {
    page.problem = SliceProblem::depth;
    return;
  }
  page.header.type = *type;
  const std::uint64_t most = maxSliceBytes / bytesPerSample(sliceTypes[*type]);
  if (page.header.rows > 0 && page.header.columns > most / page.header.rows)
    page.problem = SliceProblem::large;
}

// ---- PNG

class PngFile {
public:
  explicit PngFile(const std::string& path)
      : m_file(std::fopen(path.c_str(), "rb")),
        m_png(png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, failSilently, ignoreWarning)),
        m_info(png_create_info_struct(m_png)) {}
  ~PngFile() {
    png_destroy_read_struct(&m_png, &m_info, nullptr);
    if (m_file)
      std::fclose(m_file);
  }
  PngFile(const PngFile&) = delete;
  PngFile& operator=(const PngFile&) = delete;

  /// False: not a PNG. libpng reports errors by longjmp: nothing in this function, or in
  /// readRows, has a destructor.
  bool readInfo() {
    if (!m_file || !m_png || !m_info || setjmp(png_jmpbuf(m_png)) != 0)
      return false;
    png_init_io(m_png, m_file);
    png_set_user_limits(m_png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    png_read_info(m_png, m_info);
    return true;
  }

  Page describe() const {
    Page page;
    page.header.columns = png_get_image_width(m_png, m_info);
    page.header.rows = png_get_image_height(m_png, m_info);
    const auto color = png_get_color_type(m_png, m_info);
    if (color == PNG_COLOR_TYPE_GRAY_ALPHA)
      page.problem = SliceProblem::alpha;
    else if (color != PNG_COLOR_TYPE_GRAY)
      page.problem = SliceProblem::color;
    const int bits = png_get_bit_depth(m_png, m_info);
    setType(page, bits == 8    ? std::optional<std::size_t>(0)
                  : bits == 16 ? std::optional<std::size_t>(2)
                               : std::nullopt);
    return page;
  }

  /// Reads all rows, also of an interlaced image, and checks the sums of the whole file.
  bool readRows(png_bytep* rows) {
    if (setjmp(png_jmpbuf(m_png)) != 0)
      return false;
    if constexpr (std::endian::native == std::endian::little)
      png_set_swap(m_png); // of 16-bit samples only
    png_read_image(m_png, rows);
    png_read_end(m_png, nullptr);
    return true;
  }

private:
  [[noreturn]] static void failSilently(png_structp png, png_const_charp) { png_longjmp(png, 1); }
  static void ignoreWarning(png_structp, png_const_charp) {}

  std::FILE* m_file;
  png_structp m_png;
  png_infop m_info;
};

std::optional<Page> describePng(const std::string& path) {
  PngFile file(path);
  return file.readInfo() ? std::optional(file.describe()) : std::nullopt;
}

std::string readPng(const std::string& path) {
  PngFile file(path);
  if (!file.readInfo())
    return {};
  const auto [problem, header] = file.describe();
  if (problem != SliceProblem::none)
    return {};
  std::string samples(header.bytes(), '\0');
  std::vector<png_bytep> rows(header.rows);
  for (std::size_t row = 0; row < rows.size(); ++row)
    rows[row] = reinterpret_cast<png_bytep>(&samples[row * (samples.size() / rows.size())]);
  return file.readRows(rows.data()) ? samples : std::string();
}

// ---- TIFF

std::uint32_t readField(TIFF* tiff, std::uint32_t tag) {
  std::uint16_t value = 0;
  TIFFGetFieldDefaulted(tiff, tag, &value);
  return value;
}

SliceProblem findProblem(TIFF* tiff) {
  const auto samples = readField(tiff, TIFFTAG_SAMPLESPERPIXEL);
  const auto photometric = readField(tiff, TIFFTAG_PHOTOMETRIC);
  if (photometric != PHOTOMETRIC_MINISBLACK && photometric != PHOTOMETRIC_MINISWHITE)
    return SliceProblem::color;
  if (samples != 1)
    return samples == 2 ? SliceProblem::alpha : SliceProblem::color;
  if (photometric == PHOTOMETRIC_MINISWHITE)
    return SliceProblem::inverted;
  if (TIFFIsTiled(tiff))
    return SliceProblem::tiled;
  return readField(tiff, TIFFTAG_ORIENTATION) == ORIENTATION_TOPLEFT ? SliceProblem::none
                                                                     : SliceProblem::orientation;
}

std::optional<std::size_t> findType(TIFF* tiff) {
  const auto bits = readField(tiff, TIFFTAG_BITSPERSAMPLE);
  const auto format = readField(tiff, TIFFTAG_SAMPLEFORMAT);
  if (bits == 32 && format == SAMPLEFORMAT_IEEEFP)
    return 4;
  if ((bits != 8 && bits != 16) || (format != SAMPLEFORMAT_UINT && format != SAMPLEFORMAT_INT))
    return std::nullopt;
  return (bits == 16 ? 2U : 0U) + (format == SAMPLEFORMAT_INT ? 1U : 0U);
}

std::optional<Page> describeTiff(TIFF* tiff) {
  Page page;
  if (!tiff || !TIFFGetField(tiff, TIFFTAG_IMAGEWIDTH, &page.header.columns) ||
      !TIFFGetField(tiff, TIFFTAG_IMAGELENGTH, &page.header.rows))
    return std::nullopt;
  page.header.isLast = TIFFLastDirectory(tiff) != 0;
  page.problem = findProblem(tiff);
  setType(page, findType(tiff));
  return page;
}

std::string readTiff(TIFF* tiff) {
  const std::optional<Page> page = describeTiff(tiff);
  if (!page || page->problem != SliceProblem::none || page->header.bytes() == 0)
    return {};
  std::string samples(page->header.bytes(), '\0');
  const std::size_t rowBytes = samples.size() / page->header.rows;
  if (static_cast<std::size_t>(TIFFScanlineSize(tiff)) != rowBytes)
    return {};
  for (std::uint32_t row = 0; row < page->header.rows; ++row)
    if (TIFFReadScanline(tiff, &samples[row * rowBytes], row) != 1)
      return {};
  return samples;
}

// ---- requests

std::string makeHeaderReply(const std::optional<Page>& page) {
  if (!page)
    return {};
  const SliceHeader& header = page->header;
  ReplyWriter reply;
  reply.put(std::vector<double>{static_cast<double>(page->problem),
                                static_cast<double>(header.columns),
                                static_cast<double>(header.rows), static_cast<double>(header.type),
                                header.isLast ? 1.0 : 0.0});
  return reply.bytes();
}

/// Handles the requests to one reader. A TIFF file stays open for the next requests, which mostly
/// concern its next page.
class SliceHandler {
public:
  std::string operator()(const std::string& request) {
    std::uint32_t page = 0;
    std::memcpy(&page, request.data() + 1, sizeof page);
    const std::string path = request.substr(1 + sizeof page);
    const bool asksHeader = request[0] == sliceHeaderRequest;
    if (!isTiff(path))
      return asksHeader ? makeHeaderReply(describePng(path)) : readPng(path);
    TIFF* const tiff = openPage(path, page);
    return asksHeader ? makeHeaderReply(describeTiff(tiff)) : readTiff(tiff);
  }

private:
  /// The file at this page; null: there is none.
  TIFF* openPage(const std::string& path, std::uint32_t page) {
    if (!m_file || m_path != path) {
      TIFFSetErrorHandler(nullptr);
      TIFFSetWarningHandler(nullptr);
      m_file.reset();
      if (TIFF* const file = TIFFOpen(path.c_str(), "rm")) // "m": without memory mapping
        m_file.reset(file, TIFFClose);
      m_path = path;
      m_page = 0;
    }
    const bool isThere =
        m_file &&
        (page == m_page ||
         (page == m_page + 1 ? TIFFReadDirectory(m_file.get())
                             : TIFFSetDirectory(m_file.get(), static_cast<tdir_t>(page))) == 1);
    m_page = page;
    if (!isThere)
      m_file.reset();
    return m_file.get();
  }

  std::string m_path;
  std::shared_ptr<TIFF> m_file; ///< null: none; copies of this object have none
  std::uint32_t m_page = 0;
};

} // namespace

const SandboxJob sliceJob("slices", SliceHandler(), {.seconds = 30});

} // namespace fenestra::core
