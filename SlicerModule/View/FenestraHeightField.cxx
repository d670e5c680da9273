#include "FenestraHeightField.h"

#include <vtkCellArray.h>
#include <vtkNew.h>
#include <vtkPoints.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace {

constexpr int viewPixelsPerSample = 4;
constexpr double largestJump = 4.0; ///< mm between neighboring samples
/// Of a jump relative to the distance of the samples, so that distant surfaces keep their
/// triangles.
constexpr double largestSlope = 3.0;

/// Positions of samples along an axis of an image, pixels. The last pixel is a sample, too.
std::vector<int> MakePositions(int count, int step) {
  std::vector<int> positions;
  for (int i = 0; i < count - 1; i += step)
    positions.push_back(i);
  positions.push_back(count - 1);
  return positions;
}

FenestraViewCamera::Point ToWorld(const FenestraViewImage& image, const FenestraViewRays& rays,
                                  int column, int row, double depth) {
  return rays.ToWorld((column + 0.5) / image.width, (row + 0.5) / image.height, depth);
}

/// Depths of samples and their points. Negative identifiers: no depth.
struct Samples {
  std::vector<double> depths;
  std::vector<vtkIdType> points;
};

Samples AddPoints(const FenestraViewImage& image, const FenestraViewRays& rays,
                  const std::vector<int>& columns, const std::vector<int>& rows,
                  vtkPoints* points) {
  Samples samples;
  for (const int row : rows)
    for (const int column : columns) {
      const double depth = static_cast<double>(image.depth[image.GetIndex(column, row)]);
      const bool hasDepth = std::isfinite(depth);
      samples.depths.push_back(depth);
      samples.points.push_back(
          hasDepth ? points->InsertNextPoint(ToWorld(image, rays, column, row, depth).data()) : -1);
    }
  return samples;
}

/// False: a jump, or a corner without a depth.
bool IsContinuous(const Samples& samples, const std::array<std::size_t, 3>& corners,
                  double heightPerSample, const FenestraViewRays& rays) {
  double nearest = samples.depths[corners[0]], farthest = nearest;
  for (const std::size_t corner : corners) {
    if (samples.points[corner] < 0)
      return false;
    nearest = std::min(nearest, samples.depths[corner]);
    farthest = std::max(farthest, samples.depths[corner]);
  }
  return farthest - nearest <=
         std::max(largestJump, largestSlope * heightPerSample * rays.GetHeight(nearest));
}

} // namespace

vtkSmartPointer<vtkPolyData> FenestraHeightField::Build(const FenestraViewImage& image,
                                                        const FenestraViewCamera& camera) {
  const FenestraViewRays rays(camera);
  const int step =
      std::max(1, static_cast<int>(std::lround(static_cast<double>(viewPixelsPerSample) *
                                               image.height / camera.height)));
  const std::vector<int> columns = MakePositions(image.width, step);
  const std::vector<int> rows = MakePositions(image.height, step);
  const vtkNew<vtkPoints> points;
  const Samples samples = AddPoints(image, rays, columns, rows, points);
  const vtkNew<vtkCellArray> triangles;
  const auto addTriangle = [&](std::size_t a, std::size_t b, std::size_t c) {
    if (!IsContinuous(samples, {a, b, c}, static_cast<double>(step) / image.height, rays))
      return false;
    const vtkIdType corners[] = {samples.points[a], samples.points[b], samples.points[c]};
    triangles->InsertNextCell(3, corners);
    return true;
  };
  for (std::size_t row = 0; row + 1 < rows.size(); ++row)
    for (std::size_t column = 0; column + 1 < columns.size(); ++column) {
      const std::size_t upper = row * columns.size() + column, lower = upper + columns.size();
      // Of a cell with one corner beyond a jump, one of the four remains.
      const bool hasLeft = addTriangle(upper, lower, lower + 1);
      const bool hasRight = addTriangle(upper, lower + 1, upper + 1);
      if (!hasLeft && !hasRight && !addTriangle(upper, lower, upper + 1))
        addTriangle(upper + 1, lower, lower + 1);
    }
  auto surface = vtkSmartPointer<vtkPolyData>::New();
  surface->SetPoints(points);
  surface->SetPolys(triangles);
  return surface;
}

vtkBoundingBox FenestraHeightField::ComputeBounds(const FenestraViewImage& image,
                                                  const FenestraViewCamera& camera) {
  const FenestraViewRays rays(camera);
  vtkBoundingBox bounds;
  for (int row = 0; row < image.height; ++row)
    for (int column = 0; column < image.width; ++column) {
      const double depth = static_cast<double>(image.depth[image.GetIndex(column, row)]);
      if (std::isfinite(depth))
        bounds.AddPoint(ToWorld(image, rays, column, row, depth).data());
    }
  return bounds;
}
