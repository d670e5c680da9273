// CPU time in which Fenestra reads a DICOM series, child processes included, relative to ITK's
// GDCMSeriesFileNames and ImageSeriesReader. They run alternately, each in its own process.
//
//     SeriesBenchmark [SLICES [RUNS]]     (default: 500 slices of 512 x 512 voxels, 5 runs)

#include "ProcessCost.h"
#include "TemporaryFolder.h"
#include "Unit/DicomFile.h"
#include "base/Text.h"
#include "base/Vector.h"
#include "files/medical/DicomSeries.h"

#include <itkGDCMImageIO.h>
#include <itkGDCMSeriesFileNames.h>
#include <itkImage.h>
#include <itkImageSeriesReader.h>

#include <cstdio>
#include <iostream>

namespace fenestra::core {
namespace {

using Path = std::filesystem::path;
constexpr unsigned side = 512;

/// Noise around a gradient, 16 bits.
std::string makePixels(int slice) {
  std::string pixels(2 * side * side, '\0');
  std::uint32_t state = 1 + static_cast<std::uint32_t>(slice);
  for (std::size_t i = 0; i < pixels.size(); i += 2) {
    state = state * 1664525U + 1013904223U; // of Numerical Recipes
    const std::size_t value = (i >> 10) + (state >> 26);
    pixels[i] = static_cast<char>(value & 255U);
    pixels[i + 1] = static_cast<char>(value >> 8);
  }
  return pixels;
}

std::string makeSlice(int slice) {
  using namespace dicom;
  const std::string number = std::to_string(slice + 1);
  return makeFile({makeText(0x00080008, "CS", "ORIGINAL\\PRIMARY\\AXIAL"),
                   makeText(0x00080016, "UI", "1.2.840.10008.5.1.4.1.1.2"),
                   makeText(0x00080018, "UI", concat("1.2.840.99.1.", number)),
                   makeText(0x00080060, "CS", "CT"),
                   makeText(0x00100010, "PN", "Phantom"),
                   makeText(0x0020000d, "UI", "1.2.840.99.2"),
                   makeText(0x0020000e, "UI", "1.2.840.99.3"),
                   makeText(0x00200011, "IS", "4"),
                   makeText(0x00200013, "IS", number),
                   makeDecimals(0x00200032, std::vector{-180.0, -180.0, 0.7 * slice}),
                   makeDecimals(0x00200037, std::vector{1.0, 0.0, 0.0, 0.0, 1.0, 0.0}),
                   makeText(0x00200052, "UI", "1.2.840.99.4"),
                   makeShorts(0x00280002, {1}),
                   makeText(0x00280004, "CS", "MONOCHROME2"),
                   makeShorts(0x00280010, {side}),
                   makeShorts(0x00280011, {side}),
                   makeDecimals(0x00280030, std::vector{0.7, 0.7}),
                   makeShorts(0x00280100, {16}),
                   makeShorts(0x00280101, {16}),
                   makeShorts(0x00280102, {15}),
                   makeShorts(0x00280103, {1}),
                   makeDecimals(0x00281052, std::vector{-1024.0}),
                   makeDecimals(0x00281053, std::vector{1.0}),
                   {0x7fe00010, "OW", makePixels(slice)}},
                  Syntax::explicitLittle);
}

void readWithItk(const std::string& folder) {
  const auto names = itk::GDCMSeriesFileNames::New();
  names->SetDirectory(folder);
  const auto reader = itk::ImageSeriesReader<itk::Image<std::int16_t, 3>>::New();
  reader->SetImageIO(itk::GDCMImageIO::New());
  reader->SetFileNames(names->GetFileNames(names->GetSeriesUIDs().at(0)));
  reader->Update();
}

void readWithFenestra(const std::string& folder) {
  readDicomVolume(chooseSeries(findDicomSeries(folder).series, std::nullopt, folder));
}

int compare(const std::string& self, int slices, int runs) {
  const TemporaryFolder folder;
  for (int slice = 0; slice < slices; ++slice)
    folder.write(std::to_string(slice) + ".dcm", makeSlice(slice));
  std::vector<double> ratios;
  std::printf("%d slices: ITK CPU s, Fenestra CPU s, ratio; peak MB\n", slices);
  for (int run = 0; run < runs; ++run) {
    const Cost itkCost = measureCost({self, "--itk", folder.path()}),
               cost = measureCost({self, "--fenestra", folder.path()});
    ratios.push_back(cost.cpuSeconds / itkCost.cpuSeconds);
    std::printf("%8.3f %8.3f %8.3f %8.0f %8.0f\n", itkCost.cpuSeconds, cost.cpuSeconds,
                ratios.back(), itkCost.peakMegabytes, cost.peakMegabytes);
  }
  std::ranges::sort(ratios);
  std::printf("median ratio %.3f\n", ratios[ratios.size() / 2]);
  return 0;
}

int runMain(const std::vector<std::string>& words) {
  if (words.size() == 3 && words[1] == "--itk")
    readWithItk(words[2]);
  else if (words.size() == 3 && words[1] == "--fenestra")
    readWithFenestra(words[2]);
  else
    return compare("/proc/self/exe", words.size() > 1 ? std::stoi(words[1]) : 500,
                   words.size() > 2 ? std::stoi(words[2]) : 5);
  return 0;
}

} // namespace
} // namespace fenestra::core

int main(int count, char** arguments) {
  fenestra::core::serveSandbox(count, arguments);
  try {
    return fenestra::core::runMain({arguments, arguments + count});
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
