#pragma once
// Small medical image files for tests, in a folder that goes away with its test.

#include "TemporaryFolder.h"
#include "core/Error.h"

#include <itkMetaDataObject.h>
#include <itkMetaImageIO.h>
#include <itkNiftiImageIO.h>
#include <itkNrrdImageIO.h>

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace fenestra {

template <typename T>
std::string rawBytes(const std::vector<T>& samples) {
  return {reinterpret_cast<const char*>(samples.data()), samples.size() * sizeof(T)};
}

/// Geometry as ITK writes it: LPS.
struct FileGeometry {
  std::vector<std::size_t> size = {3, 4, 2};
  std::vector<std::vector<double>> directions = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  std::vector<double> spacing = {1, 1, 1};
  std::vector<double> origin = {0, 0, 0};
  unsigned components = 1;
  bool compress = false;
  std::map<std::string, std::string> fields = {};
};

template <typename T>
void writeFile(const std::filesystem::path& path, const std::vector<T>& samples,
               const FileGeometry& geometry = {}) {
  const std::string name = path.string();
  itk::ImageIOBase::Pointer io;
  if (name.find(".nii") != std::string::npos)
    io = itk::NiftiImageIO::New().GetPointer();
  else if (name.ends_with(".mha") || name.ends_with(".mhd"))
    io = itk::MetaImageIO::New().GetPointer();
  else
    io = itk::NrrdImageIO::New().GetPointer();
  const auto axes = static_cast<unsigned>(geometry.size.size());
  io->SetFileName(name);
  io->SetNumberOfDimensions(axes);
  itk::ImageIORegion region(axes);
  for (unsigned a = 0; a < axes; ++a) {
    io->SetDimensions(a, geometry.size[a]);
    std::vector<double> direction(axes, 0.0);
    for (unsigned c = 0; a < 3 && c < std::min(axes, 3U); ++c)
      direction[c] = geometry.directions[a][c];
    if (a >= 3)
      direction[a] = 1.0;
    io->SetDirection(a, direction);
    io->SetSpacing(a, a < 3 ? geometry.spacing[a] : 1.0);
    io->SetOrigin(a, a < 3 ? geometry.origin[a] : 0.0);
    region.SetSize(a, geometry.size[a]);
  }
  io->SetIORegion(region);
  io->SetPixelType(geometry.components == 1 ? itk::IOPixelEnum::SCALAR : itk::IOPixelEnum::VECTOR);
  io->SetNumberOfComponents(geometry.components);
  io->SetComponentType(itk::ImageIOBase::MapPixelType<T>::CType);
  io->SetUseCompression(geometry.compress);
  for (const auto& [key, value] : geometry.fields)
    itk::EncapsulateMetaData<std::string>(io->GetMetaDataDictionary(), key, value);
  io->WriteImageInformation();
  io->Write(samples.data());
}

/// Expects an Error (input) of one line that names the file and contains `text`, and nothing on the
/// standard error stream.
template <typename Call>
void expectRefused(const std::filesystem::path& path, const std::string& text, Call&& call) {
  ::testing::internal::CaptureStderr();
  std::string line = "(no error)";
  try {
    call();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    line = error.what();
  } catch (const std::exception& error) {
    line = std::string("(another exception) ") + error.what();
  }
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "") << path;
  EXPECT_EQ(line.find(path.string() + ": "), 0u) << line << "\n" << bytesOf(path).substr(0, 300);
  EXPECT_NE(line.find(text), std::string::npos) << line;
  EXPECT_EQ(line.find('\n'), std::string::npos) << line;
}

} // namespace fenestra
