// All fuzz targets in one executable. The environment variable FENESTRA_FUZZ_TARGET selects one.
#include "Harness.h"
#include "io/Sandbox.h"

#include <cstdlib>
#include <iostream>

namespace {

using fenestra::core::fuzzing::Target;

Target::Function chosen = nullptr;

} // namespace

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  fenestra::core::serveSandbox(*argc, *argv);
  const char* name = std::getenv("FENESTRA_FUZZ_TARGET");
  const auto found = Target::all().find(name ? name : "");
  if (found == Target::all().end()) {
    std::cerr << "FENESTRA_FUZZ_TARGET must name one of:";
    for (const auto& [known, function] : Target::all())
      std::cerr << ' ' << known;
    std::cerr << '\n';
    std::exit(2);
  }
  chosen = found->second;
  // Fenestra's output would mix with libFuzzer's.
  std::cout.rdbuf(nullptr);
  std::cerr.rdbuf(nullptr);
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  fenestra::core::fuzzing::expectReadOrError([bytes] { chosen(bytes); });
  return 0;
}
