#pragma once
// Reference images to which renders are compared.

#include "Scenes.h"

#include "image/Image.h"
#include "scene/PreparedScene.h"

namespace fenestra::core::benchmarks {

struct ReferenceSettings {
  std::filesystem::path folder; ///< cache of references
  double noise = 0.03;          ///< target of Film::noise() for a new reference
  double seconds = 1800.0;      ///< time limit of a new reference
  std::uint64_t samples = 0;    ///< of a new reference; replaces noise and seconds; 0: unused
};

struct Reference {
  Image image;         ///< R, G, B and their standard errors
  std::string source;  ///< "independent" (another renderer), "oracle" or "product" (Fenestra)
  double relMse = 0.0; ///< of the reference, from its standard errors

  Reference(Image imageIn, std::string sourceIn);
};

/// Returns the scene's external reference if there is one of the same size, else the cached
/// reference, else a new one, which is cached. A cached reference stores its command line in the
/// header. It is rendered again if that line has changed, but not if files named in it have
/// changed. Throws Error.
Reference getOrRenderReference(const SceneCase& sceneCase, const PreparedScene& scene,
                               const RenderSettings& settings, const ReferenceSettings& wanted);

/// Image with R, G, B and their standard errors.
Image toImage(const Film& film, const PreparedScene& scene);

} // namespace fenestra::core::benchmarks
