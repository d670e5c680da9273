#include "files/medical/MedicalHeader.h"

#include "base/Error.h"
#include "files/formats/NrrdHeader.h"
#include "files/formats/TextHeader.h"
#include "files/medical/MghHeader.h"
#include "io/InputRegistry.h"
#include "io/MessageText.h"

#include <algorithm>
#include <cctype>
#include <initializer_list>
#include <map>
#include <string_view>

namespace fenestra::core {

using namespace header;

namespace {

/// Adds a data file; its name is relative to the header's folder.
void addFile(const std::filesystem::path& path, std::string_view name, StoredSamples& stored) {
  const std::filesystem::path file = path.parent_path() / std::filesystem::path(name);
  if (name == "-") // libraries would read standard input
    throw fieldError(path, "data file", "\"-\" is not a file; give one beside the header");
  try {
    requireFile(file, "give a file of samples");
  } catch (const Error& error) {
    throw fieldError(path, "data file", error.what());
  }
  stored.files.push_back(file);
  stored.bytes += std::filesystem::file_size(file);
}

void setOffset(const std::filesystem::path& path, std::uint64_t offset, StoredSamples& stored) {
  if (offset > stored.bytes)
    throw inputError(ErrorCode::damagedFile, path,
                     "is truncated: it ends before the first sample; copy it again");
  stored.offset = offset;
  stored.bytes -= offset;
}

// ---- NRRD

void locateNrrdFiles(const std::filesystem::path& path, const NrrdHeaderText& header,
                     StoredSamples& stored) {
  if (!header.fields.contains("datafile")) {
    addFile(path, path.filename().string(), stored);
    return setOffset(path, header.end, stored);
  }
  const std::string name = findValue(header.fields, "datafile");
  if (name.starts_with("LIST")) {
    for (const std::string& file : header.files)
      addFile(path, file, stored);
  } else if (name.find('%') != std::string::npos)
    throw fieldError(path, "data file",
                     "numbered file series are not supported; write the volume to one file");
  else
    addFile(path, name, stored);
}

bool isOneOf(const std::string& name, std::initializer_list<const char*> names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

bool isGzip(const std::string& encoding) {
  return isOneOf(encoding, {"gzip", "gz"});
}

/// Rejects encodings, dimensions and byte skips that ITK does not support.
void checkNrrdSupport(const std::filesystem::path& path, Fields& fields) {
  const std::string encoding = toLower(fields["encoding"]);
  if (!isGzip(encoding) && !isOneOf(encoding, {"raw", "hex", "ascii", "text", "txt"}))
    throw fieldError(path, "encoding", "\"", sanitize(encoding),
                     "\" is not supported; use raw or gzip");
  if (const auto axes = parseInteger(fields["dimension"]); axes && *axes < 3)
    throw inputError(ErrorCode::unsupportedFile, path, "is an image of ", *axes,
                     " axes, not a volume; give one with three");
  constexpr std::int64_t maxSkipped = 1 << 20; // teem inflates skipped bytes one at a time
  if (isGzip(encoding) && fields.contains("byteskip")) {
    const auto skipped = parseInteger(fields["byteskip"]);
    if (!skipped || *skipped < 0 || *skipped > maxSkipped)
      throw fieldError(path, "byte skip", "must be from 0 to ", maxSkipped,
                       " in compressed data; write the samples without it");
  }
}

StoredSamples locateNrrd(const std::filesystem::path& path) {
  NrrdHeaderText header = readNrrdHeader(path);
  Fields& fields = header.fields;
  checkNrrdSupport(path, fields);
  StoredSamples stored;
  stored.hasSpacing = hasNrrdSpacing(header);
  const std::string space = toLower(fields["space"]);
  stored.hasAxes = space.find("-superior") != std::string::npos || space.starts_with("scanner") ||
                   isOneOf(space, {"ras", "las", "lps", "rast", "last", "lpst"});
  const std::string encoding = toLower(fields["encoding"]);
  stored.isCompressed = encoding != "raw" && encoding != "hex"; // one text digit can give 8 bytes
  locateNrrdFiles(path, header, stored);
  for (const std::filesystem::path& file : stored.files) {
    checkNrrdPath(file);
    if (isOneOf(encoding, {"ascii", "text", "txt"}))
      checkNrrdNumbers(file, stored.offset, path);
  }
  const bool skips = fields.contains("lineskip") || fields.contains("byteskip");
  const bool isSimple = stored.files.size() == 1 && !skips;
  stored.isRaw = isSimple && encoding == "raw";
  stored.isStream = isSimple && isGzip(encoding);
  const std::vector<std::string> kinds = splitWords(toLower(fields["kinds"]));
  const auto isList = [](const std::string& kind) { return isOneOf(kind, {"list", "vector"}); };
  stored.isListFirst = !kinds.empty() && isList(kinds.front());
  stored.isListLast = !kinds.empty() && isList(kinds.back());
  stored.hasList = std::ranges::find(kinds, "list") != kinds.end();
  if (const std::string order = toLower(fields["endian"]); order == "little" || order == "big")
    stored.order = order == "big" ? std::endian::big : std::endian::little;
  return stored;
}

// ---- MetaImage

/// Checks lengths. MetaIO copies text into 255-byte buffers. It also reads as many numbers as the
/// dimension requires, present or not.
void checkMetaField(const std::filesystem::path& path, const std::string& key,
                    std::string_view value, std::int64_t dimension) {
  const bool isVector = isOneOf(key, {"DimSize", "ElementSpacing", "ElementSize", "Offset",
                                      "Position", "Origin", "CenterOfRotation"});
  const bool isMatrix = isOneOf(key, {"TransformMatrix", "Rotation", "Orientation"});
  const std::size_t maxLength = isMatrix || isVector ? 1000 : 250;
  if (key.size() > 200 || value.size() > maxLength)
    throw fieldError(path, key.substr(0, 40), "has more than ", maxLength,
                     " characters; shorten it");
  const auto numbers = static_cast<std::int64_t>(splitWords(value).size());
  const std::int64_t needed = isVector ? dimension : isMatrix ? dimension * dimension : 0;
  if (numbers < needed)
    throw fieldError(path, key, "has ", numbers, " numbers; it needs ", needed);
}

/// Rejects values that MetaIO misreads, or reads but does not apply.
void checkMetaValue(const std::filesystem::path& path, const std::string& key,
                    const std::string& value) {
  const auto refuseUnless = [&](double neutral) {
    if (parseNumbers(value) != std::vector<double>{neutral})
      throw fieldError(path, key, "only ", static_cast<int>(neutral),
                       " is supported; rescale the samples and write them again");
  };
  if (key == "ElementToIntensityFunctionSlope")
    refuseUnless(1.0);
  else if (key == "ElementToIntensityFunctionOffset")
    refuseUnless(0.0);
  else if (key == "DistanceUnits")
    checkMillimeters(path, key, value);
  else if (key == "DimSize")
    for (const std::string& word : splitWords(value))
      if (const auto size = parseInteger(word); !size || *size < 1 || *size > INT32_MAX)
        throw fieldError(path, "DimSize", "each must be an integer from 1 to 2147483647");
}

Fields readMetaFields(const std::filesystem::path& path, HeaderLines& lines) {
  Fields fields;
  std::int64_t dimension = 0;
  while (!fields.contains("ElementDataFile")) {
    const auto line = lines.next();
    const std::size_t equals = line ? line->find('=') : std::string_view::npos;
    if (equals == std::string_view::npos || hasControlCharacter(trim(*line)))
      throw damagedError(path, "MetaImage");
    const std::string_view name = line->substr(0, equals);
    if (name.find(':') != std::string_view::npos) // MetaIO treats a colon as an equals sign
      throw damagedError(path, "MetaImage");
    const std::string key(trim(name));
    fields[key] = trim(line->substr(equals + 1));
    if (key == "NDims") {
      dimension = parseInteger(fields[key]).value_or(0);
      if (dimension < 1 || dimension > 10)
        throw fieldError(path, "NDims", "must be an integer from 1 to 10");
    }
    checkMetaField(path, key, fields[key], dimension);
    checkMetaValue(path, key, fields[key]);
  }
  if (dimension == 0)
    throw damagedError(path, "MetaImage");
  return fields;
}

StoredSamples locateMeta(const std::filesystem::path& path) {
  HeaderLines lines(path);
  Fields fields = readMetaFields(path, lines);
  const auto isTrue = [&fields](const char* key) {
    const std::string value = toLower(fields[key]);
    return value.starts_with('t') || value.starts_with('1') || value.starts_with('y');
  };
  if (fields.contains("BinaryData") && !isTrue("BinaryData"))
    throw fieldError(path, "BinaryData", "text samples are not supported; write them as binary");
  const std::string& name = fields["ElementDataFile"];
  if (name.starts_with("LIST") || name.find('%') != std::string::npos)
    throw fieldError(path, "ElementDataFile",
                     "file series are not supported; write the volume to one file");
  const bool isLocal = toLower(name) == "local";
  StoredSamples stored;
  stored.hasSpacing = fields.contains("ElementSpacing") || fields.contains("ElementSize");
  stored.isCompressed = stored.isStream = isTrue("CompressedData");
  stored.order = std::endian::native;
  for (const char* key : {"BinaryDataByteOrderMSB", "ElementByteOrderMSB"})
    if (fields.contains(key))
      stored.order = isTrue(key) ? std::endian::big : std::endian::little;
  addFile(path, isLocal ? path.filename().string() : name, stored);
  const std::int64_t header = parseInteger(fields["HeaderSize"]).value_or(0);
  // A negative HeaderSize means that the samples end at the end of the file.
  stored.isRaw = !stored.isCompressed && (header == 0 || (header > 0 && !isLocal));
  setOffset(path,
            isLocal ? lines.position()
                    : static_cast<std::uint64_t>(std::max<std::int64_t>(header, 0)),
            stored);
  return stored;
}

// ---- NIfTI, Analyze and FreeSurfer

/// `headerBytes`: of the header that a file begins with, unless the header is another file.
StoredSamples locateNifti(const std::filesystem::path& path, std::uint64_t headerBytes) {
  const NiftiFiles files = findNiftiFiles(path);
  requireFile(files.header, "give a file");
  StoredSamples stored;
  const std::string extension = lowercaseExtension(path);
  stored.isCompressed = extension == ".gz" || extension == ".mgz";
  addFile(path, files.samples.filename().string(), stored);
  if (!stored.isCompressed && files.header == files.samples)
    setOffset(path, headerBytes, stored);
  return stored;
}

} // namespace

std::optional<MedicalFormat> findMedicalFormat(const std::filesystem::path& path) {
  const std::string name = toLower(path.filename().string());
  if (name.ends_with(".nrrd") || name.ends_with(".nhdr"))
    return MedicalFormat::nrrd;
  const std::string_view stem =
      std::string_view(name).substr(0, name.size() - (name.ends_with(".gz") ? 3 : 0));
  if (stem.ends_with(".nii") || stem.ends_with(".hdr") || stem.ends_with(".img"))
    return MedicalFormat::nifti;
  if (name.ends_with(".mgz") || stem.ends_with(".mgh"))
    return MedicalFormat::mgh;
  if (name.ends_with(".mha") || name.ends_with(".mhd"))
    return MedicalFormat::metaImage;
  if (name.ends_with(".vti"))
    return MedicalFormat::vtk;
  return std::nullopt;
}

NiftiFiles findNiftiFiles(const std::filesystem::path& path) {
  std::string name = path.filename().string();
  const std::size_t end = name.size() - (toLower(name).ends_with(".gz") ? 3 : 0);
  const std::string kind = end < 4 ? "" : toLower(name.substr(end - 4, 4));
  if (kind != ".hdr" && kind != ".img")
    return {path, path};
  std::string other = kind == ".hdr" ? ".img" : ".hdr";
  if (std::isupper(static_cast<unsigned char>(name[end - 1])))
    std::ranges::transform(other, other.begin(),
                           [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  const std::filesystem::path pair = path.parent_path() / name.replace(end - 4, 4, other);
  return kind == ".hdr" ? NiftiFiles{path, pair} : NiftiFiles{pair, path};
}

StoredSamples locateSamples(const std::filesystem::path& path, MedicalFormat format) {
  if (format == MedicalFormat::nrrd)
    return locateNrrd(path);
  if (format == MedicalFormat::metaImage)
    return locateMeta(path);
  return locateNifti(path, format == MedicalFormat::mgh ? mghHeaderBytes : nifti1Bytes);
}

std::uint64_t checkDeclaredBytes(const std::filesystem::path& path, const StoredSamples& stored,
                                 std::uint64_t count, std::uint64_t sampleBytes,
                                 std::uint64_t skipped) {
  std::uint64_t declared = 0;
  if (__builtin_mul_overflow(count, sampleBytes, &declared) ||
      __builtin_add_overflow(declared, skipped, &declared))
    declared = UINT64_MAX;
  constexpr std::uint64_t maxRatio = 1100; // deflate reaches 1032
  if (declared / (stored.isCompressed ? maxRatio : 1) > stored.bytes)
    throw inputError(ErrorCode::damagedFile, path, "is truncated: its header declares ", declared,
                     " bytes of samples, the file has ", stored.bytes,
                     (stored.isCompressed ? " compressed" : ""), "; copy or write it again");
  return declared;
}

} // namespace fenestra::core
