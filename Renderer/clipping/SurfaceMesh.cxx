#include "clipping/SurfaceMesh.h"

#include "clipping/Footprints.h"

namespace fenestra {

namespace {

/// Samples of an axis, the first and the last among them.
struct MeshedSamples {
  std::int64_t first = std::numeric_limits<std::int64_t>::max();
  std::int64_t last = -1;

  void extend(std::int64_t sample) {
    first = std::min(first, sample);
    last = std::max(last, sample);
  }
  /// Every n-th, and the last.
  std::int64_t count(std::int64_t n) const { return (last - first + n - 1) / n + 1; }
  std::vector<std::int64_t> every(std::int64_t n) const {
    std::vector<std::int64_t> samples;
    for (std::int64_t sample = first; sample < last; sample += n)
      samples.push_back(sample);
    samples.push_back(last);
    return samples;
  }
};

class MeshMaker {
public:
  MeshMaker(const ClipDepth& clip, const Domain& volume)
      : m_camera(clip.camera), m_buffer(*clip.buffer) {
    const DomainFootprint footprint(m_camera, volume);
    for (std::int64_t row = 0; row < m_buffer.rows(); ++row)
      m_footprint.push_back(footprint.columns(m_buffer, row));
  }

  SurfaceMesh mesh() {
    if (!chooseSamples())
      return {};
    m_numbers.assign(m_columns.size() * m_rows.size(), unnumbered);
    for (std::size_t row = 0; row + 1 < m_rows.size(); ++row) {
      const DomainFootprint::Columns seen = footprintBetween(m_rows[row], m_rows[row + 1]);
      for (std::size_t column = 0; column + 1 < m_columns.size(); ++column)
        if (m_columns[column] < seen.end && m_columns[column + 1] >= seen.first)
          addQuad(column, row);
    }
    return std::move(m_mesh);
  }

private:
  static constexpr auto unnumbered = std::numeric_limits<std::uint32_t>::max();

  bool isPoint(std::int64_t column, std::int64_t row) const {
    const double depth = m_buffer.at(m_buffer.sample(column, row));
    return std::isfinite(depth) && !behindEye(m_camera, depth);
  }

  /// As many as may be, of those around all that are points; returns whether there are any.
  bool chooseSamples() {
    MeshedSamples columns, rows;
    for (std::int64_t row = 0; row < m_buffer.rows(); ++row) {
      const DomainFootprint::Columns seen = m_footprint[static_cast<std::size_t>(row)];
      for (std::int64_t column = seen.first; column < seen.end; ++column)
        if (isPoint(column, row)) {
          columns.extend(column);
          rows.extend(row);
        }
    }
    if (rows.last < 0)
      return false;
    std::int64_t n = 1;
    while (columns.count(n) * rows.count(n) > mostSurfacePoints)
      ++n;
    m_columns = columns.every(n);
    m_rows = rows.every(n);
    return true;
  }

  /// Of the rows from one to another, both included.
  DomainFootprint::Columns footprintBetween(std::int64_t from, std::int64_t to) const {
    DomainFootprint::Columns all{m_buffer.columns(), 0};
    for (std::int64_t row = from; row <= to; ++row) {
      const DomainFootprint::Columns seen = m_footprint[static_cast<std::size_t>(row)];
      if (seen.first < seen.end)
        all = {std::min(all.first, seen.first), std::max(all.end, seen.end)};
    }
    return all;
  }

  /// The two triangles, or the one that is left where a corner has no depth, to the right of and
  /// below a chosen sample.
  void addQuad(std::size_t column, std::size_t row) {
    std::array<std::uint32_t, 4> corners;
    std::size_t count = 0;
    for (const auto& [right, down] :
         {std::pair<std::size_t, std::size_t>{0, 0}, {0, 1}, {1, 1}, {1, 0}})
      if (isPoint(m_columns[column + right], m_rows[row + down]))
        corners[count++] =
            static_cast<std::uint32_t>((row + down) * m_columns.size() + column + right);
    for (std::size_t i = 2; i < count; ++i)
      m_mesh.triangles.push_back({number(corners[0]), number(corners[i - 1]), number(corners[i])});
  }

  /// Of the point at a chosen sample, which is made when it is first wanted.
  std::uint32_t number(std::size_t chosen) {
    std::uint32_t& number = m_numbers[chosen];
    if (number == unnumbered) {
      number = static_cast<std::uint32_t>(m_mesh.points.size());
      const std::int64_t column = m_columns[chosen % m_columns.size()];
      const std::int64_t row = m_rows[chosen / m_columns.size()];
      const Vec2 position = m_buffer.position(column, row);
      const double depth = m_buffer.at(m_buffer.sample(column, row));
      m_mesh.points.push_back(fromBuffer(m_camera, {position.x(), position.y(), depth}));
      m_mesh.depths.push_back(static_cast<float>(depth));
    }
    return number;
  }

  const Camera& m_camera;
  const DepthBuffer& m_buffer;
  std::vector<DomainFootprint::Columns> m_footprint; ///< of every row of the buffer
  std::vector<std::int64_t> m_columns, m_rows;       ///< chosen, of the buffer
  std::vector<std::uint32_t> m_numbers;              ///< of the points at chosen samples
  SurfaceMesh m_mesh;
};

} // namespace

SurfaceMesh surfaceMesh(const ClipDepth& clip, const Domain& volume) {
  return MeshMaker(clip, volume).mesh();
}

} // namespace fenestra
