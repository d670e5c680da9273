#include "phantoms/FetusHead.h"

#include <memory>

namespace fenestra {
namespace {

Solid tube(const std::vector<TubeNode>& nodes) {
  const auto shape = std::make_shared<const Tube>(nodes);
  return {[shape](const Vec3& p) { return shape->distance(p); }, shape->box()};
}

Solid mirrored(const Solid& solid) {
  const auto mirror = [](const Vec3& p) { return Vec3(-p.x(), p.y(), p.z()); };
  return {[solid, mirror](const Vec3& p) { return solid.distance(mirror(p)); },
          {mirror({solid.box.upper.x(), solid.box.lower.y(), solid.box.lower.z()}),
           mirror({solid.box.lower.x(), solid.box.upper.y(), solid.box.upper.z()})}};
}

/// `right` and its mirror image.
Solid paired(const Solid& right) {
  return unite(right, mirrored(right), 0.1);
}

Solid without(const Solid& solid, const Solid& removed, double blend) {
  return {[solid, removed, blend](const Vec3& p) {
            return smoothDifference(solid.distance(p), removed.distance(p), blend);
          },
          solid.box};
}

/// Skull, forehead, jaw and cheeks.
Solid bulk() {
  Solid head = ellipsoid({0, -8, 10}, {35, 43, 36});
  head = unite(head, ellipsoid({0, 19, -17}, {23, 19, 26}), 14);
  head = unite(head, ellipsoid({0, 27, -38}, {9, 9, 7}), 9);
  head = unite(head, paired(ellipsoid({14, 26, -21}, {10, 10, 10})), 9);
  return unite(head, tube({{{0, -6, -28}, 15}, {{0, -12, -50}, 13}, {{0, -16, -80}, 19}}), 12);
}

/// Face with eye sockets, closed lids, and the slits between the lids.
Solid withEyes(const Solid& head) {
  Solid face = without(head, paired(ellipsoid({13, 42, -5}, {9, 9, 6})), 7);
  face = unite(face, paired(ellipsoid({12.5, 30.5, -5}, {7, 6, 5.5})), 2.5);
  const Solid slit = tube({{{6.5, 34.5, -6.5}, 0.6},
                           {{10, 36.6, -7.8}, 0.8},
                           {{14, 36.5, -7.8}, 0.8},
                           {{18.5, 33.5, -6.2}, 0.6}});
  return without(face, paired(slit), 1.2);
}

Solid nose() {
  const Solid bridge = tube({{{0, 36, 0}, 2.0}, {{0, 38, -9}, 2.6}, {{0, 42, -17}, 4.0}});
  const Solid wings = paired(ellipsoid({4.2, 39, -18.5}, {3.2, 4, 3}));
  const Solid nostrils = paired(ellipsoid({2.6, 42.5, -21.2}, {1.3, 1.8, 1.5}));
  return without(unite(bridge, wings, 3), nostrils, 1);
}

Solid lips() {
  const Solid upper = tube({{{-9, 34.5, -29.5}, 1.2},
                            {{-3, 39, -27.8}, 2.3},
                            {{0, 39.4, -28.3}, 2.1},
                            {{3, 39, -27.8}, 2.3},
                            {{9, 34.5, -29.5}, 1.2}});
  const Solid lower =
      tube({{{-8, 34.5, -30.5}, 1.2}, {{0, 38.3, -32.6}, 2.6}, {{8, 34.5, -30.5}, 1.2}});
  return unite(upper, lower, 0.8);
}

Solid ear() {
  const Solid shell = ellipsoid({33.5, -9, -7}, {3.2, 6, 9});
  return without(shell, ellipsoid({37, -7, -7}, {2.6, 3.5, 6}), 2);
}

} // namespace

Solid fetusHead() {
  Solid head = withEyes(bulk());
  head = unite(head, nose(), 4);
  head = unite(head, lips(), 2.5);
  return unite(head, paired(ear()), 2.5);
}

Solid fetusHand() {
  Solid hand = ellipsoid({33, 30, -42}, {7, 6, 9});
  for (int finger = 0; finger < 4; ++finger) {
    const double z = -36.0 - 4.6 * finger;
    hand = unite(hand, tube({{{37, 31, z}, 2.4}, {{33, 38, z}, 2.5}, {{26.5, 37.5, z - 0.5}, 2.3}}),
                 1.2);
  }
  hand = unite(hand, tube({{{33, 33, -33}, 2.8}, {{27, 36, -32.5}, 2.3}}), 1.5);
  return unite(hand, tube({{{35, 28, -48}, 7}, {{42, 18, -66}, 9}}), 4);
}

} // namespace fenestra
