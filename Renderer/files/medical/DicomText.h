#pragma once
// Text of DICOM files in their own character sets.

#include <string>

namespace fenestra::core {

/// Converts a value to UTF-8, on one line. `characterSet`: the values of SpecificCharacterSet
/// (DICOM PS3.3, C.12.1.1.2); bytes of unknown sets beyond ASCII become question marks.
std::string toUtf8(const std::string& text, const std::string& characterSet);

} // namespace fenestra::core
