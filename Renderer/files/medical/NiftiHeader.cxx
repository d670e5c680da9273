#include "files/medical/NiftiHeader.h"

#include "base/Error.h"
#include "base/Text.h"
#include "files/medical/MedicalHeader.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <utility>

namespace fenestra::core {
namespace {

/// Byte offsets of fields.
struct NiftiLayout {
  std::size_t axes, type, pixdim, offset, slope, intercept, units, qformCode, sformCode, quaternion,
      quaternionOffset, rows, magic;
};
constexpr NiftiLayout layout1 = {40, 70, 76, 108, 112, 116, 123, 252, 254, 256, 268, 280, 344};
constexpr NiftiLayout layout2 = {16, 12, 104, 168, 176, 184, 500, 344, 348, 352, 376, 400, 4};

/// Access to the fields of nifti_1_header and nifti_2_header, whose numbers are wider.
class NiftiFields {
public:
  NiftiFields(std::string_view bytes, const std::filesystem::path& path)
      : m_bytes(bytes), m_path(path), m_isWide(countNiftiHeaderBytes(bytes) == nifti2Bytes) {
    m_swapped = m_isWide && number<std::int32_t>(0) != nifti2Bytes;
    const std::int64_t axes = size(0); // reveals the byte order
    m_swapped = m_swapped || (!m_isWide && (axes < 1 || axes > 7));
  }

  const NiftiLayout& at() const { return m_isWide ? layout2 : layout1; }
  std::size_t byteCount() const { return m_isWide ? nifti2Bytes : nifti1Bytes; }

  template <typename T>
  T number(std::size_t place) const {
    T value;
    std::memcpy(&value, &m_bytes[place], sizeof(T));
    if (m_swapped)
      swapBytes(value);
    return value;
  }
  /// Number of axes, then their sizes.
  std::int64_t size(std::size_t axis) const {
    return m_isWide ? number<std::int64_t>(at().axes + 8 * axis)
                    : number<std::int16_t>(at().axes + 2 * axis);
  }
  int code(std::size_t place) const {
    return m_isWide ? number<std::int32_t>(place) : number<std::int16_t>(place);
  }
  /// The i-th number of an array.
  double real(std::size_t place, std::size_t i = 0) const {
    return m_isWide ? number<double>(place + 8 * i) : number<float>(place + 4 * i);
  }
  Vec3 triple(std::size_t place, std::size_t i = 0) const {
    return {real(place, i), real(place, i + 1), real(place, i + 2)};
  }
  Vec3 row(std::size_t row) const { return triple(at().rows, 4 * row); }
  Vec3 rowOffsets() const { return {real(at().rows, 3), real(at().rows, 7), real(at().rows, 11)}; }
  double offset() const {
    return m_isWide ? static_cast<double>(number<std::int64_t>(at().offset)) : real(at().offset);
  }
  int units() const {
    return m_isWide ? number<std::int32_t>(at().units) : number<char>(at().units);
  }

  /// True if the first `count` numbers of an array are finite and below 1e9.
  bool hasFiniteNumbers(std::size_t place, std::size_t count) const {
    for (std::size_t i = 0; i < count; ++i)
      if (!(std::abs(real(place, i)) < 1e9))
        return false;
    return true;
  }

  bool isSwapped() const { return m_swapped; }
  /// The first three letters: "n+1" for one file, "ni1" for a pair, with a 2 in NIfTI-2; anything
  /// else in Analyze.
  std::string_view magic() const { return m_bytes.substr(at().magic, 3); }
  bool isOneFile() const { return magic() == (m_isWide ? "n+2" : "n+1"); }
  bool isAnalyze() const { return !m_isWide && magic() != "n+1" && magic() != "ni1"; }
  const std::filesystem::path& path() const { return m_path; }

private:
  std::string_view m_bytes;
  const std::filesystem::path& m_path;
  bool m_isWide = false, m_swapped = false;
};

std::vector<std::int64_t> readNiftiSize(const NiftiFields& fields) {
  std::vector<std::int64_t> size;
  const std::int64_t axes = fields.size(0);
  for (std::size_t axis = 1; axes <= 7 && std::cmp_less_equal(axis, axes); ++axis)
    size.push_back(fields.size(axis));
  return size;
}

SampleType readNiftiType(const NiftiFields& fields) {
  static const std::map<int, SampleType> types = {// NIFTI_TYPE_… of nifti1.h
                                                  {2, std::uint8_t()},    {4, std::int16_t()},
                                                  {8, std::int32_t()},    {16, float()},
                                                  {64, double()},         {256, std::int8_t()},
                                                  {512, std::uint16_t()}, {768, std::uint32_t()},
                                                  {1024, std::int64_t()}, {1280, std::uint64_t()}};
  const int code = fields.number<std::int16_t>(fields.at().type);
  if (code == 128 || code == 2304) // RGB24, RGBA32
    throw inputError(ErrorCode::unsupportedFile, fields.path(),
                     "is a color image; convert it to one scalar per voxel");
  if (code == 32 || code == 1792 || code == 2048) // of floats of 32, 64 and 128 bits
    throw inputError(ErrorCode::unsupportedFile, fields.path(),
                     "has complex numbers; save their magnitude as a volume");
  const auto type = types.find(code);
  if (type == types.end())
    throw fieldError(fields.path(), "datatype", code,
                     " is not a real scalar type; convert it to 16-bit integers");
  return type->second;
}

/// Slope and intercept; nullopt: no rescaling, as a slope of 0 or NaN means.
std::optional<Rescaling> readNiftiRescaling(const NiftiFields& fields) {
  const double slope = fields.real(fields.at().slope),
               intercept = fields.real(fields.at().intercept);
  if (std::isnan(slope) || slope == 0.0)
    return std::nullopt;
  if (!std::isfinite(slope) || !std::isfinite(intercept))
    throw fieldError(fields.path(), "scl_slope or scl_inter", "is not finite; write them again");
  if (slope == 1.0 && intercept == 0.0)
    return std::nullopt;
  return Rescaling{slope, intercept};
}

// ---- geometry

/// Orthogonal matrix nearest to one with unit columns: its polar factor, by Newton's iteration
/// (Higham, Computing the polar decomposition, 1986).
Mat3 findNearestOrthogonal(Mat3 matrix) {
  for (int i = 0; i < 12; ++i) {
    const Mat3 inverse = matrix.inverse().transpose();
    for (int column = 0; column < 3; ++column)
      matrix.col(column) = 0.5 * (matrix.col(column) + inverse.col(column));
  }
  return matrix;
}

/// Rows of the sform without the offset.
Mat3 readSformAxes(const NiftiFields& fields) {
  return Mat3::FromRows(fields.row(0), fields.row(1), fields.row(2));
}

/// Largest distance of a unit axis from the nearest right-angled one; infinity: the axes are
/// linearly dependent.
double measureShear(const Mat3& linear) {
  constexpr double minDeterminant = 1e-6;
  const Mat3 axes = linear.normalizedColumns();
  if (!(std::abs(axes.determinant()) > minDeterminant))
    return infinity;
  const Mat3 nearest = findNearestOrthogonal(axes);
  double shear = 0.0;
  for (int column = 0; column < 3; ++column)
    shear = std::max(shear, (axes.col(column) - nearest.col(column)).norm());
  return shear;
}

constexpr double mostShear = 1e-3; // rounding

Affine readSform(const NiftiFields& fields, const Vec3& pixdim) {
  const Mat3 linear = readSformAxes(fields);
  const double shear = measureShear(linear);
  if (shear == infinity)
    throw fieldError(fields.path(), "srow", "the axes are linearly dependent; fix the header");
  const Vec3 offset = fields.rowOffsets();
  if (!(shear < mostShear)) // as of a tilted gantry
    return Affine(linear, offset);
  const Mat3 nearest = findNearestOrthogonal(linear.normalizedColumns());
  // If pixdim agrees, it states the spacing without the rounding of the rows.
  Vec3 spacing = linear.columnNorms();
  for (int axis = 0; axis < 3; ++axis)
    if (std::abs(spacing[axis] - pixdim[axis]) < 1e-5 * pixdim[axis])
      spacing[axis] = pixdim[axis];
  return Affine(nearest * Mat3::Diagonal(spacing), offset);
}

Affine readQform(const NiftiFields& fields, const Vec3& pixdim) {
  Vec3 v = fields.triple(fields.at().quaternion);
  double a = 1.0 - v.squaredNorm();
  if (a < 1e-7) { // rounding of a rotation by 180 degrees
    v = (1.0 / v.norm()) * v;
    a = 0.0;
  }
  a = std::sqrt(a);
  const double b = v[0], c = v[1], d = v[2];
  const Mat3 rotation(
      Vec3(a * a + b * b - c * c - d * d, 2.0 * (b * c + a * d), 2.0 * (b * d - a * c)),
      Vec3(2.0 * (b * c - a * d), a * a + c * c - b * b - d * d, 2.0 * (c * d + a * b)),
      Vec3(2.0 * (b * d + a * c), 2.0 * (c * d - a * b), a * a + d * d - b * b - c * c));
  const double handedness = fields.real(fields.at().pixdim) < 0.0 ? -1.0 : 1.0; // qfac
  return Affine(rotation * Mat3::Diagonal({pixdim[0], pixdim[1], handedness * pixdim[2]}),
                fields.triple(fields.at().quaternionOffset));
}

/// Millimeters per unit of length of the header.
double readUnitMm(const NiftiFields& fields) {
  const int code = fields.units() & 7; // xyzt_units: m, mm, µm
  return code == 1 ? 1000.0 : code == 3 ? 0.001 : 1.0;
}

/// Largest distance between the positions of a corner of the image in both forms, in the units of
/// the header. The sform may be sheared.
double measureDisagreement(const NiftiFields& fields, const Affine& qform) {
  const Affine sform(readSformAxes(fields), fields.rowOffsets());
  Vec3 last = Vec3::Zero();
  const std::vector<std::int64_t> size = readNiftiSize(fields);
  for (std::size_t axis = 0; axis < std::min<std::size_t>(size.size(), 3); ++axis)
    last[static_cast<int>(axis)] = static_cast<double>(size[axis]) - 1.0;
  double most = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 voxel((corner & 1) * last[0], (corner >> 1 & 1) * last[1], (corner >> 2) * last[2]);
    most = std::max(most, (sform * voxel - qform * voxel).norm());
  }
  return most;
}

/// The form that places the image if both are given: the chosen one, else the sform, if its axes
/// are not linearly dependent. A guess is reported if the forms disagree by more than half a voxel.
Affine chooseForm(const NiftiFields& fields, const Vec3& pixdim, const VolumeChoice& choice,
                  NiftiHeader& header) {
  const Affine qform = readQform(fields, pixdim);
  const bool isFlat = measureShear(readSformAxes(fields)) == infinity;
  const NiftiForm form = choice.niftiForm.value_or(isFlat ? NiftiForm::qform : NiftiForm::sform);
  const double apart = measureDisagreement(fields, qform);
  const bool isGuess = !choice.niftiForm || !choice.formReason.empty();
  if (isGuess && apart > 0.5 * pixdim.minCoeff()) {
    const std::string reason = !choice.formReason.empty()
                                   ? "since only it agrees with " + choice.formReason
                               : isFlat ? "since the axes of the sform are linearly dependent"
                                        : "as in FSL, SPM and nibabel (3D Slicer uses the qform)";
    header.warnings.push_back(makeMessage(
        ErrorCode::assumedForm, fields.path(), "qform and sform place its corners up to ",
        toString(apart * readUnitMm(fields), 3), " mm apart; the ",
        form == NiftiForm::qform ? "qform" : "sform", " is used, ", reason));
    if (!isFlat)
      header.qformToRas = qform;
  }
  return form == NiftiForm::qform ? qform : readSform(fields, pixdim);
}

Vec3 readVoxelSize(const NiftiFields& fields) {
  Vec3 size = fields.triple(fields.at().pixdim, 1);
  for (int axis = 0; axis < 3; ++axis)
    size[axis] = size[axis] == 0.0 ? 1.0 : std::abs(size[axis]);
  return size;
}

/// Axes toward left, anterior and superior, centered at the origin.
void assumeAnalyzeGeometry(const NiftiFields& fields, NiftiHeader& header) {
  if (!fields.hasFiniteNumbers(fields.at().pixdim, 4))
    throw fieldError(fields.path(), "pixdim", "has a number that is not finite; write it again");
  const Vec3 voxel = readVoxelSize(fields);
  const Mat3 linear = Mat3::Diagonal({-voxel[0], voxel[1], voxel[2]});
  Vec3 last = Vec3::Zero();
  for (std::size_t axis = 0; axis < std::min<std::size_t>(header.size.size(), 3); ++axis)
    last[static_cast<int>(axis)] = static_cast<double>(header.size[axis]) - 1.0;
  header.indexToRas = Affine(linear, Vec3(Vec3::Zero() - 0.5 * (linear * last)));
  header.warnings.push_back(makeMessage(
      ErrorCode::assumedGeometry, fields.path(),
      "is an Analyze image, which states no axes; they are taken as left, anterior and superior, "
      "centered at the origin, as in SPM"));
}

/// Sets the geometry of the header.
void readNiftiGeometry(const NiftiFields& fields, const VolumeChoice& choice, NiftiHeader& header) {
  const NiftiLayout& at = fields.at();
  const int qform = fields.code(at.qformCode), sform = fields.code(at.sformCode);
  // pixdim, quaternion and offset, rows of the sform
  if (!fields.hasFiniteNumbers(at.pixdim, 4) ||
      (qform > 0 && !fields.hasFiniteNumbers(at.quaternion, 6)) ||
      (sform > 0 && !fields.hasFiniteNumbers(at.rows, 12)))
    throw fieldError(fields.path(), "qform, sform or pixdim",
                     "has a number that is not finite or "
                     "exceeds 1e9 mm; write it again");
  const Vec3 pixdim = readVoxelSize(fields);
  if (sform <= 0 && fields.triple(at.pixdim, 1).cwiseAbs().minCoeff() == 0.0)
    header.warnings.push_back(makeMessage(ErrorCode::assumedGeometry, fields.path(),
                                          "has no spacing along an axis: 1 mm is assumed"));
  const auto form = choice.niftiForm;
  if (form && (form == NiftiForm::qform ? qform : sform) <= 0)
    throw inputError(ErrorCode::unknownForm, fields.path(), "has no ",
                     form == NiftiForm::qform ? "qform" : "sform");
  Affine map(lpsToRas * Mat3::Diagonal(pixdim));
  if (qform > 0 && sform > 0)
    map = chooseForm(fields, pixdim, choice, header);
  else if (sform > 0)
    map = readSform(fields, pixdim);
  else if (qform > 0)
    map = readQform(fields, pixdim);
  else
    header.warnings.push_back(
        makeMessage(ErrorCode::assumedGeometry, fields.path(),
                    "has no qform or sform; voxels are placed along LPS axes from the origin"));
  const double unit = readUnitMm(fields);
  const auto toMm = [unit](const Affine& form) {
    return Affine(form.linear() * Mat3::Diagonal(Vec3::Constant(unit)), unit * form.translation());
  };
  header.indexToRas = toMm(map);
  if (header.qformToRas)
    header.qformToRas = toMm(*header.qformToRas);
}

} // namespace

std::size_t countNiftiHeaderBytes(std::string_view start) {
  std::int32_t bytes = 0;
  std::memcpy(&bytes, start.data(), sizeof bytes);
  if (bytes == nifti2Bytes)
    return nifti2Bytes;
  swapBytes(bytes);
  return bytes == nifti2Bytes ? nifti2Bytes : nifti1Bytes;
}

NiftiHeader parseNiftiHeader(std::string_view bytes, const std::filesystem::path& path,
                             const VolumeChoice& choice) {
  const NiftiFields fields(bytes, path);
  const auto [headerFile, sampleFile] = findNiftiFiles(path);
  const bool isPair = headerFile != sampleFile;
  NiftiHeader header;
  header.size = readNiftiSize(fields);
  header.isSwapped = fields.isSwapped();
  constexpr double maxOffset = 1 << 30;
  const double offset = fields.offset();
  const bool isSized = !header.size.empty() &&
                       std::ranges::all_of(header.size, [](std::int64_t n) { return n >= 1; });
  if (!std::cmp_equal(fields.number<std::int32_t>(0), fields.byteCount()) || !isSized ||
      (!isPair && fields.isAnalyze()) || !(offset <= maxOffset))
    throw inputError(ErrorCode::unsupportedFile, path,
                     isPair ? "is not a NIfTI or Analyze image; write it again as .nii.gz"
                            : "is not a NIfTI image; write it again as .nii.gz");
  if (fields.isOneFile() == isPair)
    throw inputError(ErrorCode::unsupportedFile, path,
                     isPair ? "is an image in one file; name it .nii"
                            : "is the header of a pair of files; name them .hdr and .img");
  header.type = readNiftiType(fields);
  header.rescaling = readNiftiRescaling(fields);
  if (isPair) {
    header.offset = static_cast<std::int64_t>(std::max(offset, 0.0));
  } else { // samples follow the header and the four bytes that flag extensions
    header.end = static_cast<std::int64_t>(fields.byteCount());
    header.offset = std::max(static_cast<std::int64_t>(std::max(offset, 0.0)), header.end + 4);
  }
  if (fields.isAnalyze())
    assumeAnalyzeGeometry(fields, header);
  else
    readNiftiGeometry(fields, choice, header);
  return header;
}

} // namespace fenestra::core
