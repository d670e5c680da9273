#pragma once
// The pictures that renders are measured against.

#include "Scenes.h"

#include "image/Image.h"
#include "session/Scene.h"

namespace fenestra::benchmarks {

struct ReferenceSettings {
  std::filesystem::path folder; ///< where pictures that were made once are kept
  double noise = 0.03;          ///< Film::noise() at which a picture that is made here is done
  double seconds = 1800.0;      ///< and how long it may take
};

struct Reference {
  Image image; ///< R, G, B and their standard errors
  std::string maker;
  double relMse = 0.0; ///< of the reference itself, by its standard errors

  Reference(Image imageIn, std::string makerIn);
};

/// An independent reference where the scene has one of the picture's size, else the one kept in the
/// folder, else made now and kept. One that is kept says in its header of which command line it is;
/// it is made anew where that has changed, but not where the files that it names have. Throws
/// Error.
Reference findReference(const SceneCase& sceneCase, const Scene& scene,
                        const RenderSettings& settings, const ReferenceSettings& wanted);

/// R, G, B and their standard errors.
Image imageOf(const Film& film, const Scene& scene);

} // namespace fenestra::benchmarks
