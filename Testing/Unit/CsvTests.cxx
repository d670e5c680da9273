#include "files/formats/Csv.h"

#include "base/Error.h"

#include <gtest/gtest.h>

namespace fenestra::CsvTests {
namespace {

using Fields = std::vector<std::string>;

std::vector<Fields> readFields(const std::string& text) {
  std::vector<Fields> all;
  for (const CsvRecord& record : parseCsv(text, "t.csv"))
    all.push_back(record.fields);
  return all;
}

std::string catchError(const std::string& text) {
  try {
    parseCsv(text, "t.csv");
  } catch (const Error& error) {
    return error.what();
  }
  return "";
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
  EXPECT_EQ(catchError("a,b\n1,\"2\n3\n"), "t.csv: line 2: quotes are not closed; close them");
  EXPECT_EQ(catchError("a\n\"1\"2\n"),
            "t.csv: line 2: text follows closing quotes; double the quotes within a field");
  EXPECT_EQ(catchError(std::string(1'000'001, ',')),
            "t.csv: holds more than 1000000 fields; split it");
}

TEST(Csv, WrittenLinesReadBackUnchanged) {
  const Fields fields = {"a", "1,2", "say \"b\"", "", "two\nlines", "-7.5", "x;y"};
  EXPECT_EQ(readFields(formatCsvLine(fields)), std::vector<Fields>{fields});
  EXPECT_EQ(formatCsvLine({"=1+2", "-x", "-3"}), "'=1+2,'-x,-3\r\n") << "text is never a formula";
}

} // namespace
} // namespace fenestra::CsvTests
