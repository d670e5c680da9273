#pragma once
// Tail probabilities of Student's t.

namespace fenestra {

/// P(|T| >= |t|) for Student's t with `freedom` degrees of freedom (> 0, whole or not).
double studentTail(double t, double freedom);

} // namespace fenestra
