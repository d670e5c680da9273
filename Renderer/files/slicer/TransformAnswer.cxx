#include "files/slicer/TransformAnswer.h"

#include "base/safe/Apart.h"
#include "base/safe/Inputs.h"

#include <hdf5.h>
#include <itkHDF5TransformIO.h>
#include <itkMatlabTransformIO.h>
#include <itkTxtTransformIO.h>
#include <itkVersion.h>

namespace fenestra {
namespace {

constexpr std::size_t mostRecords = 256;
constexpr std::size_t mostNumbers = 64; // more than any linear transform has
constexpr std::uint64_t longestAnswer = mostRecords * 2048;

// ---- in the child: whether a file is whole

constexpr herr_t goOn = 0, leaveOff = -1;

herr_t visitLink(hid_t, const char*, const H5L_info_t* link, void*) {
  return link->type == H5L_TYPE_HARD || link->type == H5L_TYPE_SOFT ? goOn : leaveOff;
}

herr_t visitObject(hid_t file, const char* name, const H5O_info_t* object, void*) {
  if (object->type != H5O_TYPE_DATASET)
    return goOn;
  const hid_t data = H5Dopen2(file, name, H5P_DEFAULT);
  const hid_t properties = H5Dget_create_plist(data);
  const bool isInside =
      H5Pget_external_count(properties) == 0 && H5Pget_layout(properties) != H5D_VIRTUAL;
  H5Pclose(properties);
  H5Dclose(data);
  return isInside ? goOn : leaveOff;
}

/// True if an HDF5 file is self-contained: no link, raw storage or virtual data set lies in another
/// file, which the library would open unchecked. False where the file cannot be read.
bool holdsAllItsParts(const std::string& path) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  // Each group and object is visited once, however often it is named.
  const bool isWhole = file >= 0 &&
                       H5Lvisit(file, H5_INDEX_NAME, H5_ITER_NATIVE, visitLink, nullptr) >= 0 &&
                       H5Ovisit(file, H5_INDEX_NAME, H5_ITER_NATIVE, visitObject, nullptr) >= 0;
  H5Fclose(file);
  return isWhole;
}

// ---- in the child: what the file says

/// Transform of any type, known or not, that keeps its file's numbers.
class RecordedTransform : public itk::TransformBaseTemplate<double> {
public:
  using Pointer = itk::SmartPointer<RecordedTransform>;
  using Category = itk::TransformBaseTemplateEnums::TransformCategory;

  static Pointer of(const std::string& type) {
    const Pointer made = new RecordedTransform(type);
    made->UnRegister();
    return made;
  }

  std::string GetTransformTypeAsString() const override { return m_type; }
  const ParametersType& GetParameters() const override { return m_parameters; }
  const FixedParametersType& GetFixedParameters() const override { return m_fixed; }
  NumberOfParametersType GetNumberOfParameters() const override { return m_parameters.Size(); }
  void SetParameters(const ParametersType& values) override { m_parameters = values; }
  void SetParametersByValue(const ParametersType& values) override { m_parameters = values; }
  void SetFixedParameters(const FixedParametersType& values) override { m_fixed = values; }
  void CopyInParameters(const double*, const double*) override {}
  void CopyInFixedParameters(const double*, const double*) override {}
  unsigned GetInputSpaceDimension() const override { return 3; }
  unsigned GetOutputSpaceDimension() const override { return 3; }
  Category GetTransformCategory() const override { return Category::UnknownTransformCategory; }

private:
  explicit RecordedTransform(std::string type) : m_type(std::move(type)) {}

  std::string m_type;
  ParametersType m_parameters;
  FixedParametersType m_fixed;
};

/// Makes a RecordedTransform for every type that ITK's readers request, before ITK's own factories.
class RecordingFactory : public itk::ObjectFactoryBase {
public:
  static void registerFirst() {
    const itk::SmartPointer<RecordingFactory> factory = new RecordingFactory;
    factory->UnRegister();
    RegisterFactory(factory, InsertionPositionEnum::INSERT_AT_FRONT);
  }
  const char* GetITKSourceVersion() const override { return ITK_SOURCE_VERSION; }
  const char* GetDescription() const override { return "transforms as they are in files"; }

protected:
  itk::LightObject::Pointer CreateObject(const char* type) override {
    return RecordedTransform::of(type).GetPointer();
  }
};

itk::TransformIOBaseTemplate<double>::Pointer readerOf(const std::string& extension) {
  if (extension == ".mat")
    return itk::MatlabTransformIOTemplate<double>::New().GetPointer();
  if (extension == ".h5" || extension == ".hdf5")
    return itk::HDF5TransformIOTemplate<double>::New().GetPointer();
  return itk::TxtTransformIOTemplate<double>::New().GetPointer();
}

/// First mostNumbers + 1 numbers: one too many shows that there are more.
template <typename Parameters>
std::vector<double> firstOf(const Parameters& parameters) {
  const auto count = std::min<std::size_t>(parameters.Size(), mostNumbers + 1);
  return {parameters.data_block(), parameters.data_block() + count};
}

std::string answerTransform(const std::string& question) {
  const std::string extension = lowerExtension(question);
  if ((extension == ".h5" || extension == ".hdf5") && !holdsAllItsParts(question))
    return {};
  const auto reader = readerOf(extension);
  RecordingFactory::registerFirst();
  reader->SetFileName(question);
  reader->Read();
  AnswerWriter answer;
  for (const auto& transform : reader->GetTransformList()) {
    answer.put(transform->GetTransformTypeAsString());
    answer.put(firstOf(transform->GetParameters()));
    answer.put(firstOf(transform->GetFixedParameters()));
  }
  return answer.bytes();
}

// HDF5's tree of symbols may fan out without end; reading a transform takes a few milliseconds.
const ApartJob transformJob("transform", answerTransform, {.seconds = 3});

} // namespace

std::string transformAnswer(const std::filesystem::path& path) {
  // Starting a child takes longer than reading a transform: each thread keeps its child.
  thread_local Apart child(transformJob);
  return child.ask(path.string(), longestAnswer).value_or("");
}

} // namespace fenestra
