// usage: MakeSeeds FOLDER: writes the binary seeds to FOLDER/<target>/ and FOLDER/../Sandbox/.
#include "Regression/SampleFiles.h"
#include "SceneFixtures.h"
#include "TemporaryFolder.h"
#include "WriteResults.h"
#include "files/formats/ZipWriter.h"
#include "files/medical/DicomFields.h"
#include "io/Sandbox.h"

#include <itkAffineTransform.h>
#include <itkGDCMImageIO.h>
#include <itkHDF5TransformIO.h>
#include <itkMatlabTransformIO.h>
#include <itkMetaDataObject.h>
#include <itkTransformFileWriter.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <exception>
#include <map>

namespace fenestra {
namespace {

namespace fs = std::filesystem;

void save(const fs::path& folder, const std::string& name, const std::string& bytes) {
  fs::create_directories(folder);
  std::ofstream(folder / name, std::ios::binary) << bytes;
}

/// NIfTI volume of 3x3x2 16-bit voxels with a qform and an sform.
std::string makeNifti() {
  std::string header(352, '\0');
  const auto put = [&header](std::size_t at, auto value) {
    std::memcpy(header.data() + at, &value, sizeof(value));
  };
  put(0, std::int32_t{348});
  put(40, std::array<std::int16_t, 8>{3, 3, 3, 2, 1, 1, 1, 1}); // number of axes, sizes
  put(70, std::int16_t{4});                                     // int16
  put(72, std::int16_t{16});                                    // bits
  put(76,
      std::array<float, 8>{1.0f, 1.0f, 1.0f, 2.0f, 1.0f, 1.0f, 1.0f, 1.0f}); // handedness, spacings
  put(108, 352.0f);                                                          // offset of the voxels
  put(112, 1.0f);                                                            // slope
  put(252, std::int16_t{1});                                                 // qform
  put(254, std::int16_t{1});                                                 // sform
  put(280, std::array<float, 12>{1, 0, 0, -1, 0, 1, 0, -1, 0, 0, 2, -1});
  std::memcpy(header.data() + 344, "n+1", 4);
  return header + std::string("\1\0\2\0\3\0\4\0\5\0\6\0\7\0\10\0\11\0", 18) + std::string(18, '\0');
}

std::string makeMetaImage() {
  return "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n"
         "CompressedData = False\nTransformMatrix = 1 0 0 0 1 0 0 0 1\nOffset = 0 0 0\n"
         "ElementSpacing = 1 1 2\nDimSize = 2 2 2\nElementType = MET_SHORT\n"
         "ElementDataFile = LOCAL\n" +
         std::string(16, '\3');
}

/// `traps`: folder of the format variants.
void makeVolumes(const fs::path& corpus, const fs::path& traps) {
  for (const auto& entry : fs::directory_iterator(traps)) {
    const std::string name = entry.path().filename().string();
    if (name == "detached.nhdr") {
      std::string text = readBytes(entry.path());
      const std::string data = "detached.raw";
      text.replace(text.find(data), data.size(), "samples.raw");
      save(corpus / "Volume", name, "1" + text);
    } else if (name.ends_with(".seg.nrrd") || name == "labels.nrrd")
      save(corpus / "Segmentation", name, readBytes(entry.path()));
    else if (name.ends_with(".nrrd"))
      save(corpus / "Volume", name, "0" + readBytes(entry.path()));
  }
  save(corpus / "Volume", "volume.nii", "2" + makeNifti());
  save(corpus / "Volume", "volume.mha", "4" + makeMetaImage());
}

void makeImages(const fs::path& corpus) {
  const TemporaryFolder folder;
  Image image{3, 2, {}, {{"seed", "1"}}};
  for (const char* channel : {"R", "G", "B", "A"})
    image.channels[channel] = {0.0f, 0.1f, 0.5f, 1.0f, 1.0f, 1.0f};
  // The first byte selects the format.
  for (const auto& [digit, name] : {std::pair{"0", "picture.exr"},
                                    {"1", "picture.png"},
                                    {"2", "picture.tif"},
                                    {"3", "picture.nrrd"}}) {
    writeImage(image, {}, folder / name);
    save(corpus / "Image", name, digit + readBytes(folder / name));
  }
}

void makeTransforms(const fs::path& corpus) {
  const TemporaryFolder folder;
  const auto transform = itk::AffineTransform<double, 3>::New();
  transform->Translate(itk::Vector<double, 3>(3.0));
  transform->Rotate3D(itk::Vector<double, 3>(1.0), 0.3);
  const auto save = [&](const std::string& name, itk::TransformIOBaseTemplate<double>* io) {
    const auto writer = itk::TransformFileWriterTemplate<double>::New();
    writer->SetFileName((folder / name).string());
    writer->SetTransformIO(io);
    writer->SetInput(transform);
    writer->Update();
    fenestra::save(corpus / "../Sandbox/Transform", name, readBytes(folder / name));
  };
  save("affine.h5", itk::HDF5TransformIOTemplate<double>::New());
  save("affine.mat", itk::MatlabTransformIOTemplate<double>::New());
}

/// Writes replies of a sandboxed child about such files.
void makeReplies(const fs::path& corpus) {
  ReplyWriter composite;
  for (const char* type : {"CompositeTransform_double_3_3", "AffineTransform_double_3_3",
                           "Euler3DTransform_double_3_3"}) {
    composite.put(type);
    composite.put(std::vector<double>(*type == 'C' ? 0 : *type == 'A' ? 12 : 6, 0.3));
    composite.put(std::vector<double>(*type == 'C' ? 0 : 3, 4.0));
  }
  save(corpus / "Transform", "composite", composite.bytes());
  for (const char* compressed : {"0", "1"}) {
    const std::map<std::uint32_t, const char*> values = {
        {0x00080060, "CT"},    {0x0008103e, "head"},        {0x0020000e, "1.2.3"},
        {0x00200011, "7"},     {0x00200032, "1\\2\\3"},     {0x00200037, "1\\0\\0\\0\\1\\0"},
        {0x00280002, "1"},     {0x00280004, "MONOCHROME2"}, {0x00280010, "8"},
        {0x00280011, "8"},     {0x00280030, "0.5\\2"},      {0x00280100, "16"},
        {0x00280101, "12"},    {0x00280102, "11"},          {0x00280103, "1"},
        {0x00281052, "-1024"}, {0x00281053, "0.5"}};
    ReplyWriter slice;
    for (const char* flag : {"1", compressed, "1"})
      slice.put(flag);
    for (const DicomField& field : dicomFields) {
      const auto value = values.find(field.isInSequenceOnly ? 0 : field.tag);
      slice.put(value == values.end() ? "" : value->second);
    }
    slice.put(std::vector<double>{0.0}); // frames
    save(corpus / "Dicom", *compressed == '0' ? "native" : "compressed", slice.bytes());
  }
}

void makeSlices(const fs::path& corpus) {
  const fs::path folder = corpus / "../Sandbox/Dicom";
  fs::create_directories(folder);
  for (const bool compress : {false, true}) {
    const auto io = itk::GDCMImageIO::New();
    io->SetFileName((folder / (compress ? "jpeg2000.dcm" : "native.dcm")).string());
    io->KeepOriginalUIDOn();
    io->SetNumberOfDimensions(3);
    itk::ImageIORegion region(3);
    for (const unsigned axis : {0U, 1U, 2U}) {
      io->SetDimensions(axis, axis < 2 ? 32 : 1);
      region.SetSize(axis, axis < 2 ? 32 : 1);
    }
    io->SetIORegion(region);
    io->SetPixelType(itk::IOPixelEnum::SCALAR);
    io->SetComponentType(itk::IOComponentEnum::SHORT);
    io->SetUseCompression(compress);
    for (const auto& [tag, value] : {std::pair{"0008|0060", "CT"},
                                     {"0020|000e", "1.2.3"},
                                     {"0028|1052", "-1024"},
                                     {"0028|1053", "1"}})
      itk::EncapsulateMetaData<std::string>(io->GetMetaDataDictionary(), tag, value);
    io->Write(std::array<std::int16_t, 32 * 32>{1, 2, 3}.data());
  }
}

/// Writes the scene of Corpus/Scene with its files as stored.mrb. deflated.mrb has the same
/// content, packed by Info-ZIP.
void makeArchive(const fs::path& corpus) {
  std::string scene = readBytes(corpus / "Scene/new.mrml");
  const std::string attribute = "fileName=\"";
  for (std::size_t at = 0; (at = scene.find(attribute, at)) != std::string::npos;)
    scene.insert(at += attribute.size(), "Data/");
  std::vector<ZipEntry> entries = {{"n/n.mrml", scene}};
  const auto fixtures = fuzzing::sceneFixtures();
  for (const auto& [name, content] : fixtures)
    entries.push_back({"n/Data/" + name, content});
  save(corpus / "Archive", "stored.mrb", encodeZip(entries, "", "stored.mrb"));
}

} // namespace
} // namespace fenestra

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: MakeSeeds FOLDER\n");
    return 2;
  }
  try {
    const fenestra::TemporaryFolder traps;
    constexpr double spacing = 12.0; // mm: 3 voxels per axis
    fenestra::testing::writeFormatVariants(traps.path(), spacing);
    fenestra::makeVolumes(argv[1], traps.path());
    fenestra::makeImages(argv[1]);
    fenestra::makeTransforms(argv[1]);
    fenestra::makeSlices(argv[1]);
    fenestra::makeReplies(argv[1]);
    fenestra::makeArchive(argv[1]);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "MakeSeeds: %s\n", error.what());
    return 4;
  }
}
