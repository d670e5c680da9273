#pragma once
// Tail probabilities of Student's t.

namespace fenestra {

/// Probability of |t| at least this large with so many degrees of freedom (> 0, not only whole
/// ones).
double studentTail(double t, double freedom);

} // namespace fenestra
