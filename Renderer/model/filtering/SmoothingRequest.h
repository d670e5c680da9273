#pragma once
// Which requests are rendered from a smoothed volume.

namespace fenestra::core {

/// --volume-smoothing
struct SmoothingRequest {
  enum class Kind { automatic, off, given };

  Kind kind = Kind::off;
  double noise = 0.0; ///< of a given strength: standard deviation, scalar units

  bool operator==(const SmoothingRequest&) const = default;
};

/// What a request is for.
struct SmoothingPurpose {
  bool hasDisplayImage = false; ///< an output is .png or .tif
  bool isServer = false;        ///< fenestra serve: its images are displayed
  bool isShard = false;         ///< its image is not known yet; merge may write raw radiance
};

/// One request has one medium: all its outputs show the smoothed volume, or none. Without a display
/// image, `automatic` leaves the volume raw, for measurements.
inline bool isSmoothed(const SmoothingRequest& request, const SmoothingPurpose& purpose) {
  if (request.kind != SmoothingRequest::Kind::automatic)
    return request.kind == SmoothingRequest::Kind::given;
  return (purpose.hasDisplayImage || purpose.isServer) && !purpose.isShard;
}

} // namespace fenestra::core
