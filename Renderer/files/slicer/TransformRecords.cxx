#include "files/slicer/TransformRecords.h"

#include "base/Error.h"
#include "base/safe/Apart.h"
#include "base/safe/ApartBytes.h"
#include "base/safe/Inputs.h"
#include "base/safe/ShownText.h"
#include "files/slicer/Hdf5Parts.h"
#include "files/slicer/TransformMatrix.h"

#include <itkHDF5TransformIO.h>
#include <itkMatlabTransformIO.h>
#include <itkTxtTransformIO.h>
#include <itkVersion.h>

namespace fenestra {
namespace {

using Path = std::filesystem::path;

constexpr std::size_t mostRecords = 256;
constexpr std::size_t mostNumbers = 64; // more than any linear transform has
constexpr std::uint64_t longestAnswer = mostRecords * 2048;

// ---- in the child

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

// ---- here

/// "Type" of "Type_scalar_axes_axes". Throws Error (input) unless linear and of three axes.
std::string linearType(const Path& path, const std::string& name) {
  std::string type = name.substr(0, name.find('_'));
  if (!isLinearTransform(type))
    throw inputError(
        path, "Transform: ", shown(name),
        " is not linear; harden it in Slicer (Data module, Harden transform) and save again");
  if (name != type + "_double_3_3") // ITK's readers turn _float_ into _double_
    throw inputError(path, "Transform: ", shown(name),
                     " is not a transform of three axes; save one that is");
  return type;
}

} // namespace

void throwDamagedTransform(const Path& path) {
  throw inputError(path, "is damaged, truncated or no transform of ITK's; save it again");
}

std::vector<TransformRecord> transformRecords(const Path& path, std::string_view answer) {
  std::vector<TransformRecord> records;
  AnswerReader reader(answer);
  while (!reader.atEnd()) {
    TransformRecord record;
    record.type = linearType(path, reader.text());
    record.parameters = reader.numbers();
    record.fixed = reader.numbers();
    records.push_back(record);
  }
  return records;
}

std::string transformAnswer(const Path& path) {
  // Starting a child takes longer than reading a transform: each thread keeps its child.
  thread_local Apart child(transformJob);
  const auto answer = child.ask(path.string(), longestAnswer);
  if (!answer || answer->empty())
    throwDamagedTransform(path);
  return *answer;
}

} // namespace fenestra
