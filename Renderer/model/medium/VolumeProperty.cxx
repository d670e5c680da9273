#include "model/medium/VolumeProperty.h"

#include "base/Error.h"

#include <queue>

namespace fenestra::core {
namespace {

constexpr double opacityCap = 0.9999;
constexpr double tolerance = 1e-4;
/// Fraction of the function's maximum below which errors count as absolute: a curve like x^11 would
/// otherwise need an unlimited number of knots near zero.
constexpr double relativeFloor = 1e-9;
constexpr std::size_t maxNodes = 2000; ///< per curve
constexpr std::size_t maxKnots = 6000; ///< per table, in addition to the nodes

/// VTK keeps midpoints away from the ends.
double clampMidpoint(double midpoint) {
  return std::clamp(midpoint, 1e-5, 1.0 - 1e-5);
}

template <typename Value>
Value evaluateSegment(const CurveNode<Value>& a, const CurveNode<Value>& b, double x) {
  const double u = std::clamp((x - a.x) / (b.x - a.x), 0.0, 1.0);
  return a.value + (b.value - a.value) * evaluateCurve(u, a.midpoint, a.sharpness);
}

/// Tabulates map(curve), where `map` converts node values to table values. Smooth pieces are
/// halved, the worst first, until the error of every chord at its test points is at most
/// tolerance / 2, or maxKnots are used (which normal properties do not need).
template <int Channels, typename Node, typename Map>
class Tabulator {
public:
  using Function = PiecewiseLinear<Channels>;
  using Knot = typename Function::Knot;
  using Value = typename Function::Value;

  Tabulator(const std::vector<Node>& nodes, Map map) : m_nodes(nodes), m_map(std::move(map)) {
    double greatest = 0.0;
    for (const Node& node : nodes)
      greatest = std::max(greatest, Value(m_map(node.value)).maxCoeff());
    m_floor = relativeFloor * greatest;
  }

  Function build() {
    for (std::size_t i = 0; i + 1 < m_nodes.size(); ++i)
      addSegment(i);
    addKnot(m_nodes.size() - 1, m_nodes.back().x, m_map(m_nodes.back().value));
    refine();
    for (; !m_chords.empty(); m_chords.pop())
      addKnot(m_chords.top());
    // Chords come in any order; a stable sort preserves the order of a step's two knots.
    std::stable_sort(
        m_knots.begin(), m_knots.end(), [](const SegmentKnot& a, const SegmentKnot& b) {
          return std::pair(a.segment, a.knot.position) < std::pair(b.segment, b.knot.position);
        });
    std::vector<Knot> knots;
    for (const SegmentKnot& segmentKnot : m_knots)
      if (knots.empty() || knots.back().position != segmentKnot.knot.position ||
          knots.back().value != segmentKnot.knot.value)
        knots.push_back(segmentKnot.knot);
    return Function(std::move(knots));
  }

private:
  /// Part of one segment; addKnot() makes `begin` a knot.
  struct Chord {
    std::size_t segment;
    double begin, end;
    Value beginValue, endValue;
    double error = 0.0;

    bool operator<(const Chord& other) const { return error < other.error; }
  };
  struct SegmentKnot {
    std::size_t segment;
    Knot knot;
  };

  Value evaluate(std::size_t segment, double x) const {
    return m_map(evaluateSegment(m_nodes[segment], m_nodes[segment + 1], x));
  }

  void addKnot(std::size_t segment, double position, const Value& value) {
    m_knots.push_back({segment, {position, value}});
  }
  void addKnot(const Chord& chord) { addKnot(chord.segment, chord.begin, chord.beginValue); }

  void addSegment(std::size_t i) {
    const Node& a = m_nodes[i];
    const Node& b = m_nodes[i + 1];
    addKnot(i, a.x, m_map(a.value));
    const double middle = a.x + clampMidpoint(a.midpoint) * (b.x - a.x);
    if (!(b.x > a.x)) // a step
      addKnot(i, b.x, m_map(b.value));
    else if (a.sharpness > 0.99) {
      addKnot(i, middle, m_map(a.value));
      addKnot(i, middle, m_map(b.value));
      addKnot(i, b.x, m_map(b.value));
    } else
      addPieces(i, middle);
  }

  void addPieces(std::size_t i, double middle) {
    std::vector<double> ends = {m_nodes[i].x, middle, findCapCrossing(i), m_nodes[i + 1].x};
    std::sort(ends.begin(), ends.end());
    for (std::size_t k = 0; k + 1 < ends.size(); ++k)
      if (ends[k] < ends[k + 1])
        addChord(i, ends[k], ends[k + 1], evaluate(i, ends[k]), evaluate(i, ends[k + 1]));
    addKnot(i, m_nodes[i + 1].x, m_map(m_nodes[i + 1].value));
  }

  /// Position where the opacity crosses its cap within a segment (by bisection: opacity is
  /// monotonic there). Without a crossing, and for colors: the segment's begin.
  double findCapCrossing(std::size_t i) const {
    double low = m_nodes[i].x, high = m_nodes[i + 1].x;
    if constexpr (std::is_same_v<Node, OpacityNode>) {
      const bool cappedLow = m_nodes[i].value > opacityCap;
      if (cappedLow == (m_nodes[i + 1].value > opacityCap))
        return low;
      for (int step = 0; step < 100; ++step) {
        const double middle = 0.5 * (low + high);
        const bool capped = evaluateSegment(m_nodes[i], m_nodes[i + 1], middle) > opacityCap;
        (capped == cappedLow ? low : high) = middle;
      }
    }
    return low;
  }

  void addChord(std::size_t segment, double begin, double end, const Value& beginValue,
                const Value& endValue) {
    Chord chord{segment, begin, end, beginValue, endValue};
    constexpr int probes = 8;
    for (int k = 1; k < probes; ++k) {
      const double t = static_cast<double>(k) / probes;
      const Value exact = evaluate(segment, begin + t * (end - begin));
      const Value difference = (beginValue + (endValue - beginValue) * t - exact).abs();
      if ((difference > m_floor).any())
        chord.error = std::max(chord.error, Value(difference / (exact.abs() + m_floor)).maxCoeff());
    }
    m_chords.push(chord);
  }

  void refine() {
    for (std::size_t added = 0; added < maxKnots && !m_chords.empty(); ++added) {
      const Chord worst = m_chords.top();
      const double middle = 0.5 * (worst.begin + worst.end);
      if (worst.error <= 0.5 * tolerance || !(worst.begin < middle && middle < worst.end))
        return;
      m_chords.pop();
      const Value middleValue = evaluate(worst.segment, middle);
      addChord(worst.segment, worst.begin, middle, worst.beginValue, middleValue);
      addChord(worst.segment, middle, worst.end, middleValue, worst.endValue);
    }
  }

  const std::vector<Node>& m_nodes;
  Map m_map;
  double m_floor = 0.0;
  std::priority_queue<Chord> m_chords;
  std::vector<SegmentKnot> m_knots;
};

template <int Channels, typename Node, typename Map>
PiecewiseLinear<Channels> makeTable(const std::vector<Node>& nodes, Map map) {
  return Tabulator<Channels, Node, Map>(nodes, std::move(map)).build();
}

bool isInUnitRange(double x) {
  return x >= 0.0 && x <= 1.0;
}
bool isInUnitRange(const Rgb& c) {
  return (c >= 0.0 && c <= 1.0).all();
}

template <typename Node>
void checkNodes(const std::vector<Node>& nodes, const std::string& name,
                const std::string& source) {
  if (nodes.empty() || nodes.size() > maxNodes)
    throw fieldError(source, name, "has ", nodes.size(), " points; expected 1 to ", maxNodes);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const std::string place = name + ", point " + std::to_string(i + 1);
    const Node& node = nodes[i];
    if (!(std::abs(node.x) <= 1e38) || (i > 0 && node.x < nodes[i - 1].x))
      throw fieldError(source, place,
                       "x must be at most 1e38 and not less than the previous point's");
    if (!isInUnitRange(node.value))
      throw fieldError(source, place, "value must be from 0 to 1");
    if (!isInUnitRange(node.midpoint) || !isInUnitRange(node.sharpness))
      throw fieldError(source, place, "midpoint and sharpness must be from 0 to 1");
  }
}

void check(const VolumeProperty& p, const std::string& source) {
  checkNodes(p.scalarOpacity, "scalar opacity", source);
  checkNodes(p.color, "color", source);
  if (!p.gradientOpacity.empty())
    checkNodes(p.gradientOpacity, "gradient opacity", source);
  const auto require = [&](bool isUsable, const char* field, const char* hint) {
    if (!isUsable)
      throw fieldError(source, field, hint);
  };
  require(p.unitDistance > 0.0 && std::isfinite(p.unitDistance), "scalarOpacityUnitDistance",
          "must be greater than 0 mm");
  require(std::abs(p.anisotropy) < 1.0, "scatteringAnisotropy",
          "must be greater than -1 and less than 1");
  for (const auto& [field, x] : {std::pair("diffuse", p.diffuse),
                                 {"specular", p.specular},
                                 {"specularPower", p.specularPower}})
    require(x >= 0.0 && std::isfinite(x), field, "must be finite and not negative");
}

} // namespace

double evaluateCurve(double u, double midpoint, double sharpness) {
  const double m = clampMidpoint(midpoint);
  double s = u < m ? 0.5 * u / m : 0.5 + 0.5 * (u - m) / (1.0 - m);
  if (sharpness > 0.99)
    return s < 0.5 ? 0.0 : 1.0;
  if (sharpness < 0.01)
    return s;
  const double power = 1.0 + 10.0 * sharpness;
  s = s < 0.5 ? 0.5 * std::pow(2.0 * s, power) : 1.0 - 0.5 * std::pow(2.0 * (1.0 - s), power);
  const double ends = s * (s * (2.0 * s - 3.0) + 1.0); // Hermite terms of both end slopes
  return std::clamp(s * s * (3.0 - 2.0 * s) + (1.0 - sharpness) * ends, 0.0, 1.0);
}

TransferFunction tabulate(const VolumeProperty& property, const std::string& source) {
  check(property, source);
  const auto extinction = [unit = property.unitDistance](double opacity) {
    return ScalarFunction::Value(-std::log1p(-std::min(opacity, opacityCap)) / unit);
  };
  const auto unchanged = [](double opacity) { return ScalarFunction::Value(opacity); };
  const auto isOne = [](const OpacityNode& node) { return node.value == 1.0; };

  TransferFunction result{.extinction = makeTable<1>(property.scalarOpacity, extinction),
                          .albedo = makeTable<3>(property.color, decodeSrgb),
                          .g = property.anisotropy};
  const auto& gradient = property.gradientOpacity;
  if (!std::all_of(gradient.begin(), gradient.end(), isOne))
    result.gradientOpacity = makeTable<1>(gradient, unchanged);
  if (property.shade)
    result.shading = SurfaceShading{.diffuse = property.diffuse,
                                    .specular = property.specular,
                                    .power = property.specularPower};
  return result;
}

} // namespace fenestra::core
