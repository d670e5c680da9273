#pragma once

#include "fenestra/Image.h"
#include "scene/FinishedImage.h"

namespace fenestra {
inline namespace v1 {

/// Image of a render's result. `preset`: name, or null. `filtered`: nullopt: not denoised.
Image makeImage(const core::PreparedScene& scene, const std::string* preset,
                const core::RenderSettings& settings, const core::RenderResult& result,
                const std::optional<core::FilteredImage>& filtered);

} // namespace v1
} // namespace fenestra
