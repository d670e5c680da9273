#pragma once
// Whether two renders of one scene agree, within their own errors.

#include "image/Image.h"

namespace fenestra {

/// Means of R, G, B over square tiles of `size` pixels (fewer at the right and lower border; a
/// great size makes the picture one tile), with standard errors, and the sum of samples.N if
/// present. Throws Error (input) without R, G, B, error.R, error.G or error.B.
Image computeTileMeans(const Image& image, int size);

/// p-value of the largest difference of any R, G or B between two renders of one scene with
/// independent seeds: Student's t of each value, with a variance per sample pooled over both
/// renders, corrected for the number of values (Šidák 1967). A mean of few bright paths is skewed
/// like a count: the degrees of freedom are at most mean^2 / se^2 of the render with fewer samples,
/// which is the number of its paths if all are equally bright; fewer degrees give heavier tails. 0
/// if exact values (ImagePair::isUninformative) differ or a value is not finite. Throws like
/// computeTileMeans, and for a missing samples.N or different sizes.
double computeAgreement(const Image& a, const Image& b);

/// P(|T| >= |t|) for Student's t with `freedom` degrees of freedom (> 0, whole or not).
double studentTail(double t, double dof);

} // namespace fenestra
