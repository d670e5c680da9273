#pragma once
// Elements of a DICOM data set that GDCM has read. For code that runs in a sandboxed child.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace gdcm {
class DataSet;
class File;
class Tag;
} // namespace gdcm

namespace fenestra::core {

extern const gdcm::Tag pixelData;

/// The value as stored; empty: missing.
std::string getBytes(const gdcm::DataSet& data, const gdcm::Tag& tag);
/// The value without its padding.
std::string getText(const gdcm::DataSet& data, const gdcm::Tag& tag);
/// Values of decimal strings (DS) or integer strings (IS).
std::vector<double> getDecimals(const gdcm::DataSet& data, const gdcm::Tag& tag);
/// Values of 16 bits without sign (US), of 32 bits without sign (UL), and of floating point (FL and
/// FD).
std::vector<double> getShorts(const gdcm::DataSet& data, const gdcm::Tag& tag);
std::vector<double> getLongs(const gdcm::DataSet& data, const gdcm::Tag& tag);
std::vector<double> getFloats(const gdcm::DataSet& data, const gdcm::Tag& tag);
std::vector<double> getDoubles(const gdcm::DataSet& data, const gdcm::Tag& tag);

/// Data sets of a sequence's items.
class DicomItems {
public:
  DicomItems(const gdcm::DataSet& data, const gdcm::Tag& tag);
  std::size_t size() const { return m_items.size(); }
  const gdcm::DataSet& operator[](std::size_t i) const { return *m_items[i]; }

private:
  std::vector<const gdcm::DataSet*> m_items;
  std::shared_ptr<const void> m_sequence; ///< which owns them
};

/// True for the deflated transfer syntax, whose data sets GDCM reads only as a whole.
bool isDeflated(const gdcm::File& file);

/// Silences GDCM, which prints warnings to std::cerr, during its lifetime.
class SuppressGdcmOutput {
public:
  SuppressGdcmOutput();
  ~SuppressGdcmOutput();
  SuppressGdcmOutput(const SuppressGdcmOutput&) = delete;
  SuppressGdcmOutput& operator=(const SuppressGdcmOutput&) = delete;

private:
  bool m_hadWarnings, m_hadErrors;
};

/// In a child: limits memory to what a file of this size may need. GDCM allocates any length that
/// an element declares.
void limitMemoryByFile(const std::filesystem::path& path);

} // namespace fenestra::core
