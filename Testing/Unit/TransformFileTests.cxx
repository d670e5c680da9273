// All linear transforms that ITK writes, compared with ITK's own mapping; invalid files.

#include "files/slicer/TransformFile.h"

#include "Approx.h"
#include "MedicalFiles.h"
#include "files/slicer/SceneFiles.h"

#include <itkAffineTransform.h>
#include <itkBSplineTransform.h>
#include <itkCenteredEuler3DTransform.h>
#include <itkComposeScaleSkewVersor3DTransform.h>
#include <itkCompositeTransform.h>
#include <itkEuler2DTransform.h>
#include <itkHDF5TransformIO.h>
#include <itkIdentityTransform.h>
#include <itkMatlabTransformIO.h>
#include <itkQuaternionRigidTransform.h>
#include <itkScaleLogarithmicTransform.h>
#include <itkScaleSkewVersor3DTransform.h>
#include <itkScaleVersor3DTransform.h>
#include <itkSimilarity3DTransform.h>
#include <itkTransformFileWriter.h>
#include <itkTranslationTransform.h>
#include <itkTxtTransformIO.h>
#include <itkVersorRigid3DTransform.h>
#include <itk_hdf5.h>

#include <cstring>
#include <random>

namespace fenestra::core::TransformFileTests {
namespace {

using Extensions = std::vector<std::string>;
const Extensions allExtensions = {".tfm", ".txt", ".h5", "z.h5", ".hdf5", ".mat"}; // z: compressed

template <typename Real>
typename itk::TransformIOBaseTemplate<Real>::Pointer makeTransformIo(const std::string& extension) {
  if (extension == ".mat")
    return itk::MatlabTransformIOTemplate<Real>::New().GetPointer();
  if (extension == ".h5" || extension == ".hdf5")
    return itk::HDF5TransformIOTemplate<Real>::New().GetPointer();
  return itk::TxtTransformIOTemplate<Real>::New().GetPointer();
}

template <typename Real>
std::filesystem::path write(const TemporaryFolder& folder, const std::string& extension,
                            const itk::TransformBaseTemplate<Real>* transform,
                            bool compress = false) {
  const auto writer = itk::TransformFileWriterTemplate<Real>::New();
  const auto path = folder / ("t" + extension);
  writer->SetFileName(path.string());
  writer->SetTransformIO(makeTransformIo<Real>(extension));
  writer->SetInput(transform);
  writer->SetUseCompression(compress);
  writer->Update();
  return path;
}

/// Writes `transform` to files and reads them. Expects the read transform to map points in RAS as
/// the inverse of the ITK object maps them in LPS.
template <typename Real>
void expectSameMap(const itk::Transform<Real, 3, 3>* transform,
                   const Extensions& extensions = allExtensions) {
  constexpr double error = sizeof(Real) == 4 ? 1e-3 : 1e-9;
  const TemporaryFolder folder;
  for (std::string extension : extensions) {
    const bool compress = extension.starts_with("z");
    const auto path = write(folder, extension.substr(compress ? 1 : 0), transform, compress);
    const Affine toParent = readLinearTransform(path).inverse();
    const Affine fromParent = readLinearTransform(path);
    for (const Vec3& ras : {Vec3(0, 0, 0), Vec3(100, -20, 7), Vec3(-3, 50, -80)}) {
      itk::Point<Real, 3> lps;
      for (unsigned i = 0; i < 3; ++i)
        lps[i] = static_cast<Real>(i < 2 ? -ras[i] : ras[i]);
      const auto mapped = transform->TransformPoint(lps);
      const Vec3 expected(-mapped[0], -mapped[1], mapped[2]);
      EXPECT_LT((toParent * expected - ras).norm(), error)
          << transform->GetNameOfClass() << extension;
      EXPECT_LT((fromParent * ras - expected).norm(), error)
          << transform->GetNameOfClass() << extension;
    }
  }
}

/// Rotation about a center and translation, without symmetries that could hide errors.
template <typename Transform>
typename Transform::Pointer makeRotated() {
  auto transform = Transform::New();
  typename Transform::InputPointType center;
  center[0] = 11;
  center[1] = -23;
  center[2] = 5;
  transform->SetCenter(center);
  typename Transform::OutputVectorType axis, shift;
  axis[0] = 1;
  axis[1] = 2;
  axis[2] = -1;
  shift[0] = 4;
  shift[1] = 8;
  shift[2] = -16;
  if constexpr (requires { transform->SetRotation(axis, 0.7); })
    transform->SetRotation(axis, static_cast<typename Transform::ScalarType>(0.7));
  else if constexpr (requires { transform->SetRotation(0.1, 0.2, 0.3); })
    transform->SetRotation(typename Transform::ScalarType(0.1), typename Transform::ScalarType(0.2),
                           typename Transform::ScalarType(0.3));
  else if constexpr (requires { transform->Rotate3D(axis, 0.7); })
    transform->Rotate3D(axis, static_cast<typename Transform::ScalarType>(0.7));
  if (transform->GetNumberOfParameters() >= 6) // with fewer, the translation is not stored
    transform->SetTranslation(shift);
  return transform;
}

TEST(TransformFile, ReadsEveryLinearTransformType) {
  const InProcessReading inProcess; // many files, quickly
  expectSameMap(makeRotated<itk::AffineTransform<double, 3>>().GetPointer());
  expectSameMap(makeRotated<itk::Euler3DTransform<double>>().GetPointer());
  expectSameMap(makeRotated<itk::CenteredEuler3DTransform<double>>().GetPointer());
  expectSameMap(makeRotated<itk::VersorRigid3DTransform<double>>().GetPointer());
  expectSameMap(makeRotated<itk::VersorTransform<double>>().GetPointer());
  auto similarity = makeRotated<itk::Similarity3DTransform<double>>();
  similarity->SetScale(1.7);
  expectSameMap(similarity.GetPointer());
  expectSameMap(itk::IdentityTransform<double, 3>::New().GetPointer(), {".tfm", ".h5", ".mat"});
  auto translation = itk::TranslationTransform<double, 3>::New();
  const double shift[] = {3, -4, 5};
  translation->SetOffset(shift);
  expectSameMap(translation.GetPointer());
  auto quaternion = itk::QuaternionRigidTransform<double>::New();
  auto parameters = quaternion->GetParameters();
  const double values[] = {0.1, 0.2, -0.3, std::sqrt(0.86), 7, 8, 9};
  std::copy(std::begin(values), std::end(values), parameters.begin());
  quaternion->SetParameters(parameters);
  expectSameMap(quaternion.GetPointer());
}

template <typename Transform>
typename Transform::Pointer makeStretched() {
  auto transform = makeRotated<Transform>();
  const double stretch[] = {1.5, 0.5, 2.0};
  transform->SetScale(stretch);
  transform->SetCenter(transform->GetCenter()); // some ITK classes otherwise keep an old offset
  return transform;
}

TEST(TransformFile, ReadsScalesAndSkews) {
  const InProcessReading inProcess; // many files, quickly
  expectSameMap(makeStretched<itk::ScaleVersor3DTransform<double>>().GetPointer());
  expectSameMap(makeStretched<itk::ScaleSkewVersor3DTransform<double>>().GetPointer());
  expectSameMap(makeStretched<itk::ComposeScaleSkewVersor3DTransform<double>>().GetPointer());
  expectSameMap(makeStretched<itk::ScaleTransform<double, 3>>().GetPointer());
  expectSameMap(makeStretched<itk::ScaleLogarithmicTransform<double, 3>>().GetPointer());
}

TEST(TransformFile, ReadsFloatsAndTheOrderOfEulerAngles) {
  const InProcessReading inProcess; // many files, quickly
  expectSameMap(makeRotated<itk::AffineTransform<float, 3>>().GetPointer());
  expectSameMap(makeRotated<itk::Similarity3DTransform<float>>().GetPointer());
  auto euler = makeRotated<itk::Euler3DTransform<double>>();
  euler->SetComputeZYX(true);
  expectSameMap(euler.GetPointer());
}

TEST(TransformFile, AppliesTheLastTransformOfACompositeFirst) {
  const auto composite = itk::CompositeTransform<double, 3>::New();
  auto first = itk::TranslationTransform<double, 3>::New();
  const double shift[] = {10, 0, 0};
  first->SetOffset(shift);
  composite->AddTransform(first);
  composite->AddTransform(makeRotated<itk::Euler3DTransform<double>>());
  auto third = makeRotated<itk::Similarity3DTransform<double>>();
  third->SetScale(3);
  composite->AddTransform(third);
  expectSameMap(composite.GetPointer(), {".tfm", ".txt", ".h5", "z.h5"});
}

TEST(TransformFile, ReadsMatFilesOfTheOtherByteOrder) {
  const TemporaryFolder folder;
  const auto affine = makeRotated<itk::AffineTransform<double, 3>>();
  const Affine expected = readLinearTransform(write(folder, ".mat", affine.GetPointer())).inverse();
  std::string bytes = readBytes(folder / "t.mat");
  const auto reverse = [&](std::size_t at, std::size_t size) {
    std::reverse(bytes.begin() + std::ptrdiff_t(at), bytes.begin() + std::ptrdiff_t(at + size));
  };
  const std::string name = "AffineTransform_double_3_3";
  std::size_t at = 0;
  for (const auto& [length, rows] : {std::pair(name.size(), 12), std::pair(std::size_t(5), 3)}) {
    std::int32_t kind = 1000;
    std::memcpy(bytes.data() + at, &kind, sizeof kind);
    for (int i = 0; i < 5; ++i, at += 4)
      reverse(at, 4);
    at += length + 1;
    for (int i = 0; i < rows; ++i, at += 8)
      reverse(at, 8);
  }
  ASSERT_EQ(at, bytes.size());
  const auto path = folder.write("big.mat", bytes);
  EXPECT_TRUE(isApprox(readLinearTransform(path).inverse(), expected, 1e-15));
}

/// File as the HDF5 library and older ITK write it, with groups as symbol tables.
std::filesystem::path writeOldHdf5(const TemporaryFolder& folder, int count) {
  const auto path = folder / "old.h5";
  const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  H5Gclose(H5Gcreate2(file, "TransformGroup", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  const auto writeDataset = [file](const std::string& name, hid_t type, hsize_t size,
                                   const void* values) {
    const hid_t space = H5Screate_simple(1, &size, nullptr);
    const hid_t set =
        H5Dcreate2(file, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    H5Dwrite(set, type == H5T_IEEE_F64BE ? H5T_NATIVE_DOUBLE : type, H5S_ALL, H5S_ALL, H5P_DEFAULT,
             values);
    H5Dclose(set);
    H5Sclose(space);
  };
  const hid_t text = H5Tcopy(H5T_C_S1);
  H5Tset_size(text, H5T_VARIABLE);
  for (int i = 0; i < count; ++i) {
    const std::string group = "/TransformGroup/" + std::to_string(i);
    H5Gclose(H5Gcreate2(file, group.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
    const char* type = i == 0 ? "CompositeTransform_double_3_3" : "TranslationTransform_double_3_3";
    writeDataset(group + "/TransformType", text, 1, &type);
    const double parameters[] = {1, 2.0 * i, 3};
    writeDataset(group + "/TranformParameters", H5T_IEEE_F64BE, 3, parameters);
    writeDataset(group + "/TranformFixedParameters", H5T_IEEE_F64BE, 0, parameters);
  }
  H5Tclose(text);
  H5Fclose(file);
  return path;
}

TEST(TransformFile, ReadsOldHdf5) {
  const TemporaryFolder folder;
  for (const int count : {2, 5, 100}) { // symbol tables with one leaf and with many
    const Affine toParent = readLinearTransform(writeOldHdf5(folder, count)).inverse();
    EXPECT_TRUE(
        isApprox(toParent.translation(), Vec3(count - 1, count * (count - 1), -3 * (count - 1))));
  }
}

const std::string affineText = "#Insight Transform File V1.0\n"
                               "# Transform 0\n"
                               "Transform: AffineTransform_double_3_3\n"
                               "Parameters: 1 0 0 0 1 0 0 0 1 10 20 30\n"
                               "FixedParameters: 0 0 0\n";

void expectRefused(const std::filesystem::path& path, const std::string& expected) {
  fenestra::core::expectRefused(path, expected, [&] { readLinearTransform(path).inverse(); });
}

std::string replaceText(std::string text, const std::string& what, const std::string& replacement) {
  return text.replace(text.find(what), what.size(), replacement);
}

TEST(TransformFile, MapsFromTheParentInLps) {
  const TemporaryFolder folder;
  const auto path = folder.write("a.tfm", affineText);
  const Affine toParent = readLinearTransform(path).inverse();
  EXPECT_TRUE(isApprox(toParent.translation(), Vec3(10, 20, -30)));
  EXPECT_TRUE(isApprox(readLinearTransform(path).translation(), Vec3(-10, -20, 30)));
}

TEST(TransformFile, RefusesNonlinearTransforms) {
  const TemporaryFolder folder;
  const auto bspline = itk::BSplineTransform<double, 3, 3>::New();
  for (const char* extension : {".tfm", ".txt", ".h5", ".hdf5", ".mat"})
    expectRefused(write(folder, extension, bspline.GetPointer()), "invalid-field: Transform");
  const auto composite = itk::CompositeTransform<double, 3>::New();
  composite->AddTransform(makeRotated<itk::Euler3DTransform<double>>());
  composite->AddTransform(bspline);
  expectRefused(write(folder, ".h5", composite.GetPointer()), "invalid-field: Transform");
  for (const char* type :
       {"DisplacementFieldTransform_double_3_3", "ThinPlateSplineKernelTransform_double_3_3",
        "InverseDisplacementFieldTransform_double_3_3", "NoSuchTransform_double_3_3"})
    expectRefused(
        folder.write("n.tfm", replaceText(affineText, "AffineTransform_double_3_3", type)),
        std::string("invalid-field: Transform | ") + type);
  expectRefused(folder.write("field.nrrd", "NRRD0004"), "unsupported-file");
}

TEST(TransformFile, RefusesSingularMatrices) {
  const TemporaryFolder folder;
  for (const char* matrix : {"0 0 0 0 1 0 0 0 1", "1 0 0 1 0 0 0 0 1", "1e-300 0 0 0 1 0 0 0 1",
                             "1e300 0 0 0 1e300 0 0 0 1e300"})
    expectRefused(folder.write("s.tfm", replaceText(affineText, "1 0 0 0 1 0 0 0 1", matrix)),
                  "invalid-field: Parameters");
  for (const char* offset : {"nan 20 30", "1e999 20 30", "inf 0 0", "10 20", "10 20 30 40", "x"})
    expectRefused(folder.write("n.tfm", replaceText(affineText, "10 20 30", offset)),
                  "damaged-file");
  expectRefused(folder.write("f.tfm", replaceText(affineText, "10 20 30", "1e200 0 0")),
                "invalid-field: Parameters");
}

TEST(TransformFile, RefusesMultiplePlanarAndNestedTransforms) {
  const TemporaryFolder folder;
  expectRefused(folder.write("two.tfm", affineText + affineText), "invalid-file | 2");
  expectRefused(write(folder, ".tfm", itk::Euler2DTransform<double>::New().GetPointer()),
                "invalid-field: Transform");
  expectRefused(folder.write("2d.tfm", replaceText(affineText, "AffineTransform_double_3_3",
                                                   "AffineTransform_double_2_2")),
                "invalid-field: Transform");
  expectRefused(folder.write("c.tfm", "Transform: CompositeTransform_double_3_3\n"
                                      "ComponentTransformFile: ../../other.tfm\n"),
                "invalid-field: ComponentTransformFile");
  expectRefused(folder.write("nested.tfm", "Transform: CompositeTransform_double_3_3\n"
                                           "Transform: CompositeTransform_double_3_3\n"),
                "damaged-file");
}

TEST(TransformFile, RefusesFilesThatAreNotTransforms) {
  const TemporaryFolder folder;
  expectRefused(folder / "none.tfm", "missing-file");
  expectRefused(folder.path(), "not-a-file");
  expectRefused(folder.write("t.xyz", affineText), "unsupported-file");
  for (const std::string extension : {".tfm", ".txt", ".h5", ".hdf5", ".mat"}) {
    expectRefused(folder.write("empty" + extension, ""), "damaged-file");
    expectRefused(folder.write("text" + extension, "what is this"), "damaged-file");
  }
  expectRefused(folder.write("p.tfm", "Parameters: 1 2 3\n"), "damaged-file");
  expectRefused(folder.write("rigid.tfm", replaceText(replaceText(affineText, "Affine", "Rigid3D"),
                                                      "1 0 0", "2 0 0")),
                "damaged-file");
  const auto large = folder.write("large.tfm", affineText);
  std::filesystem::resize_file(large, (64 << 20) + 1);
  expectRefused(large, "limit-exceeded | 1 MB"); // the limit for text
  const auto binary = folder.write("large.h5", affineText);
  std::filesystem::resize_file(binary, (64 << 20) + 1);
  expectRefused(binary, "limit-exceeded | 64 MB");
}

/// External storage and external links make the HDF5 library open other files.
TEST(TransformFile, RefusesHdf5ThatRefersToOtherFiles) {
  const TemporaryFolder folder;
  const auto other = folder.write("other.raw", std::string(80, '\0'));
  using AddReference = std::function<void(hid_t file)>;
  const AddReference values = [&](hid_t file) { // data set with values in another file
    const hsize_t size = 10;
    const hid_t space = H5Screate_simple(1, &size, nullptr),
                creation = H5Pcreate(H5P_DATASET_CREATE);
    ASSERT_GE(H5Pset_external(creation, other.c_str(), 0, 80), 0);
    const hid_t data =
        H5Dcreate2(file, "more", H5T_IEEE_F64LE, space, H5P_DEFAULT, creation, H5P_DEFAULT);
    ASSERT_GE(data, 0);
    H5Dclose(data);
    H5Pclose(creation);
    H5Sclose(space);
  };
  const AddReference link = [&](hid_t file) {
    ASSERT_GE(H5Lcreate_external("other.h5", "/", file, "more", H5P_DEFAULT, H5P_DEFAULT), 0);
  };
  const auto affine = makeRotated<itk::AffineTransform<double, 3>>();
  EXPECT_NO_THROW(readLinearTransform(write(folder, ".h5", affine.GetPointer())).inverse());
  for (const AddReference& addReference : {values, link}) {
    const auto path = write(folder, ".h5", affine.GetPointer());
    const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    addReference(file);
    H5Fclose(file);
    expectRefused(path, "damaged-file");
  }
}

/// Corrupted files must be read, or refused with a one-line error.
TEST(TransformFile, CorruptedFilesAreReadOrRefused) {
  const TemporaryFolder folder;
  const auto composite = itk::CompositeTransform<double, 3>::New();
  composite->AddTransform(makeRotated<itk::Euler3DTransform<double>>());
  composite->AddTransform(makeRotated<itk::AffineTransform<double, 3>>());
  std::mt19937 random(7);
  ::testing::internal::CaptureStderr();
  for (const std::string extension : {".tfm", ".h5", ".mat"}) {
    const std::string original = readBytes(
        extension == ".mat"
            ? write(folder, extension, makeRotated<itk::AffineTransform<double, 3>>().GetPointer())
            : write(folder, extension, composite.GetPointer()));
    for (int i = 0; i < 20; ++i) {
      std::string bytes = original;
      if (i % 4 == 0)
        bytes.resize(random() % original.size());
      for (int n = 0; n < i % 4; ++n)
        bytes[random() % bytes.size()] = static_cast<char>(random());
      const auto path = folder.write(std::to_string(i) + extension, bytes);
      try {
        EXPECT_TRUE(allFinite(readLinearTransform(path).inverse()));
      } catch (const Error& error) {
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
      }
    }
  }
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

/// File written by Slicer 5.2.2; the expected matrix is from the same scene.
TEST(TransformFile, ReadsAFileWrittenBySlicer) {
  const auto scene = std::filesystem::path(FENESTRA_DATA) / "slicer_scenes" / "slicer_5_2_written" /
                     "chest_transformed_cropped.mrb";
  if (!std::filesystem::exists(scene))
    GTEST_SKIP() << "no test data at " << FENESTRA_DATA;
  SceneFiles files(scene);
  const std::filesystem::path path = files.locate("Data/tilt.h5");
  const Affine expected(Mat3::FromRows({0.939693, -0.34202, 0}, {0.34202, 0.939693, 0}, {0, 0, 1}),
                        {20, -10, 15});
  const Affine toParent = readLinearTransform(path).inverse();
  EXPECT_LT(frobeniusNorm(toParent.linear() - expected.linear()), 1e-6);
  EXPECT_LT((toParent.translation() - expected.translation()).norm(), 1e-6);
}

} // namespace
} // namespace fenestra::core::TransformFileTests
