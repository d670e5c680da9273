#include "files/formats/Csv.h"

#include "ErrorChecks.h"

#include <gtest/gtest.h>

namespace fenestra::core::CsvTests {
namespace {

using Fields = std::vector<std::string>;

std::vector<Fields> readFields(const std::string& text) {
  std::vector<Fields> all;
  for (const CsvRecord& record : parseCsv(text, "t.csv"))
    all.push_back(record.fields);
  return all;
}

void expectRefusal(const std::string& text, const std::string& expected) {
  catchError(ErrorKind::input, expected, [&] { parseCsv(text, "t.csv"); });
}

TEST(Csv, ReadsEveryVariantOfTheSameTable) {
  const std::vector<Fields> expected = {{"name", "input"}, {"a", "b c"}, {"d", ""}};
  for (const char* text :
       {"name,input\na,b c\nd,\n", "name,input\r\na,b c\r\nd,", "name,input\ra,b c\rd,\r",
        "\xef\xbb\xbfname,input\n\"a\",\"b c\"\nd,\"\"\n", "name;input\na;b c\nd;\n",
        "\n\nname,input\n  \na,b c\n\nd,\n\n"})
    EXPECT_EQ(readFields(text), expected) << text;
  EXPECT_EQ(readFields(""), std::vector<Fields>());
}

TEST(Csv, QuotedFieldsCanContainAnything) {
  EXPECT_EQ(readFields("a,\"1,2\"\n\"x\r\ny\",\"say \"\"b\"\"\"\nn,5\" disk\n"),
            (std::vector<Fields>{{"a", "1,2"}, {"x\r\ny", "say \"b\""}, {"n", "5\" disk"}}));
  const auto records = parseCsv("a\n\"1\n2\n3\"\nb\n", "t.csv");
  EXPECT_EQ(records[1].line, 2U);
  EXPECT_EQ(records[2].line, 5U) << "line breaks within quotes count";
}

TEST(Csv, ErrorsNameTheLine) {
  expectRefusal("a,b\n1,\"2\n3\n", "invalid-field: t.csv: line 2");
  expectRefusal("a\n\"1\"2\n", "invalid-field: t.csv: line 2");
  expectRefusal(std::string(1'000'001, ','), "limit-exceeded: t.csv | 1000000");
}

TEST(Csv, WrittenLinesReadBackUnchanged) {
  const Fields fields = {"a", "1,2", "say \"b\"", "", "two\nlines", "-7.5", "x;y"};
  EXPECT_EQ(readFields(formatCsvLine(fields)), std::vector<Fields>{fields});
  EXPECT_EQ(formatCsvLine({"=1+2", "-x", "-3"}), "'=1+2,'-x,-3\r\n") << "text is never a formula";
}

} // namespace
} // namespace fenestra::core::CsvTests
