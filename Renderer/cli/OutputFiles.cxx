#include "cli/OutputFiles.h"

#include "core/Error.h"

namespace fenestra {
namespace {

bool sameFile(const std::filesystem::path& a, const std::filesystem::path& b) {
  std::error_code error;
  if (std::filesystem::equivalent(a, b, error))
    return true;
  const auto absolute = [&error](const std::filesystem::path& path) {
    return std::filesystem::weakly_canonical(std::filesystem::absolute(path, error), error);
  };
  return absolute(a) == absolute(b);
}

} // namespace

void checkDistinct(const std::vector<std::filesystem::path>& inputs,
                   const std::vector<std::filesystem::path>& results) {
  for (std::size_t i = 0; i < results.size(); ++i) {
    for (const std::filesystem::path& input : inputs)
      if (sameFile(results[i], input))
        throw usageError(results[i].string() +
                         ": would replace an input file; choose another name");
    for (std::size_t other = 0; other < i; ++other)
      if (sameFile(results[i], results[other]))
        throw usageError(results[i].string() + ": would be written twice; give each result a name "
                                               "of its own");
  }
}

} // namespace fenestra
