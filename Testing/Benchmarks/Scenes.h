#pragma once
// Scenes of scenes.txt; each is a command line of `fenestra`.

#include "program/RenderOptions.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace fenestra::core::benchmarks {

/// Options of a command line of `fenestra`. Throws Error (usage), also if it renders nothing.
RenderOptions parseRenderOptions(const std::vector<std::string>& arguments);

/// Folders that replace {reference}, {data} and {phantoms} in the table.
struct Folders {
  std::filesystem::path reference, data, phantoms;
};

/// Folders of the build. The environment variables FENESTRA_REFERENCE and FENESTRA_DATA select
/// others, and `phantoms` those of the phantoms.
Folders findFolders(const std::optional<std::string>& phantoms);

enum class ReferenceSource {
  external, ///< other renderers ("independent" in the table): FILE_best.exr and FILE_best_se.exr
            ///< next to FILE.arguments
  oracle,   ///< Testing/Oracle; for scenes without a clip
  fenestra, ///< Fenestra with other seeds ("product"), for scenes that would take the oracle hours
};

struct SceneCase {
  std::string name;
  ReferenceSource source = ReferenceSource::fenestra;
  std::filesystem::path external;     ///< FILE of an external reference
  std::vector<std::string> arguments; ///< arguments of `fenestra`
  std::string missing;                ///< a required file that does not exist, or empty

  RenderOptions options() const { return parseRenderOptions(arguments); }
};

/// Throws Error (input) for an invalid table.
std::vector<SceneCase> readScenes(const std::filesystem::path& table, const Folders& folders);

} // namespace fenestra::core::benchmarks
