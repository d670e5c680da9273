#pragma once
// Reference pictures, against which renders are measured.

#include "Scenes.h"

#include "image/Image.h"
#include "scene/PreparedScene.h"

namespace fenestra::benchmarks {

struct ReferenceSettings {
  std::filesystem::path folder; ///< cache of references
  double noise = 0.03;          ///< target of Film::noise() for a new reference
  double seconds = 1800.0;      ///< time limit of a new reference
  std::uint64_t samples = 0;    ///< of a new reference, in place of noise and seconds; 0: by these
};

struct Reference {
  Image image; ///< R, G, B and their standard errors
  std::string maker;
  double relMse = 0.0; ///< of the reference itself, from its standard errors

  Reference(Image imageIn, std::string makerIn);
};

/// Returns the scene's independent reference if there is one of the picture's size, else the
/// reference cached in the folder, else a new one, which is cached. The header of a cached
/// reference holds its command line; the reference is rebuilt if that line has changed, but not if
/// files named in the line have. Throws Error.
Reference findReference(const SceneCase& sceneCase, const PreparedScene& scene,
                        const RenderSettings& settings, const ReferenceSettings& wanted);

/// Image with R, G, B and their standard errors.
Image toImage(const Film& film, const PreparedScene& scene);

} // namespace fenestra::benchmarks
