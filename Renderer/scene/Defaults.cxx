#include "scene/Defaults.h"

#include "base/Error.h"
#include "model/volume/Field.h"

#include <map>

namespace fenestra::core {
namespace {

ViewDirection findView(const std::string& name, const ViewDirection* best) {
  static const std::map<std::string, ViewDirection> views = {
      {"anterior", {Vec3::UnitY(), Vec3::UnitZ()}}, {"posterior", {-Vec3::UnitY(), Vec3::UnitZ()}},
      {"right", {Vec3::UnitX(), Vec3::UnitZ()}},    {"left", {-Vec3::UnitX(), Vec3::UnitZ()}},
      {"superior", {Vec3::UnitZ(), Vec3::UnitY()}}, {"inferior", {-Vec3::UnitZ(), Vec3::UnitY()}},
  };
  if (name == "auto" && best)
    return *best;
  const auto known = views.find(name);
  if (known == views.end())
    throw requestError(ErrorCode::unknownName, "view", "'", name,
                       "' is unknown; use anterior, posterior, left, right, superior, inferior, or "
                       "auto with a focus");
  return known->second;
}

/// Scales a vector by the power of two that brings its length near 1. Squares then neither overflow
/// nor underflow, and the normalized vector has the same bits as without scaling.
Vec3 scaleNearUnit(const Vec3& v) {
  const double greatest = v.cwiseAbs().maxCoeff();
  if (greatest == 0.0 || !std::isfinite(greatest))
    return v;
  const int exponent = std::ilogb(greatest);
  return v.unaryExpr([exponent](double x) { return std::ldexp(x, -exponent); });
}

/// Center of the grid-aligned bounding box of a domain, world mm.
Vec3 boxCenter(const Domain& domain) {
  Box box = Box::makeEmpty();
  for (const Vec3& corner : domain.indexCorners())
    box.extend(corner);
  return domain.grid().indexToWorld * box.center();
}

/// Extent of the domain along a unit vector in the world, mm.
Interval axisExtent(const Domain& domain, const Vec3& axis) {
  Interval extent{infinity, -infinity};
  for (const Vec3& corner : domain.indexCorners()) {
    const double position = axis.dot(domain.grid().indexToWorld * corner);
    extent = {std::min(extent.begin, position), std::max(extent.end, position)};
  }
  return extent;
}

/// Shift along `up`, mm, for a frame that extends `half` above and below `center`. It moves a frame
/// that extends beyond an end of the scan back over the occupied part, until both sides have equal
/// empty margins. 0 if the occupied part ends inside the scan: the empty space is then real.
double shiftIntoScan(const Domain& occupied, const Vec3& up, const Vec3& center, double half) {
  const Interval extent = axisExtent(occupied, up), scan = axisExtent(occupied.grid(), up);
  const double at = up.dot(center), rounding = 1e-6 * half;
  const double above = at + half - extent.end, below = extent.begin - (at - half); // empty
  const double shift = std::min(std::max(above, below), 0.5 * std::abs(above - below));
  if (shift <= 0.0)
    return 0.0;
  if (above > below)
    return extent.end > scan.end - rounding ? -shift : 0.0;
  return extent.begin < scan.begin + rounding ? shift : 0.0;
}

} // namespace

std::vector<double> sampleValues(const Volume& volume) {
  const auto sample = [](const auto& voxels) {
    const std::size_t stride = voxels.size() / 1'000'000 + 1;
    std::vector<double> values;
    for (std::size_t i = 0; i < voxels.size(); i += stride)
      values.push_back(static_cast<double>(voxels[i]));
    return values;
  };
  return std::visit(sample, volume.voxels);
}

std::vector<double> sampleValues(const Volume& volume, const Mask& mask) {
  const Affine toVolume = volume.grid.worldToIndex * mask.grid.indexToWorld;
  const Box box = volume.grid.indexBox();
  const Size3& size = mask.grid.size;
  const auto stride = static_cast<std::size_t>(mask.count) / 1'000'000 + 1;
  const auto sample = [&](const auto& voxels) {
    const Field field(volume.grid, voxels);
    std::vector<double> values;
    std::size_t inside = 0;
    for (std::size_t i = 0; i < mask.voxels.size(); ++i) {
      if (mask.voxels[i] < mask.threshold() || inside++ % stride != 0)
        continue;
      const auto at = static_cast<std::int64_t>(i);
      const Size3 voxel(at % size.x(), at / size.x() % size.y(), at / size.x() / size.y());
      const Vec3 index = toVolume * voxel.cast<double>();
      if ((index.array() >= box.lower.array()).all() && (index.array() <= box.upper.array()).all())
        values.push_back(field.value(index));
    }
    return values;
  };
  return std::visit(sample, volume.voxels);
}

double otsuThreshold(const Volume& volume, double low, double high) {
  constexpr int bins = 256;
  std::array<double, bins> histogram{};
  double total = 0.0, moment = 0.0;
  for (const double value : sampleValues(volume)) {
    const double x = std::clamp((value - low) / (high - low), 0.0, 1.0);
    const auto bin = static_cast<std::size_t>(x * (bins - 1));
    histogram[bin] += 1.0;
    total += 1.0;
    moment += static_cast<double>(bin);
  }
  double below = 0.0, belowMoment = 0.0;
  double best = -1.0;
  int threshold = 0;
  for (int i = 0; i < bins; ++i) {
    const double count = histogram[static_cast<std::size_t>(i)];
    below += count;
    belowMoment += i * count;
    if (below == 0.0 || below == total)
      continue;
    const double gap = belowMoment / below - (moment - belowMoment) / (total - below);
    const double betweenVariance = below * (total - below) * gap * gap;
    if (betweenVariance > best) {
      best = betweenVariance;
      threshold = i;
    }
  }
  return low + (high - low) * (threshold + 1.0) / bins;
}

bool isPlausibleModality(Modality modality, const Volume& volume) {
  if (volume.modality)
    return modality == *volume.modality;
  // The minimum is air, or padding below it (-2000, -8192 and -32768 occur); the maximum is bone.
  const bool hounsfield = volume.minimum <= -500.0 && volume.maximum >= 200.0;
  return hounsfield == (modality == Modality::ct);
}

std::array<double, 2> findRobustRange(const Volume& volume) {
  std::vector<double> values = sampleValues(volume);
  std::ranges::sort(values);
  const auto quantile = [&values](double f) {
    return values[static_cast<std::size_t>(f * static_cast<double>(values.size() - 1))];
  };
  const double low = quantile(0.005), high = quantile(0.995);
  return {low, high > low ? high : volume.maximum};
}

std::optional<double> findAirThreshold(const Volume& volume) {
  if (isPlausibleModality(Modality::ct, volume))
    return -300.0;
  const std::vector<double> values = sampleValues(volume);
  if (10 * std::ranges::count(values, volume.minimum) >= std::ssize(values))
    return std::nullopt;
  const auto [low, high] = findRobustRange(volume);
  return otsuThreshold(volume, low, high);
}

double transparentFraction(const Mask& focus, const Volume& volume,
                           const TransferFunction& transfer) {
  const std::vector<double> values = sampleValues(volume, focus);
  const auto transparent = std::ranges::count_if(
      values, [&](double value) { return transfer.extinction(value)[0] == 0.0; });
  return values.empty() ? 0.0
                        : static_cast<double>(transparent) / static_cast<double>(values.size());
}

CameraPose frameView(const ViewRequest& view, const Domain& domain, const Mask* focus, int width,
                     int height, const ViewDirection* best) {
  constexpr double surroundings = 1.6; // size of the frame / size of the focus
  constexpr double margin = 1.05;      // around the volume
  constexpr double defaultAngle = 30.0;
  const ViewDirection named = findView(view.name.value_or("anterior"), best);

  const Grid& grid = domain.grid();
  const Domain volume = domain.indexCorners().empty() ? Domain(grid) : domain;
  CameraPose pose;
  pose.projection = view.projection.value_or(Projection::orthographic);
  pose.angle = view.angle.value_or(defaultAngle);
  pose.target = view.target.value_or(focus ? focus->grid.worldCenter() : boxCenter(volume));
  const Vec3 back =
      view.position ? Vec3((*view.position - pose.target).normalized()) : named.fromTarget;
  pose.up = view.up.value_or(
      std::abs(back.dot(named.up)) > 0.999 * back.norm() ? Vec3(Vec3::UnitY()) : named.up);
  const Vec3 right = scaleNearUnit(pose.up).cross(back).normalized();
  const Vec3 up = back.cross(right);

  // Frames the volume, or the focus with its surroundings if that is smaller.
  const double aspect = static_cast<double>(width) / height;
  const auto halfHeight = [&](const Domain& domain) {
    const Vec3 center = boxCenter(domain);
    double half = 0.0;
    for (const Vec3& corner : domain.indexCorners()) {
      const Vec3 d = domain.grid().indexToWorld * corner - center;
      half = std::max({half, std::abs(d.dot(up)), std::abs(d.dot(right)) / aspect});
    }
    return half;
  };
  double half = margin * halfHeight(volume);
  if (focus)
    half = std::min(half, surroundings * halfHeight(focus->grid));
  pose.scale = view.scale.value_or(half);
  if (focus && !view.target && !view.position && !view.scale)
    pose.target +=
        shiftIntoScan(volume, up, pose.target, half) * up; // turntables rotate about `up`

  // The camera is outside the volume, and in perspective at least as far away as pose.angle
  // requires. A camera farther away gets a narrower angle.
  const double outside = margin * grid.boundingRadius() + (pose.target - grid.worldCenter()).norm();
  const double distance = std::max(outside, half / std::tan(pose.angle * pi / 360.0));
  if (!view.angle && !view.position)
    pose.angle = 360.0 / pi * std::atan2(half, distance);
  pose.position = view.position.value_or(pose.target + distance * back);
  return pose;
}

CameraPose adjustView(const ViewRequest& view, const CameraPose& scene) {
  CameraPose pose = scene;
  pose.projection = view.projection.value_or(scene.projection);
  const bool perspective = pose.projection == Projection::perspective;
  if (perspective && view.scale)
    throw requestError(ErrorCode::scaleOfPerspectiveCamera, "scale",
                       "the scene's camera is perspective");
  if (!perspective && view.angle)
    throw requestError(ErrorCode::angleOfOrthographicCamera, "angle",
                       "the scene's camera is orthographic");
  pose.target = view.target.value_or(scene.target);
  pose.up = view.up.value_or(scene.up);
  pose.scale = view.scale.value_or(scene.scale);
  pose.angle = view.angle.value_or(scene.angle);
  return pose;
}

} // namespace fenestra::core
