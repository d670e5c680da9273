#include "files/medical/DicomDataSet.h"

#include "base/Text.h"
#include "files/medical/DicomReader.h"
#include "io/Sandbox.h"

#include <gdcmFile.h>
#include <gdcmSequenceOfItems.h>
#include <gdcmTrace.h>

#include <cstring>

namespace fenestra::core {
namespace {

using gdcm::DataSet;
using gdcm::Tag;

template <typename Number>
std::vector<double> getNumbers(const DataSet& data, const Tag& tag) {
  const std::string bytes = getBytes(data, tag);
  std::vector<Number> values(bytes.size() / sizeof(Number));
  if (!values.empty()) // else its pointer may be null
    std::memcpy(values.data(), bytes.data(), values.size() * sizeof(Number));
  return {values.begin(), values.end()};
}

} // namespace

const Tag pixelData(0x7fe0, 0x0010);

std::string getBytes(const DataSet& data, const Tag& tag) {
  const gdcm::ByteValue* value =
      data.FindDataElement(tag) ? data.GetDataElement(tag).GetByteValue() : nullptr;
  return value ? std::string(value->GetPointer(), value->GetLength()) : std::string();
}

std::string getText(const DataSet& data, const Tag& tag) {
  return std::string(trim(getBytes(data, tag), std::string_view(" \0", 2)));
}

std::vector<double> getDecimals(const DataSet& data, const Tag& tag) {
  return parseDecimals(getText(data, tag));
}

std::vector<double> getShorts(const DataSet& data, const Tag& tag) {
  return getNumbers<std::uint16_t>(data, tag);
}

std::vector<double> getLongs(const DataSet& data, const Tag& tag) {
  return getNumbers<std::uint32_t>(data, tag);
}

std::vector<double> getFloats(const DataSet& data, const Tag& tag) {
  return getNumbers<float>(data, tag);
}

std::vector<double> getDoubles(const DataSet& data, const Tag& tag) {
  return getNumbers<double>(data, tag);
}

DicomItems::DicomItems(const DataSet& data, const Tag& tag) {
  if (!data.FindDataElement(tag))
    return;
  const auto sequence = data.GetDataElement(tag).GetValueAsSQ();
  if (!sequence)
    return;
  for (std::size_t i = 1; i <= sequence->GetNumberOfItems(); ++i) // GDCM counts from 1
    m_items.push_back(&sequence->GetItem(i).GetNestedDataSet());
  m_sequence = std::make_shared<gdcm::SmartPointer<gdcm::SequenceOfItems>>(sequence);
}

bool isDeflated(const gdcm::File& file) {
  return file.GetHeader().GetDataSetTransferSyntax() ==
         gdcm::TransferSyntax::DeflatedExplicitVRLittleEndian;
}

SuppressGdcmOutput::SuppressGdcmOutput()
    : m_hadWarnings(gdcm::Trace::GetWarningFlag()), m_hadErrors(gdcm::Trace::GetErrorFlag()) {
  gdcm::Trace::WarningOff();
  gdcm::Trace::ErrorOff();
}

SuppressGdcmOutput::~SuppressGdcmOutput() {
  gdcm::Trace::SetWarning(m_hadWarnings);
  gdcm::Trace::SetError(m_hadErrors);
}

void limitMemoryByFile(const std::filesystem::path& path) {
  constexpr std::uint64_t least = std::uint64_t{1} << 28;
  constexpr std::uint64_t ratio = 2500; // twice what deflate reaches
  std::error_code missing;
  const std::uint64_t bytes = std::filesystem::file_size(path, missing);
  limitMemory(missing ? least : least + bytes * ratio);
}

} // namespace fenestra::core
