#pragma once
// Silence for libraries that complain on std::cerr; their failures become Errors.

#include <streambuf>

namespace fenestra {

/// Discards std::cerr during the object's life, and turns ITK's warnings off for good.
class SuppressItkOutput {
public:
  SuppressItkOutput();
  ~SuppressItkOutput();
  SuppressItkOutput(const SuppressItkOutput&) = delete;
  SuppressItkOutput& operator=(const SuppressItkOutput&) = delete;

private:
  std::streambuf* m_previous;
};

} // namespace fenestra
