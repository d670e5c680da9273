#include "files/formats/NrrdWriter.h"

#include "base/Text.h"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <limits>

namespace fenestra::core {

namespace {

static_assert(std::endian::native == std::endian::little, "samples are written in memory order");

/// Levels of compression: noise hardly compresses better with three times the work.
constexpr int labelLevel = 6, noiseLevel = 3;

/// "(x,y,z)" in LPS, whose first two axes are negated RAS; "+ 0.0" avoids "-0" in the header.
std::string formatLps(const Vec3& ras) {
  const Vec3 lps(-ras.x() + 0.0, -ras.y() + 0.0, ras.z() + 0.0);
  constexpr int exact = 17; // significant digits
  return '(' + joinNumbers(lps, ",", exact) + ')';
}

/// Appends `samples` as one gzip stream without name and time.
void appendGzip(std::string_view samples, int level, std::string& file) {
  constexpr int gzipWindow = 15 + 16, memory = 8; // + 16: gzip header
  z_stream stream = {};
  if (deflateInit2(&stream, level, Z_DEFLATED, gzipWindow, memory, Z_DEFAULT_STRATEGY) != Z_OK)
    throw std::bad_alloc();
  std::string part(1 << 18, '\0');
  for (int status = Z_OK; status == Z_OK;) {
    if (stream.avail_in == 0) {
      const std::size_t count =
          std::min<std::size_t>(samples.size(), std::numeric_limits<int>::max());
      stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(samples.data()));
      stream.avail_in = static_cast<unsigned>(count);
      samples.remove_prefix(count);
    }
    stream.next_out = reinterpret_cast<Bytef*>(part.data());
    stream.avail_out = static_cast<unsigned>(part.size());
    status = deflate(&stream, samples.empty() ? Z_FINISH : Z_NO_FLUSH);
    file.append(part, 0, part.size() - stream.avail_out);
  }
  deflateEnd(&stream);
}

} // namespace

std::string formatNrrdHeader(const NrrdHeader& header) {
  const bool hasLeadingAxis = !header.leadingKind.empty();
  const Mat3& axes = header.indexToWorld.linear();
  std::string text =
      concat("NRRD0004\n# Complete NRRD file format specification at:\n"
             "# http://teem.sourceforge.net/nrrd/format.html\ntype: ",
             header.type, "\ndimension: ", hasLeadingAxis ? 4 : 3,
             "\nspace: left-posterior-superior\nsizes: ",
             hasLeadingAxis ? concat(header.leadingCount, ' ') : "", joinNumbers(header.size, " "),
             "\nspace directions:", hasLeadingAxis ? " none" : "");
  for (int axis = 0; axis < 3; ++axis)
    text += ' ' + formatLps(axes.col(axis));
  text += concat("\nkinds:", hasLeadingAxis ? " " + header.leadingKind : "",
                 " domain domain domain\nendian: little\nencoding: ",
                 header.encoding == NrrdHeader::Encoding::gzip ? "gzip" : "raw",
                 "\nspace origin: ", formatLps(header.indexToWorld.translation()), '\n');
  for (const auto& [key, value] : header.fields)
    text += concat(key, ":=", value, '\n');
  return text + '\n';
}

std::string encodeNrrd(const NrrdHeader& header, std::string_view samples) {
  std::string file = formatNrrdHeader(header);
  if (header.encoding == NrrdHeader::Encoding::gzip)
    appendGzip(samples, header.type == "unsigned char" ? labelLevel : noiseLevel, file);
  else
    file += samples;
  return file;
}

} // namespace fenestra::core
