#pragma once
// Expectations on files that a reader must reject.

#include "TemporaryFolder.h"
#include "base/Error.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

namespace fenestra {

/// Expects an Error (input): one line that begins with the path and contains `text`. Nothing may be
/// printed to standard error.
template <typename Call>
void expectRefused(const std::filesystem::path& path, const std::string& text, Call&& call) {
  ::testing::internal::CaptureStderr();
  std::string line = "(no error)";
  try {
    call();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    line = error.what();
  } catch (const std::exception& error) {
    line = std::string("(another exception) ") + error.what();
  }
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "") << path;
  EXPECT_EQ(line.find(path.string() + ": "), 0u) << line << "\n" << readBytes(path).substr(0, 300);
  EXPECT_NE(line.find(text), std::string::npos) << line;
  EXPECT_EQ(line.find('\n'), std::string::npos) << line;
}

} // namespace fenestra
