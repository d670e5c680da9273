#pragma once
// Which library reads and writes a picture file, by the name's extension. For io's own sources.

#include <filesystem>
#include <optional>

namespace itk {
class ImageIOBase;
template <typename T>
class SmartPointer;
} // namespace itk

namespace fenestra {

enum class ImageFormat { exr, nrrd, png, tiff };

inline constexpr const char* imageExtensions = ".exr, .nrrd, .png or .tif";

/// By extension, in either case; nothing where it is unknown.
std::optional<ImageFormat> imageFormat(const std::filesystem::path& path);

/// ITK's reader and writer of a format, without going through its object factories. Not for exr.
itk::SmartPointer<itk::ImageIOBase> itkImageIo(ImageFormat format);

} // namespace fenestra
