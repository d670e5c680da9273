#include "io/NrrdHeader.h"

#include "io/HeaderText.h"

namespace fenestra {

using namespace header;

namespace {

/// Lines of a header, with those of its list of files: teem compares each key with all before it.
constexpr int mostLines = 10'000;
/// Bytes of a line or a path that teem may repeat in a message, for which it has 1024.
constexpr std::size_t longestLine = 500, longestPath = 900;

using Fields = std::map<std::string, std::string>;

/// ITK keeps sizes in 32 bits and hands teem a buffer of those; teem has room for 16 axes, and
/// writes one more where there are too many sizes.
void checkNrrdSizes(const std::filesystem::path& path, const Fields& fields) {
  const auto dimension = fields.find("dimension");
  const auto axes = dimension == fields.end() ? std::nullopt : wholeNumber(dimension->second);
  if (!axes || *axes < 1 || *axes > 10)
    throw inputError(path.string(), "dimension: must be a whole number from 1 to 10");
  const auto it = fields.find("sizes");
  if (it == fields.end())
    throw damaged(path, "NRRD");
  for (const std::string_view word : words(it->second)) {
    const auto size = wholeNumber(word);
    if (!size || *size < 1 || *size > INT32_MAX)
      throw inputError(path.string(), "sizes: each must be a whole number from 1 to 2147483647");
  }
}

/// Without a number ITK silently takes its default.
void checkNrrdGeometry(const std::filesystem::path& path, const Fields& fields) {
  for (const auto& [key, name] : {std::pair("spacedirections", "space directions"),
                                  {"spaceorigin", "space origin"},
                                  {"spacings", "spacings"}})
    if (const auto it = fields.find(key);
        it != fields.end() && lower(it->second).find("nan") != std::string::npos)
      throw inputError(path.string(), std::string(name) + ": is not a number; mend the header");
}

/// The lines of an NRRD header: whatever teem makes of one, its messages hold it.
class NrrdLines {
public:
  explicit NrrdLines(const std::filesystem::path& path) : m_path(path), m_lines(path) {}

  std::optional<std::string_view> next() {
    const auto line = m_lines.next();
    if (!line)
      return std::nullopt;
    if (++m_count > mostLines)
      throw inputError(m_path.string(), "header: has more than " + std::to_string(mostLines) +
                                            " lines; remove some of its key:=value lines");
    if (hasControls(*line))
      throw damaged(m_path, "NRRD");
    if (line->size() > longestLine && !isKeyValue(*line))
      throw inputError(m_path.string(), "header: line " + std::to_string(m_count) +
                                            " has more than " + std::to_string(longestLine) +
                                            " bytes and is no key:=value; shorten it");
    return line;
  }

  /// Text of the application's own, of any length. As to teem, a field's ": " comes first.
  static bool isKeyValue(std::string_view line) {
    return line.substr(0, line.find(": ")).find(":=") != std::string_view::npos;
  }

  /// Of the byte after the lines read so far.
  std::uint64_t position() const { return m_lines.position(); }

private:
  const std::filesystem::path& m_path;
  HeaderLines m_lines;
  int m_count = 0;
};

Fields readNrrdFields(const std::filesystem::path& path, NrrdLines& lines) {
  const auto magic = lines.next();
  if (!magic || !magic->starts_with("NRRD000") || magic->size() != 8)
    throw damaged(path, "NRRD");
  Fields fields;
  for (auto line = lines.next(); line && !line->empty(); line = lines.next()) {
    const std::size_t colon = line->find(": ");
    if (colon == std::string_view::npos || line->starts_with('#') || NrrdLines::isKeyValue(*line))
      continue;
    std::string key = lower(std::string(line->substr(0, colon)));
    std::erase(key, ' ');
    const auto [field, isNew] = fields.emplace(key, trimmed(line->substr(colon + 2)));
    if (!isNew) // whichever of them teem takes
      throw inputError(path.string(), key.substr(0, 40) + ": is there twice; remove one");
    if (key == "datafile" && field->second.starts_with("LIST"))
      break; // the file names follow
  }
  return fields;
}

} // namespace

void checkNrrdPath(const std::filesystem::path& path) {
  if (path.string().size() > longestPath)
    throw inputError(path.string(), "has a path of more than " + std::to_string(longestPath) +
                                        " bytes; move it to a folder with a shorter one");
}

/// Teem reads each number as a text into 1024 bytes, however long it is.
void checkNrrdNumbers(const std::filesystem::path& path, std::uint64_t offset,
                      const std::filesystem::path& header) {
  std::ifstream file(path, std::ios::binary);
  file.seekg(static_cast<std::streamoff>(offset));
  std::vector<char> block(1 << 20);
  std::size_t length = 0; // of the number so far
  while (file.read(block.data(), static_cast<std::streamsize>(block.size())) || file.gcount() > 0)
    for (const char c : std::string_view(block.data(), static_cast<std::size_t>(file.gcount()))) {
      length = std::isspace(static_cast<unsigned char>(c)) ? 0 : length + 1;
      if (length > longestLine)
        throw inputError(header.string(), "has a number of more than " +
                                              std::to_string(longestLine) +
                                              " characters among its samples; write it again");
    }
}

NrrdHeaderText readNrrdHeader(const std::filesystem::path& path) {
  checkNrrdPath(path);
  NrrdLines lines(path);
  NrrdHeaderText header;
  header.fields = readNrrdFields(path, lines);
  checkNrrdSizes(path, header.fields);
  checkNrrdGeometry(path, header.fields);
  header.end = lines.position();
  if (const auto data = header.fields.find("datafile");
      data != header.fields.end() && data->second.starts_with("LIST"))
    for (auto line = lines.next(); line; line = lines.next())
      if (!trimmed(*line).empty())
        header.files.emplace_back(trimmed(*line));
  return header;
}

} // namespace fenestra
