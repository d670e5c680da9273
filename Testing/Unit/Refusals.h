#pragma once
// Expectations on files that a reader must reject.

#include "ErrorChecks.h"
#include "TemporaryFolder.h"

#include <filesystem>
#include <string>

namespace fenestra::core {

/// Expects an Error (input) whose subject begins with the path; `expected`: as for expectMessage.
/// Nothing may be printed to standard error.
template <typename Call>
void expectRefused(const std::filesystem::path& path, const std::string& expected, Call&& call) {
  ::testing::internal::CaptureStderr();
  const Error error = catchError(ErrorKind::input, expected, call);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "") << path;
  EXPECT_EQ(error.message().text().find(path.string() + ": "), 0u)
      << error.what() << "\n"
      << readBytes(path).substr(0, 300);
}

} // namespace fenestra::core
