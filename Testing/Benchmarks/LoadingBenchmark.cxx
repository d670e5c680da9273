// Time and memory from the start to the first sample of a large volume, compared with reading the
// file by ITK alone. They run alternately, each in its own process; the minimum of the runs counts.
//
//     LoadingBenchmark [EDGE [RUNS]]     (default: 512 voxels, 3 runs)

#include "ProcessCost.h"
#include "TemporaryFolder.h"
#include "WriteResults.h"
#include "files/formats/NrrdWriter.h"

#include <itkImage.h>
#include <itkImageFileReader.h>
#include <itkNrrdImageIO.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace fenestra::core {
namespace {

using Path = std::filesystem::path;

/// Phantom of a body with fat, muscle, lungs and ribs. Its noise is CT-like: gzip halves the size.
std::vector<std::int16_t> makeBody(std::int64_t edge) {
  std::vector<std::int16_t> voxels;
  voxels.reserve(static_cast<std::size_t>(edge * edge * edge));
  std::uint64_t state = 1;
  const auto noise = [&state](std::uint64_t amplitude) { // xorshift64
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return static_cast<double>(state % amplitude) - static_cast<double>(amplitude / 2);
  };
  const auto toSignedUnit = [edge](std::int64_t i) {
    return 2.0 * static_cast<double>(i) / static_cast<double>(edge) - 1.0;
  };
  for (std::int64_t z = 0; z < edge; ++z)
    for (std::int64_t y = 0; y < edge; ++y)
      for (std::int64_t x = 0; x < edge; ++x) {
        const Vec3 p(toSignedUnit(x), toSignedUnit(y), toSignedUnit(z));
        const double radius = p.x() * p.x() + 1.4 * p.y() * p.y();
        const double lung = std::pow(std::abs(p.x()) - 0.3, 2) + p.y() * p.y();
        const double along = std::fmod(std::abs(5.0 * p.z() + p.x()), 1.0);
        double value = 40.0 + 60.0 * std::sin(9.0 * p.x()) * std::sin(8.0 * p.y() + 3.0 * p.z());
        if (radius > 0.62)
          value = -90.0;
        else if (lung < 0.08)
          value = -850.0;
        else if (along < 0.2 && radius > 0.4 && radius < 0.5)
          value = 700.0;
        const bool air = radius > 0.75;
        voxels.push_back(static_cast<std::int16_t>(air ? -1000.0 + noise(4) : value + noise(64)));
      }
  return voxels;
}

void writeRaw(const Path& path, std::int64_t edge, const std::vector<std::int16_t>& voxels) {
  std::ofstream file(path, std::ios::binary);
  file << "NRRD0004\ntype: short\ndimension: 3\nsizes: " << edge << ' ' << edge << ' ' << edge
       << "\nspacings: 0.5 0.5 0.5\nendian: little\nencoding: raw\n\n";
  file.write(reinterpret_cast<const char*>(voxels.data()),
             static_cast<std::streamsize>(voxels.size() * sizeof(voxels[0])));
}

void readWithItk(const std::string& file) {
  const auto reader = itk::ImageFileReader<itk::Image<std::int16_t, 3>>::New();
  reader->SetImageIO(itk::NrrdImageIO::New());
  reader->SetFileName(file);
  reader->Update();
}

void print(const std::string& name, const Cost& cost) {
  std::cout << std::left << std::setw(22) << name << std::right << std::fixed
            << std::setprecision(3) << std::setw(10) << cost.seconds << std::setw(10)
            << cost.cpuSeconds << std::setprecision(0) << std::setw(10) << cost.peakMegabytes
            << '\n';
}

/// Compares reading by ITK with the complete program, alternately.
void compare(const std::string& self, const Path& folder, const std::string& name, int runs) {
  const std::string file = folder / name;
  Cost itkCost;
  Cost fenestraCost;
  for (int run = 0; run < runs; ++run) {
    itkCost.keepMinimum(measureCost({self, "--bare", file}));
    fenestraCost.keepMinimum(
        measureCost({FENESTRA_EXECUTABLE, file, "--clip", "none", "--size", "64x64", "--samples",
                     "1", "--progress", "none", "--output", folder / "image.exr"}));
  }
  print("ITK " + name, itkCost);
  print("Fenestra " + name, fenestraCost);
  std::cout << std::setprecision(2) << "  " << fenestraCost.seconds / itkCost.seconds
            << " x the time of ITK alone (CPU: " << fenestraCost.cpuSeconds / itkCost.cpuSeconds
            << " x), " << fenestraCost.seconds - itkCost.seconds << " s more\n";
}

void measure(const std::string& self, std::int64_t edge, int runs) {
  const TemporaryFolder folder;
  {
    const std::vector<std::int16_t> voxels = makeBody(edge);
    std::cout << edge << "^3 voxels of 16 bits: " << voxels.size() * 2 / 1'000'000 << " MB\n"
              << std::setw(32) << "s" << std::setw(10) << "CPU s" << std::setw(10) << "peak MB"
              << std::endl;
    writeRaw(folder / "raw.nrrd", edge, voxels);
    writeFile(folder / "gzip.nrrd",
              encodeNrrd({.type = "short", .size = Size3::Constant(edge)},
                         {reinterpret_cast<const char*>(voxels.data()), voxels.size() * 2}));
  }
  for (const char* name : {"raw.nrrd", "gzip.nrrd"})
    compare(self, folder / "", name, runs);
}

} // namespace
} // namespace fenestra::core

int main(int count, char** arguments) {
  const std::vector<std::string> words(arguments, arguments + count);
  try {
    if (words.size() == 3 && words[1] == "--bare")
      fenestra::core::readWithItk(words[2]);
    else
      fenestra::core::measure(words[0], words.size() > 1 ? std::stoi(words[1]) : 512,
                              words.size() > 2 ? std::stoi(words[2]) : 3);
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
  return 0;
}
