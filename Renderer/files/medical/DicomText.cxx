#include "files/medical/DicomText.h"

#include "base/Text.h"
#include "io/MessageText.h"

#include <iconv.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

namespace fenestra::core {
namespace {

/// Names that iconv knows, by what a defined term ends with. With code extensions, Japanese text
/// switches sets by escape sequences as ISO-2022-JP does; Korean and Chinese text uses the upper
/// half of EUC after one escape sequence.
constexpr std::array<std::pair<std::string_view, const char*>, 19> encodings = {{
    {"IR 6", "ASCII"},        {"IR 100", "ISO-8859-1"},   {"IR 101", "ISO-8859-2"},
    {"IR 109", "ISO-8859-3"}, {"IR 110", "ISO-8859-4"},   {"IR 126", "ISO-8859-7"},
    {"IR 127", "ISO-8859-6"}, {"IR 138", "ISO-8859-8"},   {"IR 144", "ISO-8859-5"},
    {"IR 148", "ISO-8859-9"}, {"IR 166", "TIS-620"},      {"IR 203", "ISO-8859-15"},
    {"IR 13", "SHIFT_JIS"},   {"IR 87", "ISO-2022-JP-2"}, {"IR 159", "ISO-2022-JP-2"},
    {"IR 149", "EUC-KR"},     {"IR 58", "GB2312"},        {"GB18030", "GB18030"},
    {"GBK", "GBK"},
}};

/// nullptr: UTF-8, or unknown.
const char* findEncoding(const std::string& characterSet) {
  const char* found = nullptr;
  for (const std::string& term : split(characterSet, '\\')) { // the last one extends the first
    const std::string name = replaceAll(trim(term), "_", " ");
    for (const auto& [end, encoding] : encodings)
      if (name == end || name == concat("ISO ", end) || name == concat("ISO 2022 ", end))
        found = encoding;
  }
  return found;
}

/// Text without the escape sequences that select EUC's upper half.
std::string removeEscapes(std::string text) {
  for (const std::string_view escape : {"\x1b$)C", "\x1b$)A"})
    text = replaceAll(text, escape, "");
  return text;
}

} // namespace

std::string toUtf8(const std::string& text, const std::string& characterSet) {
  const char* const encoding = findEncoding(characterSet);
  if (!encoding)
    return toOneLine(text);
  const iconv_t converter = ::iconv_open("UTF-8", encoding);
  if (converter == iconv_t(-1)) // NOLINT(performance-no-int-to-ptr): as POSIX defines it
    return toOneLine(text);
  std::string input = removeEscapes(text), output(4 * input.size(), '\0');
  char *from = input.data(), *to = output.data();
  std::size_t left = input.size(), room = output.size();
  const bool isConverted = ::iconv(converter, &from, &left, &to, &room) != std::size_t(-1);
  ::iconv_close(converter);
  output.erase(output.size() - room);
  return toOneLine(isConverted ? output : text);
}

} // namespace fenestra::core
