#include "MedicalFiles.h"

#include <itkMetaDataObject.h>
#include <itkMetaImageIO.h>
#include <itkNiftiImageIO.h>
#include <itkNrrdImageIO.h>

namespace fenestra::core {

template <typename T>
void writeFile(const std::filesystem::path& path, const std::vector<T>& samples,
               const FileGeometry& geometry) {
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

// Sample types that tests write.
template void writeFile(const std::filesystem::path&, const std::vector<std::int8_t>&,
                        const FileGeometry&);
template void writeFile(const std::filesystem::path&, const std::vector<std::uint8_t>&,
                        const FileGeometry&);
template void writeFile(const std::filesystem::path&, const std::vector<std::int16_t>&,
                        const FileGeometry&);
template void writeFile(const std::filesystem::path&, const std::vector<std::uint16_t>&,
                        const FileGeometry&);
template void writeFile(const std::filesystem::path&, const std::vector<std::int32_t>&,
                        const FileGeometry&);
template void writeFile(const std::filesystem::path&, const std::vector<std::uint32_t>&,
                        const FileGeometry&);
template void writeFile(const std::filesystem::path&, const std::vector<std::int64_t>&,
                        const FileGeometry&);
template void writeFile(const std::filesystem::path&, const std::vector<std::uint64_t>&,
                        const FileGeometry&);
template void writeFile(const std::filesystem::path&, const std::vector<float>&,
                        const FileGeometry&);
template void writeFile(const std::filesystem::path&, const std::vector<double>&,
                        const FileGeometry&);

} // namespace fenestra::core
