#pragma once
// Common part of the fuzz targets: writes the input to a file, and checks that the reader either
// succeeds or throws an Error. libFuzzer reports any other outcome: another exception, a crash, a
// sanitizer error, or excessive time or memory.

#include "TemporaryFolder.h"
#include "base/Error.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace fenestra::core::fuzzing {

/// Temporary folder of this process. run.sh sets TMPDIR to a folder in memory.
inline const TemporaryFolder& folder() {
  static const TemporaryFolder instance;
  return instance;
}

/// Writes the input to the file `name` in folder(), replacing the previous input.
inline std::filesystem::path writeInput(std::string_view bytes, const std::string& name) {
  const std::filesystem::path path = folder() / name;
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  const bool isComplete =
      file >= 0 && ::write(file, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size());
  if (file >= 0)
    ::close(file);
  if (!isComplete)
    throw std::runtime_error("cannot write the input to " + path.string());
  return path;
}

/// Runs a reader. It may only throw an Error, whose text must be one line and not empty.
template <typename Read>
void expectReadOrError(Read&& read) {
  try {
    read();
  } catch (const Error& error) {
    const std::string_view line = error.what();
    if (line.empty() || line.find('\n') != std::string_view::npos)
      throw std::logic_error("error text is not one line: " + std::string(line));
  }
}

/// File name selected by the first byte of the input, which is removed from it.
template <std::size_t N>
std::string chooseName(std::string_view& input, const std::array<const char*, N>& names) {
  if (input.empty())
    return names[0];
  const auto first = static_cast<unsigned char>(input[0]);
  input.remove_prefix(1);
  // Seeds start with a digit, since they are written by hand.
  return names[(first >= '0' ? first - std::size_t{'0'} : first) % N];
}

/// Named fuzz target; FENESTRA_FUZZ_TARGET selects one (see Fuzzers.cxx).
struct Target {
  using Function = void (*)(std::string_view);
  Target(const char* name, Function function) { all()[name] = function; }
  static std::map<std::string, Function>& all() {
    static std::map<std::string, Function> functions;
    return functions;
  }
};

} // namespace fenestra::core::fuzzing

/// Defines the function of a target, with the parameter `std::string_view input`.
#define FENESTRA_FUZZ(name, input)                                                                 \
  static void fuzz##name(std::string_view input);                                                  \
  static const fenestra::core::fuzzing::Target target##name(#name, fuzz##name);                    \
  static void fuzz##name(std::string_view input)
