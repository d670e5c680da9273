// usage: MakeSamples FOLDER: writes the format variants that baselines.sh renders.
#include "SampleFiles.h"

#include <cstdio>
#include <exception>

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: MakeSamples FOLDER\n");
    return 2;
  }
  try {
    constexpr double spacing = 1.6; // mm: 25 voxels per axis; the largest file has 130 KB
    fenestra::core::testing::writeFormatVariants(argv[1], spacing);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "MakeSamples: %s\n", error.what());
    return 4;
  }
}
