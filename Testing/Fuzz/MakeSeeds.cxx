// usage: MakeSeeds FOLDER: writes the binary seeds to FOLDER/<target>/ and FOLDER/../Sandbox/.
#include "Regression/SampleFiles.h"
#include "SceneFixtures.h"
#include "TemporaryFolder.h"
#include "Unit/DicomObjectFiles.h"
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
#include <bit>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <exception>
#include <map>

namespace fenestra::core {
namespace {

namespace fs = std::filesystem;

void save(const fs::path& folder, const std::string& name, const std::string& bytes) {
  fs::create_directories(folder);
  std::ofstream(folder / name, std::ios::binary) << bytes;
}

template <typename T>
void put(std::string& bytes, std::size_t at, const T& value) {
  std::memcpy(bytes.data() + at, &value, sizeof value);
}

const std::string niftiVoxels("\1\0\2\0\3\0\4\0\5\0\6\0\7\0\10\0\11\0", 18);

/// Header of a NIfTI-1 volume of 3x3x2 16-bit voxels with a qform and an sform, and `frames`.
/// `magic`: "n+1", "ni1" or "" (Analyze).
std::string makeNiftiHeader(const char* magic, std::int16_t frames = 1) {
  std::string header(*magic == 'n' && magic[1] == '+' ? 352 : 348, '\0');
  put(header, 0, std::int32_t{348});
  const auto axes = static_cast<std::int16_t>(frames > 1 ? 4 : 3);
  put(header, 40, std::array<std::int16_t, 8>{axes, 3, 3, 2, frames, 1, 1, 1});
  put(header, 70, std::int16_t{4});  // int16
  put(header, 72, std::int16_t{16}); // bits
  put(header, 76,
      std::array<float, 8>{1.0f, 1.0f, 1.0f, 2.0f, 1.0f, 1.0f, 1.0f, 1.0f}); // handedness, spacings
  put(header, 108, header.size() == 352 ? 352.0f : 0.0f);                    // offset of the voxels
  put(header, 112, 1.0f);                                                    // slope
  put(header, 252, std::int16_t{1});                                         // qform
  put(header, 254, std::int16_t{1});                                         // sform
  put(header, 280, std::array<float, 12>{1, 0, 0, -1, 0, 1, 0, -1, 0, 0, 2, -1});
  std::memcpy(header.data() + 344, magic, std::strlen(magic));
  return header;
}

std::string makeNifti(std::int16_t frames = 1) {
  std::string bytes = makeNiftiHeader("n+1", frames);
  for (int frame = 0; frame < frames; ++frame)
    bytes += niftiVoxels + std::string(18, '\0');
  return bytes;
}

/// The same volume as NIfTI-2.
std::string makeNifti2() {
  std::string header(544, '\0');
  put(header, 0, std::int32_t{540});
  std::memcpy(header.data() + 4, "n+2\0\r\n\032\n", 8);
  put(header, 12, std::int16_t{4});  // int16
  put(header, 14, std::int16_t{16}); // bits
  put(header, 16, std::array<std::int64_t, 8>{3, 3, 3, 2, 1, 1, 1, 1});
  put(header, 104, std::array<double, 8>{1, 1, 1, 2, 1, 1, 1, 1});
  put(header, 168, std::int64_t{544}); // offset of the voxels
  put(header, 176, 1.0);               // slope
  put(header, 344, std::int32_t{1});   // qform
  put(header, 348, std::int32_t{1});   // sform
  put(header, 400, std::array<double, 12>{1, 0, 0, -1, 0, 1, 0, -1, 0, 0, 2, -1});
  return header + niftiVoxels + std::string(18, '\0');
}

/// FreeSurfer volume of 3x3x2 voxels of 8 bits.
std::string makeMgh() {
  std::string bytes;
  const auto append = [&](std::uint32_t number, int size) {
    for (int i = size - 1; i >= 0; --i)
      bytes += static_cast<char>(number >> 8 * i & 255U);
  };
  for (const std::uint32_t number : {1U, 3U, 3U, 2U, 1U, 0U, 0U}) // version, sizes, frames, type
    append(number, 4);
  append(1, 2); // has geometry
  for (const float number :
       {1.0f, 1.0f, 2.0f, -1.0f, 0.0f, 0.0f, 0.0f, 0.0f, -1.0f, 0.0f, 1.0f, 0.0f, 5.0f, 6.0f, 7.0f})
    append(std::bit_cast<std::uint32_t>(number), 4);
  bytes.resize(284, '\0');
  return bytes + std::string(9, '\1') + std::string(9, '\0');
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
  save(corpus / "Volume", "frames.nii", "2" + makeNifti(3));
  save(corpus / "Volume", "volume2.nii", "2" + makeNifti2());
  save(corpus / "Volume", "pair.hdr", "6" + makeNiftiHeader("ni1"));
  save(corpus / "Volume", "analyze.hdr", "6" + makeNiftiHeader(""));
  save(corpus / "Volume", "volume.mgh", "7" + makeMgh());
  save(corpus / "Volume", "volume.mha", "4" + makeMetaImage());
}

void makeMasks(const fs::path& corpus) {
  for (const auto& [name, bytes] : {std::pair("0nifti", makeNifti()),
                                    {"2metaimage", makeMetaImage()},
                                    {"3freesurfer", makeMgh()}})
    save(corpus / "MaskFolder", name + 1, *name + bytes);
  constexpr const char* nrrd =
      "NRRD0004\ntype: uint8\ndimension: 3\nspace: left-posterior-superior\nsizes: 3 3 2\n"
      "space directions: (1,0,0) (0,1,0) (0,0,2)\nspace origin: (0,0,0)\nencoding: raw\n";
  save(corpus / "MaskFolder", "nrrd", "1" + std::string(nrrd) + "\n" + std::string(18, '\1'));
  constexpr const char* groups = // of MITK
      R"(org_mitk_multilabel_segmentation_labelgroups:=[{"labels": [{"name": "liver", "value": 1,
 "color": {"type": "ColorProperty", "value": [0.5, 0.25, 1]}}, {"name": "cyst", "value": 2}]}])";
  std::string line = groups;
  std::erase(line, '\n');
  save(corpus / "Segmentation", "groups.nrrd", nrrd + line + "\n\n" + std::string(18, '\2'));
}

void makeLabelTables(const fs::path& corpus) {
  for (const auto& [name, text] :
       {std::pair("2dataset.json", R"({"channel_names": {"0": "CT"},
"labels": {"background": 0, "liver": 1, "whole": [1, 2], "tumor": 2}})"),
        {"2decathlon.json", R"({"labels": {"0": "background", "1": "liver"}})"},
        {"5dseg.tsv",
         "index\tname\tabbreviation\tcolor\n1\tliver\tL\t#dd8265\n2\tcyst\tC\t#010203\n"},
        {"6freesurfer.txt", "#No. Label Name: R G B A\n3 Left-Cerebral-Cortex 205 62 78 0\n"
                            "17 Left-Hippocampus 220 216 20 0\n"},
        {"6snap.txt", "# ITK-SnAP Label Description File\n5 221 130 101 1 1 1 \"liver\"\n"}})
    save(corpus / "Labels", name + 1, *name + std::string(text));
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
    fenestra::core::save(corpus / "../Sandbox/Transform", name, readBytes(folder / name));
  };
  save("affine.h5", itk::HDF5TransformIOTemplate<double>::New());
  save("affine.mat", itk::MatlabTransformIOTemplate<double>::New());
}

/// Writes the reply of a sandboxed child about such files.
void makeReplies(const fs::path& corpus) {
  ReplyWriter composite;
  for (const char* type : {"CompositeTransform_double_3_3", "AffineTransform_double_3_3",
                           "Euler3DTransform_double_3_3"}) {
    composite.put(type);
    composite.put(std::vector<double>(*type == 'C' ? 0 : *type == 'A' ? 12 : 6, 0.3));
    composite.put(std::vector<double>(*type == 'C' ? 0 : 3, 4.0));
  }
  save(corpus / "Transform", "composite", composite.bytes());
}

std::map<std::uint32_t, std::string> listSliceValues() {
  return {{0x00080060, "CT"},    {0x0008103e, "head"},        {0x0020000e, "1.2.3"},
          {0x00200011, "7"},     {0x00200032, "1\\2\\3"},     {0x00200037, "1\\0\\0\\0\\1\\0"},
          {0x00280002, "1"},     {0x00280004, "MONOCHROME2"}, {0x00280010, "8"},
          {0x00280011, "8"},     {0x00280030, "0.5\\2"},      {0x00280100, "16"},
          {0x00280101, "12"},    {0x00280102, "11"},          {0x00280103, "1"},
          {0x00281052, "-1024"}, {0x00281053, "0.5"}};
}

void putHeader(ReplyWriter& reply, const char* compressed,
               const std::map<std::uint32_t, std::string>& values) {
  for (const char* flag : {"1", compressed, "1"})
    reply.put(flag);
  for (const DicomField& field : dicomFields) {
    const auto value = values.find(field.isInSequenceOnly ? 0 : field.tag);
    reply.put(value == values.end() ? "" : value->second);
  }
}

/// Files of one frame, and of several with and without functional groups.
void makeImageReplies(const fs::path& corpus) {
  for (const char* compressed : {"0", "1"}) {
    ReplyWriter slice;
    putHeader(slice, compressed, listSliceValues());
    slice.put(std::vector{0.0}); // frames
    save(corpus / "Dicom", *compressed == '0' ? "native" : "compressed", slice.bytes());
  }
  for (const int groups : {0, 5}) {
    auto values = listSliceValues();
    values[0x00280008] = "5";
    values[0x00180050] = "2.5";
    values[0x00080060] = groups == 0 ? "CT" : "PT";
    ReplyWriter frames;
    putHeader(frames, "0", values);
    frames.put(std::vector{static_cast<double>(groups)});
    for (int i = 0; i < groups; ++i)
      for (const DicomField& field : dicomFields)
        if (field.sequence != 0) // two times, of uneven slices
          frames.put(field.tag == 0x00200032   ? concat("1\\2\\", i % 3 * i % 3)
                     : field.tag == 0x00209128 ? concat(i / 3)
                                               : "");
    save(corpus / "Dicom", groups == 0 ? "frames" : "groups", frames.bytes());
  }
}

/// Replies about a SEG and a structure set, with and without a volume.
void makeObjectReplies(const fs::path& corpus) {
  using Numbers = std::vector<double>;
  for (const char* type : {"BINARY", "LABELMAP"}) {
    ReplyWriter seg;
    for (const char* text : {"segmentation", "", "0", type})
      seg.put(text);
    for (const double number : {4.0, 5.0, *type == 'B' ? 1.0 : 8.0, 255.0, 2.0})
      seg.put(Numbers{number}); // rows, columns, bits, maximum; segments
    for (const double segment : {1.0, 2.0}) {
      seg.put(Numbers{segment});
      seg.put("liver");
      seg.put(Numbers{40000.0, 30000.0, 20000.0});
      for (const char* code : {"SCT^123037004", "SCT^10200004", ""})
        seg.put(code);
    }
    seg.put(Numbers{4.0}); // frames
    for (const double frame : {0.0, 1.0, 2.0, 4.0}) {
      seg.put(Numbers{frame > 1.0 ? 2.0 : 1.0});
      seg.put(Numbers{1.0, 2.0, 2.5 * frame});
      for (const Numbers& numbers : {Numbers{1, 0, 0, 0, 1, 0}, {0.5, 0.5}, {2.5}, {2.5}})
        seg.put(numbers); // orientation, pixel spacing, distance, thickness
    }
    save(corpus / "DicomSegments", *type == 'B' ? "binary" : "labelmap", "1" + seg.bytes());
  }
  ReplyWriter structures;
  for (const char* text : {"structure set", "ISO_IR 100"})
    structures.put(text);
  structures.put(Numbers{2.0}); // names
  for (const double number : {3.0, 4.0}) {
    structures.put(Numbers{number});
    structures.put("GTV");
  }
  structures.put(Numbers{2.0});
  for (const double number : {3.0, 4.0}) {
    structures.put(Numbers{number});
    structures.put(Numbers{255.0, 0.0, 0.0});
    structures.put(Numbers{3.0}); // contours
    for (const double z : {0.0, 2.0, 4.0})
      structures.put(Numbers{-6, -6, z, 6 - z, -6, z, 5 - number, 6, z});
  }
  save(corpus / "Structures", "volume", "1" + structures.bytes());
  save(corpus / "Structures", "alone", "0" + structures.bytes());
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

/// A SEG and a structure set.
void makeSegmentFiles(const fs::path& corpus) {
  const fs::path folder = corpus / "../Sandbox/Segments";
  SegFile seg{.columns = 12, .rows = 10, .statedStep = 1.0};
  seg.segments = {{1, "one", {1, 2, 3}, "123037004", "10200004"}, {2, "two"}};
  seg.frames = {{1, 0.0}, {2, 1.0}, {1, 2.0}};
  save(folder, "seg.dcm", makeSegFile(seg));
  save(folder, "implicit.dcm", makeSegFile(seg, dicom::Syntax::implicitLittle, false));
  seg.type = "LABELMAP";
  seg.bits = 8;
  save(folder, "rle.dcm", makeSegFile(seg, dicom::Syntax::rle));
  RoiFile roi;
  for (const double z : {0.0, 1.0, 2.0, 4.0})
    roi.contours.push_back({Vec3(-5, -5, z), Vec3(5, -5, z), Vec3(5 - z, 5, z), Vec3(-5, 5, z)});
  save(folder, "structures.dcm", makeStructureFile({roi, {.number = 2, .contours = roi.contours}}));
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
} // namespace fenestra::core

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: MakeSeeds FOLDER\n");
    return 2;
  }
  try {
    const fenestra::core::TemporaryFolder traps;
    constexpr double spacing = 12.0; // mm: 3 voxels per axis
    fenestra::core::testing::writeFormatVariants(traps.path(), spacing);
    fenestra::core::makeVolumes(argv[1], traps.path());
    fenestra::core::makeImages(argv[1]);
    fenestra::core::makeTransforms(argv[1]);
    fenestra::core::makeSlices(argv[1]);
    fenestra::core::makeSegmentFiles(argv[1]);
    fenestra::core::makeReplies(argv[1]);
    fenestra::core::makeImageReplies(argv[1]);
    fenestra::core::makeObjectReplies(argv[1]);
    fenestra::core::makeMasks(argv[1]);
    fenestra::core::makeLabelTables(argv[1]);
    fenestra::core::makeArchive(argv[1]);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "MakeSeeds: %s\n", error.what());
    return 4;
  }
}
