#include "files/slicer/SlicerPresets.h"

#include "base/Text.h"

#include <cstdlib>
#include <string>

namespace fenestra::core {
namespace {

using Path = std::filesystem::path;

/// presets.xml in share/Slicer-VERSION/qt-loadable-modules (the share directory of
/// qSlicerLoadableModule); of several versions, the last by name.
std::optional<Path> findPresets(const Path& home) {
  std::optional<Path> last;
  std::error_code failed;
  for (std::filesystem::directory_iterator entry(home / "share", failed), end;
       !failed && entry != end; entry.increment(failed)) {
    const Path file = entry->path() / "qt-loadable-modules" / "VolumeRendering" / "presets.xml";
    std::error_code missing;
    if (entry->path().filename().string().starts_with("Slicer-") &&
        std::filesystem::is_regular_file(file, missing) && (!last || *last < file))
      last = file;
  }
  return last;
}

/// Folder of the first Slicer launcher in PATH, with links resolved.
std::optional<Path> findHome() {
  const char* const path = std::getenv("PATH");
  for (const std::string& folder : split(path ? path : "", ':')) {
    std::error_code failed;
    const Path launcher = std::filesystem::canonical(Path(folder) / "Slicer", failed);
    if (!failed && std::filesystem::is_regular_file(launcher, failed))
      return launcher.parent_path();
  }
  return std::nullopt;
}

} // namespace

std::optional<Path> findSlicerPresets() {
  if (const char* const home = std::getenv("SLICER_HOME"); home && *home)
    if (auto presets = findPresets(home))
      return presets;
  const auto home = findHome();
  return home ? findPresets(*home) : std::nullopt;
}

} // namespace fenestra::core
