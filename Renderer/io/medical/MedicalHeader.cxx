#include "io/medical/MedicalHeader.h"

#include "core/Error.h"
#include "io/Inputs.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <fstream>
#include <map>
#include <string_view>

namespace fenestra {
namespace {

constexpr std::size_t longestHeader = 16 << 20;
/// Lines of an NRRD header, with those of its list of files: teem compares each key with all
/// before it.
constexpr int mostLines = 10'000;
/// Bytes of a line or a path that teem may repeat in a message, for which it has 1024.
constexpr std::size_t longestLine = 500, longestPath = 900;
/// Deflate packs at most 1032 bytes into one.
constexpr std::uint64_t greatestRatio = 1100;

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos)
    return {};
  return text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
}

std::vector<std::string_view> words(std::string_view text) {
  std::vector<std::string_view> found;
  for (text = trimmed(text); !text.empty(); text = trimmed(text)) {
    const std::size_t end = std::min(text.find_first_of(" \t"), text.size());
    found.push_back(text.substr(0, end));
    text.remove_prefix(end);
  }
  return found;
}

std::optional<std::int64_t> wholeNumber(std::string_view text) {
  text = trimmed(text);
  std::int64_t value = 0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (failure != std::errc() || end != text.data() + text.size())
    return std::nullopt;
  return value;
}

Error damaged(const std::filesystem::path& path, const std::string& format) {
  return inputError(path.string(),
                    "is not a " + format + " file, or its header is damaged; write it again");
}

/// The text header at the front of a file, line by line; it may be followed by binary samples.
class HeaderLines {
public:
  explicit HeaderLines(const std::filesystem::path& path) {
    const std::uintmax_t size = std::filesystem::file_size(path);
    m_text.resize(static_cast<std::size_t>(std::min<std::uintmax_t>(longestHeader, size)));
    std::ifstream file(path, std::ios::binary);
    file.read(m_text.data(), static_cast<std::streamsize>(m_text.size()));
    m_text.resize(static_cast<std::size_t>(file.gcount()));
  }

  /// The next line without its end; nothing where there is none that ends within the limit.
  std::optional<std::string_view> next() {
    if (m_position >= m_text.size())
      return std::nullopt;
    const std::size_t end = m_text.find('\n', m_position);
    if (end == std::string::npos && m_text.size() == longestHeader)
      return std::nullopt;
    std::string_view line(m_text);
    line = line.substr(m_position, end == std::string::npos ? end : end - m_position);
    m_position += line.size() + 1;
    if (line.ends_with('\r'))
      line.remove_suffix(1);
    return line;
  }

  /// Of the byte after the lines read so far.
  std::uint64_t position() const { return std::min(m_position, m_text.size()); }

private:
  std::string m_text;
  std::size_t m_position = 0;
};

/// To libraries a zero byte or a lone \r ends a line, so that they would read another one than we
/// do.
bool hasControls(std::string_view line) {
  return std::any_of(line.begin(), line.end(),
                     [](unsigned char c) { return (c < 0x20 && c != '\t') || c == 0x7f; });
}

/// Data files are named relative to their header's folder.
void addFile(const std::filesystem::path& path, std::string_view name, StoredSamples& stored) {
  const std::filesystem::path file = path.parent_path() / std::filesystem::path(name);
  if (name == "-") // to libraries the standard input
    throw inputError(path.string(), "data file: \"-\" is no file; name one beside the header");
  try {
    requireFile(file, "name a file with samples");
  } catch (const Error& error) {
    throw inputError(path.string(), std::string("data file: ") + error.what());
  }
  stored.files.push_back(file);
  stored.bytes += std::filesystem::file_size(file);
}

void skip(const std::filesystem::path& path, std::uint64_t offset, StoredSamples& stored) {
  if (offset > stored.bytes)
    throw inputError(path.string(),
                     "is truncated: it ends before its samples begin; copy it again");
  stored.offset = offset;
  stored.bytes -= offset;
}

// ---- NRRD
// ----------------------------------------------------------------------------------------

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

/// Key by key, lower case and without blanks: of names with and without, teem takes both.
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

void locateNrrdFiles(const std::filesystem::path& path, const Fields& fields, NrrdLines& lines,
                     StoredSamples& stored) {
  const auto named = fields.find("datafile");
  if (named == fields.end()) {
    addFile(path, path.filename().string(), stored);
    return skip(path, lines.position(), stored);
  }
  const std::string& name = named->second;
  if (name.starts_with("LIST")) {
    for (auto line = lines.next(); line; line = lines.next())
      if (!trimmed(*line).empty())
        addFile(path, trimmed(*line), stored);
  } else if (name.find('%') != std::string::npos)
    throw inputError(path.string(), "data file: numbered series of files are not read; write the "
                                    "volume into one file");
  else
    addFile(path, name, stored);
}

StoredSamples locateNrrd(const std::filesystem::path& path) {
  checkNrrdPath(path);
  NrrdLines lines(path);
  Fields fields = readNrrdFields(path, lines);
  checkNrrdSizes(path, fields);
  checkNrrdGeometry(path, fields);
  StoredSamples stored;
  const std::string encoding = lower(fields["encoding"]);
  stored.compressed = encoding != "raw" && encoding != "hex"; // a text's digit can be 8 bytes
  locateNrrdFiles(path, fields, lines, stored);
  for (const std::filesystem::path& file : stored.files) {
    checkNrrdPath(file);
    if (encoding == "ascii" || encoding == "text" || encoding == "txt")
      checkNrrdNumbers(file, stored.offset, path);
  }
  const bool skips = fields.contains("lineskip") || fields.contains("byteskip");
  const bool simple = stored.files.size() == 1 && !skips;
  stored.isRaw = simple && encoding == "raw";
  stored.isStream = simple && (encoding == "gzip" || encoding == "gz");
  const std::string kind = lower(fields["kinds"]);
  stored.isListFirst = kind.starts_with("list") || kind.starts_with("vector");
  if (const std::string order = lower(fields["endian"]); order == "little" || order == "big")
    stored.order = order == "big" ? std::endian::big : std::endian::little;
  return stored;
}

// ---- MetaImage
// -----------------------------------------------------------------------------------

/// MetaIO copies text into 255 bytes, and takes as many numbers as the dimension asks for, whether
/// they are there or not.
void checkMetaField(const std::filesystem::path& path, const std::string& key,
                    std::string_view value, std::int64_t dimension) {
  static const std::array vectors = {"DimSize",  "ElementSpacing", "ElementSize",     "Offset",
                                     "Position", "Origin",         "CenterOfRotation"};
  static const std::array matrices = {"TransformMatrix", "Rotation", "Orientation"};
  const auto isOneOf = [&key](const auto& names) {
    return std::find(names.begin(), names.end(), key) != names.end();
  };
  const std::size_t longest = isOneOf(matrices) || isOneOf(vectors) ? 1000 : 250;
  if (key.size() > 200 || value.size() > longest)
    throw inputError(path.string(), key.substr(0, 40) + ": has more than " +
                                        std::to_string(longest) + " characters; shorten it");
  const auto numbers = static_cast<std::int64_t>(words(value).size());
  const std::int64_t needed = isOneOf(vectors)    ? dimension
                              : isOneOf(matrices) ? dimension * dimension
                                                  : 0;
  if (numbers < needed)
    throw inputError(path.string(), key + ": has " + std::to_string(numbers) +
                                        " numbers; give it " + std::to_string(needed));
}

Fields readMetaFields(const std::filesystem::path& path, HeaderLines& lines) {
  Fields fields;
  std::int64_t dimension = 0;
  while (!fields.contains("ElementDataFile")) {
    const auto line = lines.next();
    const std::size_t equals = line ? line->find('=') : std::string_view::npos;
    if (equals == std::string_view::npos || hasControls(trimmed(*line)))
      throw damaged(path, "MetaImage");
    const std::string_view name = line->substr(0, equals);
    if (name.find(':') != std::string_view::npos) // which MetaIO takes for an equals sign
      throw damaged(path, "MetaImage");
    const std::string key(trimmed(name));
    fields[key] = trimmed(line->substr(equals + 1));
    if (key == "NDims") {
      dimension = wholeNumber(fields[key]).value_or(0);
      if (dimension < 1 || dimension > 10)
        throw inputError(path.string(), "NDims: must be a whole number from 1 to 10");
    }
    checkMetaField(path, key, fields[key], dimension);
  }
  if (dimension == 0)
    throw damaged(path, "MetaImage");
  return fields;
}

StoredSamples locateMeta(const std::filesystem::path& path) {
  HeaderLines lines(path);
  Fields fields = readMetaFields(path, lines);
  const auto isTrue = [&fields](const char* key) {
    const std::string value = lower(fields[key]);
    return value.starts_with('t') || value.starts_with('1') || value.starts_with('y');
  };
  if (fields.contains("BinaryData") && !isTrue("BinaryData"))
    throw inputError(path.string(),
                     "BinaryData: samples as text are not read; write them as binary");
  const std::string& name = fields["ElementDataFile"];
  if (name.starts_with("LIST") || name.find('%') != std::string::npos)
    throw inputError(path.string(), "ElementDataFile: series of files are not read; write the "
                                    "volume into one file");
  const bool local = lower(name) == "local";
  StoredSamples stored;
  stored.compressed = stored.isStream = isTrue("CompressedData");
  stored.order = std::endian::native;
  for (const char* key : {"BinaryDataByteOrderMSB", "ElementByteOrderMSB"})
    if (fields.contains(key))
      stored.order = isTrue(key) ? std::endian::big : std::endian::little;
  addFile(path, local ? path.filename().string() : name, stored);
  const std::int64_t header = wholeNumber(fields["HeaderSize"]).value_or(0);
  // A negative HeaderSize means: the samples end where the file ends.
  stored.isRaw = !stored.compressed && (header == 0 || (header > 0 && !local));
  skip(path,
       local ? lines.position() : static_cast<std::uint64_t>(std::max<std::int64_t>(header, 0)),
       stored);
  return stored;
}

// ---- NIfTI
// ---------------------------------------------------------------------------------------

StoredSamples locateNifti(const std::filesystem::path& path) {
  StoredSamples stored;
  stored.compressed = lower(path.extension().string()) == ".gz";
  addFile(path, path.filename().string(), stored);
  constexpr std::uint64_t headerBytes = 348;
  if (!stored.compressed)
    skip(path, headerBytes, stored);
  return stored;
}

} // namespace

std::optional<MedicalFormat> medicalFormat(const std::filesystem::path& path) {
  const std::string name = lower(path.filename().string());
  if (name.ends_with(".nrrd") || name.ends_with(".nhdr"))
    return MedicalFormat::nrrd;
  if (name.ends_with(".nii") || name.ends_with(".nii.gz"))
    return MedicalFormat::nifti;
  if (name.ends_with(".mha") || name.ends_with(".mhd"))
    return MedicalFormat::metaImage;
  return std::nullopt;
}

StoredSamples locateSamples(const std::filesystem::path& path, MedicalFormat format) {
  switch (format) {
  case MedicalFormat::nrrd:
    return locateNrrd(path);
  case MedicalFormat::metaImage:
    return locateMeta(path);
  case MedicalFormat::nifti:
    break;
  }
  return locateNifti(path);
}

void checkCapacity(const std::filesystem::path& path, const StoredSamples& stored,
                   std::uint64_t declared) {
  if (declared / (stored.compressed ? greatestRatio : 1) > stored.bytes)
    throw inputError(path.string(),
                     "is truncated: its header announces " + std::to_string(declared) +
                         " bytes of samples, the file has " + std::to_string(stored.bytes) +
                         (stored.compressed ? " compressed" : "") + "; copy or write it again");
}

} // namespace fenestra
