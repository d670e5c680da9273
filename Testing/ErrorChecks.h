#pragma once
// Checks of errors and warnings by code, subject and stated facts, never by wording: a reworded
// message breaks only ErrorAdviceTests, which quotes some.

#include "base/Error.h"

#include <gtest/gtest.h>

#include <string>

namespace fenestra::core {

/// Expects one line with the properties that `expected` lists:
///
///     [CODE] [": " PLACE] {" | " FACT}
///
/// PLACE: end of the subject, such as a field of the file, or the field with which the detail
/// begins. FACT: a name or number of the input that the message must repeat.
inline void expectMessage(const Message& message, const std::string& expected) {
  const std::string line = message.text();
  EXPECT_EQ(line.find('\n'), std::string::npos) << line;
  if (expected.empty())
    return;
  std::size_t end = expected.find(" | ");
  const std::string head = expected.substr(0, end);
  const std::size_t colon = head.find(": ");
  if (colon != 0) {
    EXPECT_EQ(toString(message.code), head.substr(0, colon)) << line;
  }
  if (colon != std::string::npos) {
    EXPECT_NE(line.find(head.substr(colon + 2) + ": "), std::string::npos)
        << line << "\nexpected: " << expected;
  }
  while (end != std::string::npos) {
    const std::size_t begin = end + 3;
    end = expected.find(" | ", begin);
    const std::string fact = expected.substr(begin, end - begin);
    EXPECT_NE(line.find(fact), std::string::npos) << line << "\nexpected: " << fact;
  }
}

/// Expects that `action` throws an Error of this kind (see expectMessage), and returns it.
template <typename Action>
Error catchError(ErrorKind kind, const std::string& expected, Action&& action) {
  try {
    action();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), kind) << error.what();
    expectMessage(error.message(), expected);
    return error;
  }
  ADD_FAILURE() << "no error was thrown; expected: " << expected;
  return {kind, {}};
}

} // namespace fenestra::core
