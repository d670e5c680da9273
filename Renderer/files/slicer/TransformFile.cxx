#include "files/slicer/TransformFile.h"

#include "base/CheckAffine.h"
#include "files/medical/SuppressItkOutput.h"
#include "io/InputRegistry.h"
#include "io/JsonNode.h"
#include "io/MessageText.h"
#include "io/Sandbox.h"

#include <hdf5.h>
#include <itkHDF5TransformIO.h>
#include <itkMatlabTransformIO.h>
#include <itkMatrixOffsetTransformBase.h>
#include <itkRigid3DTransform.h>
#include <itkTransformFactory.h>
#include <itkTxtTransformIO.h>
#include <itkVersion.h>

#include <new>
#include <set>

namespace fenestra::core {
namespace {

using Path = std::filesystem::path;

// A sandboxed child process reads the files, since ITK and HDF5 allocate any size that a file
// declares, and abort or corrupt memory on damaged files.

constexpr std::size_t maxRecords = 256;
constexpr std::size_t maxNumbers = 64; // more than any linear transform has
constexpr std::uint64_t maxReplyBytes = maxRecords * 2048;

// ---- in the child process: is the file self-contained?

constexpr herr_t proceed = 0, stop = -1;

herr_t visitLink(hid_t, const char*, const H5L_info_t* link, void*) {
  return link->type == H5L_TYPE_HARD || link->type == H5L_TYPE_SOFT ? proceed : stop;
}

herr_t visitObject(hid_t file, const char* name, const H5O_info_t* object, void*) {
  if (object->type != H5O_TYPE_DATASET)
    return proceed;
  const hid_t data = H5Dopen2(file, name, H5P_DEFAULT);
  const hid_t properties = H5Dget_create_plist(data);
  const bool isInFile =
      H5Pget_external_count(properties) == 0 && H5Pget_layout(properties) != H5D_VIRTUAL;
  H5Pclose(properties);
  H5Dclose(data);
  return isInFile ? proceed : stop;
}

/// True if an HDF5 file has no link, storage or virtual data set in another file, which the library
/// would open unchecked. False if the file cannot be read.
bool isSelfContained(const std::string& path) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  // HDF5 visits each group and object once, however many names it has.
  const bool isComplete = file >= 0 &&
                          H5Lvisit(file, H5_INDEX_NAME, H5_ITER_NATIVE, visitLink, nullptr) >= 0 &&
                          H5Ovisit(file, H5_INDEX_NAME, H5_ITER_NATIVE, visitObject, nullptr) >= 0;
  H5Fclose(file);
  return isComplete;
}

// ---- in the child process: read the file's numbers

/// Keeps HDF5 from printing errors, in this thread during its lifetime.
class SuppressHdf5Output {
public:
  SuppressHdf5Output() {
    H5Eget_auto2(H5E_DEFAULT, &m_print, &m_data);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  ~SuppressHdf5Output() { H5Eset_auto2(H5E_DEFAULT, m_print, m_data); }
  SuppressHdf5Output(const SuppressHdf5Output&) = delete;
  SuppressHdf5Output& operator=(const SuppressHdf5Output&) = delete;

private:
  H5E_auto2_t m_print = nullptr;
  void* m_data = nullptr;
};

/// Transform of any type, known or not, that only stores the file's numbers.
class RecordedTransform : public itk::TransformBaseTemplate<double> {
public:
  using Category = itk::TransformBaseTemplateEnums::TransformCategory;

  explicit RecordedTransform(std::string type) : m_type(std::move(type)) {}

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
  std::string m_type;
  ParametersType m_parameters;
  FixedParametersType m_fixed;
};

/// Takes ownership of a new object, whose reference count starts at one.
template <typename Object>
itk::SmartPointer<Object> takeOwnership(Object* made) {
  const itk::SmartPointer<Object> pointer = made;
  made->UnRegister();
  return pointer;
}

/// Makes a RecordedTransform for every type that ITK's readers request.
class RecordingFactory : public itk::ObjectFactoryBase {
public:
  const char* GetITKSourceVersion() const override { return ITK_SOURCE_VERSION; }
  const char* GetDescription() const override { return "transforms as they are in files"; }

protected:
  itk::LightObject::Pointer CreateObject(const char* type) override {
    return takeOwnership(new RecordedTransform(type)).GetPointer();
  }
};

/// Makes ITK's transforms known to its factories by name.
void registerTransforms() {
  [[maybe_unused]] static const bool known = [] {
    itk::TransformFactoryBase::RegisterDefaultTransforms();
    itk::TransformFactory<itk::Rigid3DTransform<double>>::RegisterTransform();
    return true;
  }();
}

/// During its lifetime, ITK's readers make RecordedTransforms.
class RecordTransforms {
public:
  RecordTransforms() {
    registerTransforms();                        // else ITK would, as RecordedTransforms
    RecordingFactory::RegisterFactory(m_factory, // ahead of ITK's factories
                                      RecordingFactory::InsertionPositionEnum::INSERT_AT_FRONT);
  }
  ~RecordTransforms() { RecordingFactory::UnRegisterFactory(m_factory); }
  RecordTransforms(const RecordTransforms&) = delete;
  RecordTransforms& operator=(const RecordTransforms&) = delete;

private:
  const RecordingFactory::Pointer m_factory = takeOwnership(new RecordingFactory);
};

itk::TransformIOBaseTemplate<double>::Pointer makeTransformReader(const std::string& extension) {
  if (extension == ".mat")
    return itk::MatlabTransformIOTemplate<double>::New().GetPointer();
  if (extension == ".h5" || extension == ".hdf5")
    return itk::HDF5TransformIOTemplate<double>::New().GetPointer();
  return itk::TxtTransformIOTemplate<double>::New().GetPointer();
}

/// First maxNumbers + 1 numbers, so that the parent notices if there are too many.
template <typename Parameters>
std::vector<double> copyFirst(const Parameters& parameters) {
  const auto count = std::min<std::size_t>(parameters.Size(), maxNumbers + 1);
  return {parameters.data_block(), parameters.data_block() + count};
}

std::string handleTransformRequest(const std::string& request) {
  const SuppressHdf5Output suppress;
  const std::string extension = lowercaseExtension(request);
  if ((extension == ".h5" || extension == ".hdf5") && !isSelfContained(request))
    return {};
  const auto reader = makeTransformReader(extension);
  const RecordTransforms recording;
  reader->SetFileName(request);
  reader->Read();
  ReplyWriter reply;
  for (const auto& transform : reader->GetTransformList()) {
    reply.put(transform->GetTransformTypeAsString());
    reply.put(copyFirst(transform->GetParameters()));
    reply.put(copyFirst(transform->GetFixedParameters()));
  }
  return reply.bytes();
}

} // namespace

// An HDF5 symbol tree can branch without bound; a normal transform takes a few milliseconds.
const SandboxJob transformJob("transform", handleTransformRequest, {.seconds = 3});

namespace {

// ---- in the parent process: interpret the reply

constexpr const char* hardenHint =
    "harden it in Slicer (Data module, Harden transform) and save again";
constexpr std::uint64_t maxFileBytes = 64 << 20;
constexpr std::uint64_t maxTextFileBytes = 1 << 20; ///< hundreds of matrices fit

struct TransformRecord {
  std::string type;               ///< ITK's name without scalar type and axes: "AffineTransform"
  std::vector<double> parameters; ///< in the order of ITK's class of that name
  std::vector<double> fixed;      ///< fixed parameters, usually the center
};

[[noreturn]] void throwDamaged(const Path& path) {
  throw inputError(ErrorCode::damagedFile, path,
                   "is damaged, truncated or not an ITK transform; save it again");
}

/// Base class of ITK's transforms that have a matrix and an offset.
using MatrixTransform = itk::MatrixOffsetTransformBase<double, 3, 3>;

/// New ITK transform of this type; null: no such type.
MatrixTransform::Pointer makeMatrixTransform(const std::string& type) {
  registerTransforms();
  const auto made = itk::ObjectFactoryBase::CreateInstance((type + "_double_3_3").c_str());
  if (!made)
    return nullptr;
  made->UnRegister(); // CreateInstance counts one reference too many
  return dynamic_cast<MatrixTransform*>(made.GetPointer());
}

/// "Type" of "Type_scalar_axes_axes". Throws Error (input) unless linear and 3D.
std::string requireLinearType(const Path& path, const std::string& name) {
  std::string type = name.substr(0, name.find('_'));
  const bool isSimple =
      type == "CompositeTransform" || type == "IdentityTransform" || type == "TranslationTransform";
  if (!isSimple && !makeMatrixTransform(type))
    throw fieldError(path, "Transform", sanitize(name), " is not linear; ", hardenHint);
  if (name != type + "_double_3_3") // ITK's readers turn _float_ into _double_
    throw fieldError(path, "Transform", sanitize(name), " is not a 3D transform; save one that is");
  return type;
}

/// Parses the reply, which is untrusted. Throws std::runtime_error if it is malformed.
std::vector<TransformRecord> parseRecords(const Path& path, std::string_view reply) {
  std::vector<TransformRecord> records;
  for (ReplyReader reader(reply); !reader.isAtEnd();)
    records.push_back({requireLinearType(path, reader.text()), reader.numbers(), reader.numbers()});
  return records;
}

/// Map of a record, in the file's space and direction. Throws ITK's exceptions for values that the
/// type forbids (such as a rigid matrix that is not orthogonal).
Affine makeMap(const Path& path, const TransformRecord& record) {
  if (record.type == "IdentityTransform")
    return Affine::Identity();
  const std::vector<double>&numbers = record.parameters, &fixed = record.fixed;
  if (record.type == "TranslationTransform" && numbers.size() == 3)
    return makeTranslation({numbers[0], numbers[1], numbers[2]});
  const auto transform = makeMatrixTransform(record.type);
  if (!transform) // a composite within a composite
    throwDamaged(path);
  // Euler transforms may have a fourth fixed parameter, the order of the axes.
  const std::size_t maxFixed = std::max<std::size_t>(3, transform->GetFixedParameters().size());
  if (numbers.size() != transform->GetNumberOfParameters() ||
      (!fixed.empty() && (fixed.size() < 3 || fixed.size() > maxFixed)))
    throwDamaged(path);
  const auto fill = [](auto array, const std::vector<double>& values) {
    array.SetSize(static_cast<unsigned>(values.size()));
    std::copy(values.begin(), values.end(), array.begin());
    return array;
  };
  if (!fixed.empty())
    transform->SetFixedParameters(fill(transform->GetFixedParameters(), fixed));
  transform->SetParameters(fill(transform->GetParameters(), numbers));
  transform->SetCenter(transform->GetCenter()); // recomputes the offset, which some classes do not
  Affine map;
  for (unsigned row = 0; row < 3; ++row) {
    for (unsigned column = 0; column < 3; ++column)
      map.linear()(row, column) = transform->GetMatrix()(row, column);
    map.translation()[row] = transform->GetOffset()[row];
  }
  return map;
}

/// Product of the file's transforms, in LPS and the file's direction.
Affine compose(const Path& path, const std::vector<TransformRecord>& records) {
  if (records.empty())
    throwDamaged(path);
  if (records.front().type != "CompositeTransform") {
    if (records.size() > 1)
      throw inputError(path, "has ", records.size(),
                       " transforms and does not state how they combine; save one, or a composite");
    return makeMap(path, records.front());
  }
  Affine map = Affine::Identity();
  for (std::size_t i = 1; i < records.size(); ++i)
    map = map * makeMap(path, records[i]);
  return map;
}

void checkExtension(const Path& path) {
  const std::string extension = lowercaseExtension(path);
  static const std::set<std::string> known = {".tfm", ".txt", ".h5", ".hdf5", ".mat"},
                                     images = {".nrrd", ".nhdr", ".nii", ".gz",
                                               ".mgz",  ".mha",  ".mhd"};
  if (images.contains(extension))
    throw inputError(ErrorCode::unsupportedFile, path,
                     "is a displacement field, which is not linear; ", hardenHint);
  if (!known.contains(extension))
    throw inputError(ErrorCode::unsupportedFile, path,
                     "has no extension of a transform; give a .tfm, .txt, .h5, .hdf5 or .mat file");
}

/// Rejects text files that reference other files, which ITK would open.
void checkNoFileReference(const Path& path) {
  if (readText(path, maxFileBytes).find("ComponentTransformFile") != std::string::npos)
    throw fieldError(path, "ComponentTransformFile",
                     "is not supported; save the composite in one file");
}

} // namespace

Affine readLinearTransform(const Path& path) {
  requireFile(path, "give a transform file in it");
  const std::string extension = lowercaseExtension(path);
  const bool isText = extension == ".tfm" || extension == ".txt";
  const std::uint64_t largest = isText ? maxTextFileBytes : maxFileBytes;
  if (std::filesystem::file_size(path) > largest)
    throw inputError(ErrorCode::limitExceeded, path, "is larger than ", largest >> 20,
                     " MB, so it is not a linear transform; ", hardenHint);
  checkExtension(path);
  checkNoFileReference(path);
  SandboxedReader reader(transformJob);
  return parseTransformReply(path, reader.request(path.string(), maxReplyBytes).value_or(""));
}

Affine parseTransformReply(const Path& path, std::string_view reply) {
  try {
    const SuppressItkOutput suppress;
    const Affine map =
        checkAffine(compose(path, parseRecords(path, reply)), [&path](const std::string& what) {
          return fieldError(path, "Parameters", "the map ", what, "; save another one");
        });
    return Affine(lpsToRas * map.linear() * lpsToRas, lpsToRas * map.translation());
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception&) { // ITK: forbidden matrix; ReplyReader: malformed reply
    throwDamaged(path);
  }
}

} // namespace fenestra::core
