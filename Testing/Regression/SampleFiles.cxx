#include "SampleFiles.h"

#include "Subject.h"

#include <zlib.h>

#include <bit>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <functional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <type_traits>

namespace fenestra::core::testing {
namespace {

constexpr double fieldOfView = 40.0; // mm, around the origin

/// Voxel grid in RAS, mm.
struct Axes {
  Size3 size;
  Mat3 steps; ///< column: step to the next voxel along that axis
  Vec3 first; ///< center of the first voxel

  Vec3 position(int i, int j, int k) const { return first + steps * Vec3(i, j, k); }
};

/// Grid along unit directions (columns of `directions`), centered at the origin, that fills the
/// field of view.
Axes makeAxes(const Mat3& directions, const Vec3& spacing) {
  Axes axes;
  axes.size = (fieldOfView / spacing.array()).round().cast<std::int64_t>();
  axes.steps = directions * Mat3::Diagonal(spacing);
  axes.first = -0.5 * (axes.steps * (axes.size - Size3::Ones()).cast<double>());
  return axes;
}

Mat3 makeColumns(const Vec3& a, const Vec3& b, const Vec3& c) {
  return {a, b, c};
}

const Mat3 identity = Mat3::Identity();

/// Rotation by 20 degrees about an oblique axis.
Mat3 makeTilt() {
  return makeRotation(0.35, Vec3(1.0, 2.0, -1.5).normalized()).linear();
}

// ---- samples

using Value = std::function<double(const Vec3&)>;

template <typename T>
std::string makeRawSamples(const Axes& axes, const std::vector<Value>& layers,
                           std::endian endian = std::endian::little) {
  std::string bytes;
  for (int k = 0; k < axes.size.z(); ++k)
    for (int j = 0; j < axes.size.y(); ++j)
      for (int i = 0; i < axes.size.x(); ++i)
        for (const Value& layer : layers) {
          const double exact = layer(axes.position(i, j, k));
          const T sample = static_cast<T>(std::is_integral_v<T> ? std::round(exact) : exact);
          std::array<char, sizeof(T)> one;
          std::memcpy(one.data(), &sample, sizeof(T));
          if (endian != std::endian::native)
            std::reverse(one.begin(), one.end());
          bytes.append(one.data(), one.size());
        }
  return bytes;
}

std::string makeTextSamples(const Axes& axes, const Value& value) {
  std::ostringstream text;
  for (int k = 0; k < axes.size.z(); ++k)
    for (int j = 0; j < axes.size.y(); ++j)
      for (int i = 0; i < axes.size.x(); ++i)
        text << std::lround(value(axes.position(i, j, k))) << (i + 1 < axes.size.x() ? ' ' : '\n');
  return text.str();
}

std::string compressGzip(const std::string& bytes) {
  z_stream stream{};
  constexpr int gzipFormat = 15 + 16; // window bits, + 16: gzip header
  if (deflateInit2(&stream, 9, Z_DEFLATED, gzipFormat, 8, Z_DEFAULT_STRATEGY) != Z_OK)
    throw std::runtime_error("deflateInit2 failed");
  std::string result(deflateBound(&stream, bytes.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(result.data());
  stream.avail_out = static_cast<uInt>(result.size());
  const int status = deflate(&stream, Z_FINISH);
  result.resize(stream.total_out);
  deflateEnd(&stream);
  if (status != Z_STREAM_END)
    throw std::runtime_error("deflate failed");
  return result;
}

// ---- NRRD

struct Nrrd {
  std::string type;
  Axes axes;
  std::string space = "left-posterior-superior";
  std::string encoding = "raw";
  std::string endian = "little";
  int layers = 1;
  std::string more = {}; ///< further lines
};

std::string formatTriple(const Vec3& v) {
  std::ostringstream text;
  text.precision(17);
  text << '(' << v.x() << ',' << v.y() << ',' << v.z() << ')';
  return text.str();
}

/// NRRD header without the empty line at its end.
std::string makeHeader(const Nrrd& nrrd) {
  const Vec3 toSpace =
      nrrd.space == "right-anterior-superior" ? Vec3(1.0, 1.0, 1.0) : Vec3(-1.0, -1.0, 1.0);
  const bool list = nrrd.layers > 1;
  std::ostringstream text;
  text << "NRRD0004\n# made by Fenestra's tests\ntype: " << nrrd.type
       << "\ndimension: " << (list ? 4 : 3) << "\nspace: " << nrrd.space << "\nsizes:";
  if (list)
    text << ' ' << nrrd.layers;
  text << ' ' << nrrd.axes.size << "\nspace directions:" << (list ? " none" : "");
  for (int axis = 0; axis < 3; ++axis)
    text << ' ' << formatTriple(nrrd.axes.steps.col(axis).cwiseProduct(toSpace));
  text << "\nkinds:" << (list ? " list" : "") << " domain domain domain\n";
  if (nrrd.encoding != "ascii")
    text << "endian: " << nrrd.endian << '\n';
  text << "encoding: " << nrrd.encoding
       << "\nspace origin: " << formatTriple(nrrd.axes.first.cwiseProduct(toSpace)) << '\n'
       << nrrd.more;
  return text.str();
}

void write(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream file(path, std::ios::binary);
  file << bytes;
  file.close();
  if (!file)
    throw std::runtime_error(path.string() + ": cannot be written");
}

/// Writes the subject plus `offset` as a volume.
template <typename T>
void writeVolume(const std::filesystem::path& path, const Nrrd& nrrd, double offset = 0.0) {
  const Value value = [offset](const Vec3& p) { return subject(p) + offset; };
  std::string samples;
  if (nrrd.encoding == "ascii")
    samples = makeTextSamples(nrrd.axes, value);
  else
    samples = makeRawSamples<T>(nrrd.axes, {value},
                                nrrd.endian == "big" ? std::endian::big : std::endian::little);
  if (nrrd.encoding == "gzip")
    samples = compressGzip(samples);
  const bool isDetached = path.extension() == ".nhdr";
  write(path, makeHeader(nrrd) + (isDetached ? "" : "\n" + samples));
  if (isDetached)
    write(std::filesystem::path(path).replace_extension(".raw"), samples);
}

// ---- format variants

/// Writes volumes with different directions and spacings of their axes. `s`: spacing, mm.
void writeGeometries(const std::filesystem::path& folder, double s) {
  const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ(), cube = Vec3::Constant(s);
  writeVolume<std::uint8_t>(folder / "plain.nrrd", {"uint8", makeAxes(identity, cube)});
  writeVolume<std::uint8_t>(folder / "oblique.nrrd", {"uint8", makeAxes(makeTilt(), cube)});
  writeVolume<std::uint8_t>(folder / "flipped.nrrd",
                            {"uint8", makeAxes(makeColumns(x, -y, z), cube)});
  writeVolume<std::uint8_t>(
      folder / "permuted.nrrd",
      {"uint8", makeAxes(makeColumns(-z, x, -y), Vec3(s, 1.5 * s, 0.75 * s))});
  writeVolume<std::uint8_t>(folder / "anisotropic.nrrd",
                            {"uint8", makeAxes(identity, Vec3(0.5 * s, s, 2.0 * s))});
  writeVolume<std::uint8_t>(folder / "ras.nrrd",
                            {"uint8", makeAxes(identity, cube), "right-anterior-superior"});
  Axes sheared = makeAxes(identity, cube);
  sheared.steps.col(2) += 0.3 * s * y; // as by a tilted gantry
  sheared.first = -0.5 * (sheared.steps * (sheared.size - Size3::Ones()).cast<double>());
  writeVolume<std::uint8_t>(folder / "sheared.nrrd", {"uint8", sheared});
}

/// Writes volumes of every sample type and encoding.
void writeEncodings(const std::filesystem::path& folder, double s) {
  const Axes axes = makeAxes(identity, Vec3::Constant(s));
  const std::string lps = "left-posterior-superior";
  writeVolume<std::int16_t>(folder / "int16.nrrd", {"int16", axes}, -1024.0);
  writeVolume<std::uint16_t>(folder / "uint16.nrrd", {"uint16", axes}, 40000.0);
  writeVolume<std::int32_t>(folder / "int32.nrrd", {"int32", axes}, 100000.0);
  writeVolume<float>(folder / "float.nrrd", {"float", axes}, 0.25);
  writeVolume<double>(folder / "double.nrrd", {"double", axes, lps, "gzip"}, 0.25);
  writeVolume<std::int16_t>(folder / "bigendian.nrrd", {"int16", axes, lps, "raw", "big"}, -1024.0);
  writeVolume<std::int16_t>(folder / "gzip.nrrd", {"int16", axes, lps, "gzip"}, -1024.0);
  writeVolume<std::uint8_t>(folder / "ascii.nrrd", {"uint8", axes, lps, "ascii"});
  writeVolume<std::int16_t>(folder / "detached.nhdr",
                            {"int16", axes, lps, "raw", "little", 1, "data file: detached.raw\n"},
                            -1024.0);
}

std::string makeSegmentFields(int n, const std::string& id, int label, int layer) {
  std::ostringstream text;
  const std::string key = "Segment" + std::to_string(n) + "_";
  text << key << "ID:=" << id << '\n'
       << key << "Name:=" << id << " of the subject\n"
       << key << "Color:=0.9 0." << n << " 0.2\n"
       << key << "LabelValue:=" << label << '\n'
       << key << "Layer:=" << layer << '\n'
       << key << "Extent:=0 1 0 1 0 1\n"
       << key << "Tags:=Segmentation.Status:inprogress|TerminologyEntry:a~b^c|\n";
  return text.str();
}

Value makeLabels(std::vector<std::pair<double (*)(const Vec3&), int>> organs) {
  return [organs](const Vec3& p) {
    for (const auto& [organ, label] : organs)
      if (organ(p) < 0.0)
        return static_cast<double>(label);
    return 0.0;
  };
}

void writeSegments(const std::filesystem::path& folder, double s) {
  const std::string common = "Segmentation_ContainedRepresentationNames:=Binary labelmap|\n"
                             "Segmentation_MasterRepresentation:=Binary labelmap\n";
  // Overlapping segments: two layers use the same label value; the grid differs from the volume's.
  const Axes fine = makeAxes(identity, Vec3::Constant(0.8 * s));
  Nrrd layers{"uint8",
              fine,
              "left-posterior-superior",
              "gzip",
              "little",
              2,
              makeSegmentFields(0, "Liver", 1, 0) + makeSegmentFields(1, "Heart", 1, 1) +
                  makeSegmentFields(2, "Tumour", 7, 0) + common +
                  "Segmentation_ReferenceImageExtentOffset:=0 0 0\n"};
  const auto both = makeRawSamples<std::uint8_t>(
      fine, {makeLabels({{liver, 1}, {tumor, 7}}), makeLabels({{heart, 1}, {tumor, 2}})});
  write(folder / "layers.seg.nrrd", makeHeader(layers) + "\n" + compressGzip(both));

  // A part of the volume's grid. Its origin already includes the extent offset.
  Axes part = makeAxes(identity, Vec3::Constant(s));
  const Size3 offset = part.size / 2;
  part.first = part.position(static_cast<int>(offset.x()), static_cast<int>(offset.y()), 0);
  part.size -= Size3(offset.x(), offset.y(), 0);
  std::ostringstream where;
  where << "Segmentation_ReferenceImageExtentOffset:=" << offset.x() << ' ' << offset.y() << " 0\n";
  Nrrd cropped{"int16",
               part,
               "left-posterior-superior",
               "raw",
               "little",
               1,
               makeSegmentFields(0, "Liver", 300, 0) + common + where.str()};
  write(folder / "cropped.seg.nrrd",
        makeHeader(cropped) + "\n" +
            makeRawSamples<std::int16_t>(part, {makeLabels({{liver, 300}})}));

  // Label map without segment names, with gaps between its values.
  const Axes tilt = makeAxes(makeTilt(), Vec3::Constant(s));
  write(folder / "labels.nrrd",
        makeHeader({"uint8", tilt}) + "\n" +
            makeRawSamples<std::uint8_t>(tilt, {makeLabels({{liver, 3}, {heart, 200}})}));
}

} // namespace

void writeFormatVariants(const std::filesystem::path& folder, double spacing) {
  writeGeometries(folder, spacing);
  writeEncodings(folder, spacing);
  writeSegments(folder, spacing);
}

} // namespace fenestra::core::testing
