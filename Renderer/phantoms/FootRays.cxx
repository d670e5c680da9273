#include "phantoms/FootRays.h"

namespace fenestra {

namespace {

/// Parameters that differ between bones of a kind.
struct Entry {
  Vec3 base, head;
  Vec2 baseRadii, shaftRadii, headRadii;
  double bow;
};

const Entry metatarsals[] = {
    {{-29, 138, 45}, {-33, 196, 19}, {9.5, 14}, {6.5, 7}, {10.5, 9.5}, 1.0},
    {{-12.5, 131.5, 55}, {-15, 203, 19}, {7.5, 9.5}, {4, 4.6}, {5.6, 7.6}, 2.5},
    {{2.5, 133, 49.5}, {1, 198, 18}, {7, 9.5}, {3.8, 4.5}, {5.4, 7.4}, 2.5},
    {{15.5, 120.5, 41}, {16, 190, 17}, {6.5, 8.5}, {3.7, 4.4}, {5.3, 7.2}, 2.0},
    {{28.5, 115.5, 31}, {31, 179, 15.5}, {8, 7}, {4.2, 4}, {5.6, 6.8}, 1.0}};

const Entry proximalPhalanges[] = {
    {{-33, 199, 18.5}, {-29.5, 229, 17.5}, {9.5, 8}, {6.2, 5.5}, {8.2, 6.5}, 0.8},
    {{-15, 205, 18.5}, {-13, 229, 20.5}, {6, 5.6}, {3.4, 3.6}, {4.8, 4.4}, 0.6},
    {{1, 200, 17.5}, {2.5, 222, 19.5}, {5.8, 5.4}, {3.2, 3.4}, {4.6, 4.2}, 0.6},
    {{16.2, 192, 16.5}, {16.8, 212, 18}, {5.6, 5.2}, {3.1, 3.3}, {4.4, 4}, 0.6},
    {{31, 181, 15}, {30, 198, 16}, {5.6, 5}, {3.2, 3.2}, {4.4, 3.9}, 0.5}};

/// Toes 2 to 5; the great toe has no middle phalanx.
const Entry middlePhalanges[] = {
    {{-13, 230, 20}, {-12.6, 242.5, 17}, {4.6, 4.2}, {3.6, 3.3}, {4.3, 3.7}, 0.3},
    {{2.6, 223, 19}, {3, 234, 15.8}, {4.4, 4}, {3.5, 3.2}, {4.1, 3.5}, 0.3},
    {{16.8, 213, 17.5}, {16.6, 222.8, 14.5}, {4.2, 3.8}, {3.4, 3.1}, {4, 3.4}, 0.3},
    {{29.9, 199, 15.5}, {29.5, 207, 13}, {4.2, 3.6}, {3.5, 3}, {4, 3.3}, 0.3}};

const Entry distalPhalanges[] = {
    {{-29.2, 230, 17}, {-27, 254, 14.5}, {8.2, 6}, {4.8, 3.8}, {6, 3.6}, 0.0},
    {{-12.5, 243.5, 16}, {-12.3, 254.5, 11.5}, {4.2, 3.6}, {2.6, 2.5}, {3.4, 2.5}, 0.0},
    {{3.1, 235, 14.8}, {3.5, 245.5, 10.8}, {4, 3.4}, {2.5, 2.4}, {3.3, 2.4}, 0.0},
    {{16.5, 223.8, 13.5}, {16.4, 233.5, 10}, {3.9, 3.3}, {2.5, 2.4}, {3.2, 2.4}, 0.0},
    {{29.4, 208, 12}, {29, 217, 9.5}, {3.9, 3.2}, {2.5, 2.3}, {3.2, 2.3}, 0.0}};

/// Cortex, mm, and spongiosa, HU, of a kind of bone.
struct Substance {
  double cortex, shaftCortex, spongiosa;
};
constexpr Substance metatarsal{1.1, 2.4, 250.0};
constexpr Substance phalanx{0.9, 1.4, 170.0};
constexpr Substance smallPhalanx{0.8, 1.0, 160.0};

const std::vector<std::string> tarsalsOfRay[] = {
    {"medial_cuneiform", "intermediate_cuneiform"},
    {"medial_cuneiform", "intermediate_cuneiform", "lateral_cuneiform", "metatarsal_1"},
    {"intermediate_cuneiform", "lateral_cuneiform", "metatarsal_2"},
    {"cuboid", "lateral_cuneiform", "metatarsal_3"},
    {"cuboid", "metatarsal_4"}};

constexpr const char* ordinals[] = {"First", "Second", "Third", "Fourth", "Fifth"};
constexpr const char* toes[] = {"great", "second", "third", "fourth", "fifth"};

LongBone make(const std::string& id, const std::string& name, const Entry& e, const Substance& s,
              const std::vector<std::string>& neighbours) {
  return {id,          name,  e.base,   e.head,        e.baseRadii, e.shaftRadii,
          e.headRadii, e.bow, s.cortex, s.shaftCortex, s.spongiosa, neighbours};
}

} // namespace

Solid LongBone::shape() const {
  const double length = (head - base).norm();
  const Vec2 top(0.0, bow);
  const Vec2 neck = 0.45 * baseRadii + 0.55 * shaftRadii;
  const Loft loft({{0.0, Vec2::Zero(), 0.94 * baseRadii},
                   {0.10 * length, 0.2 * top, baseRadii},
                   {0.27 * length, 0.8 * top, neck},
                   {0.50 * length, top, shaftRadii},
                   {0.72 * length, 0.7 * top, 1.08 * shaftRadii},
                   {0.88 * length, 0.2 * top, headRadii},
                   {length, Vec2::Zero(), 0.88 * headRadii}},
                  0.25, 1.1 * headRadii.minCoeff());
  return placed(toShape(base, head - base, Vec3::UnitZ()), loft);
}

std::vector<LongBone> footRays() {
  std::vector<LongBone> bones;
  for (std::size_t ray = 0; ray < std::size(metatarsals); ++ray) {
    std::string number = std::to_string(ray + 1);
    number.insert(0, 1, '_');
    const std::string ofToe = std::string(" phalanx of the ") + toes[ray] + " toe";
    bones.push_back(make("metatarsal" + number, std::string(ordinals[ray]) + " metatarsal",
                         metatarsals[ray], metatarsal, tarsalsOfRay[ray]));
    bones.push_back(make("proximal_phalanx" + number, "Proximal" + ofToe, proximalPhalanges[ray],
                         phalanx, {"metatarsal" + number}));
    const bool greatToe = ray == 0;
    if (!greatToe)
      bones.push_back(make("middle_phalanx" + number, "Middle" + ofToe, middlePhalanges[ray - 1],
                           smallPhalanx, {"proximal_phalanx" + number}));
    bones.push_back(make("distal_phalanx" + number, "Distal" + ofToe, distalPhalanges[ray],
                         greatToe ? phalanx : smallPhalanx,
                         {greatToe ? "proximal_phalanx" + number : "middle_phalanx" + number}));
  }
  return bones;
}

} // namespace fenestra
