#include "files/medical/NiftiHeader.h"

#include "base/Error.h"
#include "base/Text.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <utility>

namespace fenestra {
namespace {

/// Access to the fields of nifti_1_header by byte offset.
class NiftiFields {
public:
  NiftiFields(const NiftiBytes& bytes, const std::filesystem::path& path)
      : m_bytes(bytes), m_path(path) {
    const auto axes = number<std::int16_t>(40); // dim[0]; reveals the byte order
    m_swapped = axes < 1 || axes > 7;
  }

  template <typename T>
  T number(std::size_t at) const {
    T value;
    std::memcpy(&value, &m_bytes[at], sizeof(T));
    if (m_swapped)
      swapBytes(value);
    return value;
  }
  double real(std::size_t at) const { return number<float>(at); }
  Vec3 triple(std::size_t at) const { return {real(at), real(at + 4), real(at + 8)}; }

  /// True if `count` numbers from offset `at` on are finite and below 1e9.
  bool hasFiniteNumbers(std::size_t at, std::size_t count) const {
    for (std::size_t end = at + 4 * count; at < end; at += 4)
      if (!(std::abs(real(at)) < 1e9))
        return false;
    return true;
  }

  bool isSwapped() const { return m_swapped; }
  /// True if the header and the samples are in one file.
  bool isOnePart() const { return std::memcmp(&m_bytes[344], "n+1", 4) == 0; }
  const std::filesystem::path& path() const { return m_path; }

private:
  const NiftiBytes& m_bytes;
  const std::filesystem::path& m_path;
  bool m_swapped = false;
};

std::vector<std::int64_t> readNiftiSize(const NiftiFields& fields) {
  std::vector<std::int64_t> size;
  const auto axes = fields.number<std::int16_t>(40);
  for (std::size_t axis = 1; axes <= 7 && std::cmp_less_equal(axis, axes); ++axis)
    size.push_back(fields.number<std::int16_t>(40 + 2 * axis));
  return size;
}

SampleType readNiftiType(const NiftiFields& fields) {
  static const std::map<std::int16_t, SampleType> types = {
      // NIFTI_TYPE_… of nifti1.h
      {2, std::uint8_t()},    {4, std::int16_t()},    {8, std::int32_t()},
      {16, float()},          {64, double()},         {256, std::int8_t()},
      {512, std::uint16_t()}, {768, std::uint32_t()}, {1024, std::int64_t()},
      {1280, std::uint64_t()}};
  const auto code = fields.number<std::int16_t>(70);
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
  const double slope = fields.real(112), intercept = fields.real(116);
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
  return Mat3::FromRows(fields.triple(280), fields.triple(296), fields.triple(312));
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
  const Vec3 offset(fields.real(292), fields.real(308), fields.real(324));
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
  Vec3 v = fields.triple(256);
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
  const double handedness = fields.real(76) < 0.0 ? -1.0 : 1.0; // qfac
  return Affine(rotation * Mat3::Diagonal({pixdim[0], pixdim[1], handedness * pixdim[2]}),
                fields.triple(268));
}

/// Millimeters per unit of length of the header.
double readUnitMm(const NiftiFields& fields) {
  const int code = fields.number<char>(123) & 7; // xyzt_units: m, mm, µm
  return code == 1 ? 1000.0 : code == 3 ? 0.001 : 1.0;
}

/// Largest distance between the positions of a corner of the image in both forms, in the units of
/// the header. The sform may be sheared.
double measureDisagreement(const NiftiFields& fields, const Affine& qform) {
  const Affine sform(readSformAxes(fields), {fields.real(292), fields.real(308), fields.real(324)});
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

/// Sets the geometry of the header.
void readNiftiGeometry(const NiftiFields& fields, const VolumeChoice& choice, NiftiHeader& header) {
  const auto qform = fields.number<std::int16_t>(252), sform = fields.number<std::int16_t>(254);
  // pixdim, quaternion and offset, rows of the sform
  if (!fields.hasFiniteNumbers(76, 4) || (qform > 0 && !fields.hasFiniteNumbers(256, 6)) ||
      (sform > 0 && !fields.hasFiniteNumbers(280, 12)))
    throw fieldError(fields.path(), "qform, sform or pixdim",
                     "has a number that is not finite or "
                     "exceeds 1e9 mm; write it again");
  Vec3 pixdim = fields.triple(80);
  for (int axis = 0; axis < 3; ++axis)
    pixdim[axis] = pixdim[axis] == 0.0 ? 1.0 : std::abs(pixdim[axis]);
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

NiftiHeader parseNiftiHeader(const NiftiBytes& bytes, const std::filesystem::path& path,
                             const VolumeChoice& choice) {
  const NiftiFields fields(bytes, path);
  NiftiHeader header;
  header.size = readNiftiSize(fields);
  header.isSwapped = fields.isSwapped();
  constexpr double maxOffset = 1 << 30;
  const double offset = fields.real(108);
  const bool isSized = !header.size.empty() &&
                       std::ranges::all_of(header.size, [](std::int64_t n) { return n >= 1; });
  if (fields.number<std::int32_t>(0) != static_cast<std::int32_t>(bytes.size()) || !isSized ||
      !fields.isOnePart() || !(offset <= maxOffset))
    throw inputError(ErrorCode::unsupportedFile, path,
                     "is not a single-file NIfTI-1 image; write it again as .nii.gz");
  header.type = readNiftiType(fields);
  header.rescaling = readNiftiRescaling(fields);
  // Samples follow the header and the four bytes that flag extensions.
  header.offset = static_cast<std::int64_t>(std::max(offset, 352.0));
  readNiftiGeometry(fields, choice, header);
  return header;
}

} // namespace fenestra
