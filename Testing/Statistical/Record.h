#pragma once
// Where tests leave fragments of the report: in the folder that FENESTRA_REPORT names in the
// environment. Without it nothing is written.

#include <cstdlib>
#include <filesystem>
#include <optional>

namespace fenestra::testing {

inline std::optional<std::filesystem::path> reportFolder() {
  const char* folder = std::getenv("FENESTRA_REPORT");
  if (!folder)
    return std::nullopt;
  std::filesystem::create_directories(folder);
  return folder;
}

} // namespace fenestra::testing
