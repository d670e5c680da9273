#pragma once
// Statistical test of whether two renders of one scene agree within their estimated errors.

#include "image/Image.h"

namespace fenestra::core {

/// Means of R, G and B over square tiles of `size` pixels, with standard errors, and the sum of
/// samples.N if present. Tiles at the right and lower border may be smaller; a large `size` gives
/// one tile. Throws Error (input) without R, G, B, error.R, error.G or error.B.
Image computeTileMeans(const Image& image, int size);

/// p-value of the largest difference of any R, G or B between two renders of one scene with
/// independent seeds. Each value has a Student's t with a variance per sample pooled over both
/// renders; the p-value is corrected for the number of values (Šidák 1967). A mean of few bright
/// paths is as skewed as a count, so the degrees of freedom are at most mean^2 / se^2 of the render
/// with fewer samples: its number of paths if all are equally bright. Fewer degrees give heavier
/// tails. 0 if exact values (ImagePair::isUninformative) differ or a value is not finite. Throws
/// like computeTileMeans, and for a missing samples.N or different sizes.
double computeAgreement(const Image& a, const Image& b);

/// P(|T| >= |t|) for Student's t with `dof` degrees of freedom, which may be any real number > 0.
double studentTail(double t, double dof);

} // namespace fenestra::core
