#include "model/medium/TransferFunction.h"

namespace fenestra {
namespace {

template <int Channels>
PiecewiseLinear<Channels> moved(const PiecewiseLinear<Channels>& f, double offset) {
  auto knots = f.knots();
  for (auto& knot : knots)
    knot.position += offset;
  return PiecewiseLinear<Channels>(std::move(knots));
}

} // namespace

TransferFunction TransferFunction::shifted(double offset) const {
  TransferFunction result = *this;
  result.extinction = moved(extinction, offset);
  result.albedo = moved(albedo, offset);
  return result;
}

TransferFunction TransferFunction::scaled(double factor) const {
  TransferFunction result = *this;
  auto knots = extinction.knots();
  for (auto& knot : knots)
    knot.value *= factor;
  result.extinction = ScalarFunction(std::move(knots));
  return result;
}

} // namespace fenestra
