#pragma once
// Silences ITK, which prints warnings to std::cerr; its failures are thrown as Errors.

#include <streambuf>

namespace fenestra::core {

/// Discards std::cerr during its lifetime and disables ITK's warnings for the rest of the process.
class SuppressItkOutput {
public:
  SuppressItkOutput();
  ~SuppressItkOutput();
  SuppressItkOutput(const SuppressItkOutput&) = delete;
  SuppressItkOutput& operator=(const SuppressItkOutput&) = delete;

private:
  std::streambuf* m_previous;
};

} // namespace fenestra::core
