// Text from files as it appears in messages.

#include "base/Text.h"
#include "io/MessageText.h"

#include <gtest/gtest.h>

namespace fenestra::core::MessageTextTests {
namespace {

TEST(MessageText, IsValidUtf8OnOneLine) {
  EXPECT_EQ(toOneLine("Schädel, 頭, 🦴"), "Schädel, 頭, 🦴");
  EXPECT_EQ(toOneLine(std::string("a\nb\0c\x7f"
                                  "d",
                                  7)),
            "a b c d");
  const std::pair<const char*, const char*> bad[] = {
      {"Sch\xe4"
       "del",
       "Sch?del"},                  // Latin-1
      {"\x80\xbf", "??"},           // continuation bytes
      {"\xc0\xaf", "??"},           // overlong
      {"\xe0\x9f\xbf", "???"},      // overlong
      {"\xf0\x8f\xbf\xbf", "????"}, // overlong
      {"\xed\xa0\x80", "???"},      // surrogate
      {"\xf4\x90\x80\x80", "????"}, // beyond the last code point
      {"\xff\xfe", "??"},           // never valid
      {"\xe9\xa0", "??"},           // truncated
      {"\xf0\x9f\xa6", "???"},      // truncated
      {"\xc3\n", "? "},             // truncated by a control character
  };
  for (const auto& [text, expected] : bad)
    EXPECT_EQ(toOneLine(text), expected);
}

TEST(MessageText, IsTruncatedBetweenCharacters) {
  const std::string text = std::string(79, 'x') + "ä";
  EXPECT_EQ(sanitize(text), std::string(79, 'x'));
  EXPECT_EQ(sanitize(std::string(78, 'x') + "ä"), std::string(78, 'x') + "ä");
  EXPECT_EQ(sanitize(std::string(200, '\x80')), std::string(77, '?'));
}

TEST(MessageText, ReplaceAllReplacesEveryOccurrence) {
  EXPECT_EQ(replaceAll("aXXbX", "X", "yy"), "ayyyybyy");
  EXPECT_EQ(replaceAll("abc", "X", "y"), "abc");
  EXPECT_EQ(replaceAll("%2525", "%25", "%"), "%25");
}

} // namespace
} // namespace fenestra::core::MessageTextTests
