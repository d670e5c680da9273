#include "files/formats/Csv.h"

#include "base/Error.h"

#include <algorithm>

namespace fenestra::core {
namespace {

constexpr std::size_t maxFields = 1'000'000;

/// Reads a table field by field.
class CsvParser {
public:
  CsvParser(std::string_view text, const std::string& source) : m_text(text), m_source(source) {
    constexpr std::string_view byteOrderMark = "\xef\xbb\xbf";
    if (m_text.starts_with(byteOrderMark))
      m_text.remove_prefix(byteOrderMark.size());
    const std::string_view first = m_text.substr(0, m_text.find_first_of("\r\n"));
    if (first.find(',') == first.npos && first.find(';') != first.npos)
      m_separator = ';';
  }

  std::vector<CsvRecord> parse() {
    std::vector<CsvRecord> records;
    while (m_at < m_text.size()) {
      CsvRecord record = readRecord();
      if (record.fields.size() > 1 || !trim(record.fields[0]).empty())
        records.push_back(std::move(record));
    }
    return records;
  }

private:
  bool isAt(char c) const { return m_at < m_text.size() && m_text[m_at] == c; }
  bool isAtLineEnd() const { return m_at == m_text.size() || isAt('\n') || isAt('\r'); }

  CsvRecord readRecord() {
    CsvRecord record{m_line, {}};
    for (;;) {
      if (++m_fields > maxFields)
        throw inputError(ErrorCode::limitExceeded, m_source, "holds more than ", maxFields,
                         " fields; split it");
      record.fields.push_back(isAt('"') ? readQuotedField() : readPlainField());
      if (!isAt(m_separator))
        break;
      ++m_at;
    }
    skipLineEnd();
    return record;
  }

  std::string readPlainField() {
    const std::size_t begin = m_at;
    while (!isAtLineEnd() && !isAt(m_separator))
      ++m_at;
    return std::string(m_text.substr(begin, m_at - begin));
  }

  std::string readQuotedField() {
    const std::size_t firstLine = m_line;
    std::string field;
    for (++m_at; !isAt('"') || m_text.substr(m_at).starts_with("\"\""); ++m_at) {
      if (m_at == m_text.size())
        throw fieldError(m_source, concat("line ", firstLine), "quotes are not closed; close them");
      m_at += isAt('"') ? 1 : 0; // a doubled quote stands for one
      m_line += isAt('\n') ? 1 : 0;
      field += m_text[m_at];
    }
    ++m_at;
    if (!isAtLineEnd() && !isAt(m_separator))
      throw fieldError(m_source, concat("line ", m_line),
                       "text follows closing quotes; double the quotes within a field");
    return field;
  }

  void skipLineEnd() {
    m_at += isAt('\r') ? 1 : 0;
    m_at += isAt('\n') ? 1 : 0;
    ++m_line;
  }

  std::string_view m_text;
  const std::string& m_source;
  char m_separator = ',';
  std::size_t m_at = 0, m_line = 1, m_fields = 0;
};

} // namespace

std::vector<CsvRecord> parseCsv(std::string_view text, const std::string& source) {
  return CsvParser(text, source).parse();
}

std::string formatCsvLine(const std::vector<std::string>& fields) {
  const auto format = [](std::string field) {
    constexpr std::string_view formulaStarts = "=+-@\t";
    if (!field.empty() && formulaStarts.find(field[0]) != formulaStarts.npos &&
        !parseNumber<double>(field))
      field.insert(0, 1, '\'');
    if (field.find_first_of(",;\"\r\n") == field.npos)
      return field;
    return concat('"', replaceAll(field, "\"", "\"\""), '"');
  };
  return join(fields, ",", format) + "\r\n";
}

} // namespace fenestra::core
