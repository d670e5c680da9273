#include "model/medium/Shares.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

namespace fenestra {
namespace {

/// A number for each voxel of a brick, in 255ths: whole numbers add up alike in any order.
using InBrick = std::array<float, Shares::voxelsInBrick>;
constexpr float full = 255.0F;

/// A part's mask in the common grid.
struct Placed {
  const Shares::Part* part;
  Size3 first, end; ///< voxels of the common grid
};

/// Where the masks lie in the grid of the first one, whatever that one's extent is.
std::vector<Placed> placed(const std::vector<Shares::Part>& parts) {
  const Affine& toFirst = parts.front().mask.grid.worldToIndex;
  std::vector<Placed> all;
  for (const Shares::Part& part : parts) {
    const Vec3 origin = toFirst * part.mask.grid.indexToWorld.translation();
    const Size3 first = origin.array().round().cast<std::int64_t>();
    all.push_back({&part, first, first + part.mask.grid.size});
  }
  std::ranges::stable_sort(all, std::greater{}, [](const Placed& p) { return p.part->priority; });
  return all;
}

/// Indicators of a mask in the voxels of a brick; false: all are 0.
bool indicators(const Placed& placed, const Size3& from, const Size3& last, InBrick& values) {
  const Mask& mask = placed.part->mask;
  const float scale = full / static_cast<float>(mask.full);
  bool some = false;
  std::size_t next = 0;
  for (std::int64_t z = 0; z <= Shares::edge; ++z)
    for (std::int64_t y = 0; y <= Shares::edge; ++y)
      for (std::int64_t x = 0; x <= Shares::edge; ++x, ++next) {
        const Size3 voxel = (from + Size3(x, y, z)).cwiseMin(last);
        const bool inside = (voxel.array() >= placed.first.array()).all() &&
                            (voxel.array() < placed.end.array()).all();
        const std::uint8_t value =
            inside ? mask.voxels[numberOf(voxel - placed.first, mask.grid.size)] : 0;
        values[next] = scale * static_cast<float>(value);
        some = some || value > 0;
      }
  return some;
}

/// Shares of a brick's components, in their order, each once.
class BrickShares {
public:
  /// Adds the parts that meet the brick whose first voxel is `from`.
  BrickShares(const std::vector<Placed>& parts, const Size3& from, const Size3& last) {
    m_left.fill(full);
    const Size3 end = from + Size3::Constant(Shares::edge + 1);
    for (auto p = parts.begin(); p != parts.end();) {
      m_class.clear();
      const int priority = p->part->priority;
      for (; p != parts.end() && p->part->priority == priority; ++p) {
        const bool meets =
            (p->first.array() < end.array()).all() && (p->end.array() > from.array()).all();
        InBrick values;
        if (meets && indicators(*p, from, last, values))
          m_class.push_back({p->part->component, values});
      }
      if (!m_class.empty())
        shareOut();
    }
    if (std::ranges::any_of(m_left, [](float left) { return left > 0.0F; }))
      add(0, m_left);
    std::ranges::sort(m_shares, {}, &Component::component);
  }

  /// Component of the whole brick; nothing: several.
  std::optional<std::uint8_t> pure() const {
    return m_shares.size() == 1 ? std::optional(m_shares.front().component) : std::nullopt;
  }
  std::size_t groupCount() const {
    return (m_shares.size() + Shares::inGroup - 1) / Shares::inGroup;
  }
  /// Writes groupCount() groups.
  void write(Shares::Group* groups) const {
    for (std::size_t g = 0; g < groupCount(); ++g)
      groups[g].isLast = g + 1 == groupCount();
    for (std::size_t c = 0; c < m_shares.size(); ++c)
      groups[c / Shares::inGroup].components[c % Shares::inGroup] = m_shares[c].component;
    for (std::size_t voxel = 0; voxel < Shares::voxelsInBrick; ++voxel)
      writeVoxel(voxel, groups);
  }

private:
  struct Component {
    std::uint8_t component;
    InBrick share;
  };

  void add(std::uint8_t component, const InBrick& share) {
    const auto found = std::ranges::find(m_shares, component, &Component::component);
    if (found == m_shares.end()) {
      m_shares.push_back({component, share});
      return;
    }
    for (std::size_t i = 0; i < share.size(); ++i)
      found->share[i] += share[i];
  }

  /// Gives what is left to the parts of one priority.
  void shareOut() {
    InBrick factor;
    for (std::size_t i = 0; i < factor.size(); ++i) {
      float sum = 0.0F;
      for (const Component& part : m_class)
        sum += part.share[i];
      factor[i] = sum > m_left[i] ? m_left[i] / sum : 1.0F;
      m_left[i] -= std::min(sum, m_left[i]);
    }
    for (Component& part : m_class) {
      for (std::size_t i = 0; i < factor.size(); ++i)
        part.share[i] *= factor[i];
      add(part.component, part.share);
    }
  }

  /// Rounds the shares of a voxel; the greatest, of equals the first component's, takes what
  /// rounding loses or gains.
  void writeVoxel(std::size_t voxel, Shares::Group* groups) const {
    int left = static_cast<int>(full);
    std::size_t greatest = 0;
    for (std::size_t c = 0; c < m_shares.size(); ++c) {
      const int share = static_cast<int>(std::lround(m_shares[c].share[voxel]));
      left -= share;
      groups[c / Shares::inGroup].shares[voxel][c % Shares::inGroup] =
          static_cast<std::uint8_t>(share);
      if (m_shares[c].share[voxel] > m_shares[greatest].share[voxel])
        greatest = c;
    }
    std::uint8_t& most =
        groups[greatest / Shares::inGroup].shares[voxel][greatest % Shares::inGroup];
    most = static_cast<std::uint8_t>(most + left);
  }

  InBrick m_left;
  std::vector<Component> m_class, m_shares;
};

} // namespace

Shares::Shares(const std::vector<Part>& parts) {
  std::vector<Placed> masks = placed(parts);
  Size3 first = masks.front().first, end = masks.front().end;
  for (const Placed& p : masks) {
    first = first.cwiseMin(p.first);
    end = end.cwiseMax(p.end);
  }
  for (Placed& p : masks) {
    p.first -= first;
    p.end -= first;
  }
  Affine indexToWorld = parts.front().mask.grid.indexToWorld;
  indexToWorld.translate(first.cast<double>());
  m_grid = Grid(end - first, indexToWorld);
  m_brickCount = ((m_grid.size.array() - 1).max(1) + edge - 1) / edge;
  m_bricks.resize(static_cast<std::size_t>(m_brickCount.prod()));

  const Size3 last = m_grid.size.array() - 1;
  std::vector<std::vector<Group>> layers(static_cast<std::size_t>(m_brickCount.z()));
  tbb::parallel_for(std::int64_t{0}, m_brickCount.z(), [&](std::int64_t z) {
    std::vector<Group>& groups = layers[static_cast<std::size_t>(z)];
    for (std::int64_t y = 0; y < m_brickCount.y(); ++y)
      for (std::int64_t x = 0; x < m_brickCount.x(); ++x) {
        const Size3 brick(x, y, z);
        const BrickShares shares(masks, edge * brick, last);
        std::int32_t& code = m_bricks[numberOf(brick, m_brickCount)];
        if (const std::optional<std::uint8_t> pure = shares.pure()) {
          code = *pure;
          continue;
        }
        code = ~static_cast<std::int32_t>(groups.size());
        groups.resize(groups.size() + shares.groupCount(), Group{});
        shares.write(&groups[static_cast<std::size_t>(~code)]);
      }
  });
  // A layer's groups are counted from its own first one until now.
  std::int64_t next = 0;
  for (std::int64_t z = 0; z < m_brickCount.z(); ++z) {
    const std::vector<Group>& groups = layers[static_cast<std::size_t>(z)];
    const auto before = static_cast<std::int32_t>(m_groups.size());
    m_groups.insert(m_groups.end(), groups.begin(), groups.end());
    for (std::int64_t i = 0; i < m_brickCount.x() * m_brickCount.y(); ++i, ++next)
      if (std::int32_t& code = m_bricks[static_cast<std::size_t>(next)]; code < 0)
        code -= before;
  }
}

double Shares::pureFraction() const {
  return static_cast<double>(std::ranges::count_if(m_bricks, [](auto code) { return code >= 0; })) /
         static_cast<double>(m_bricks.size());
}

} // namespace fenestra
