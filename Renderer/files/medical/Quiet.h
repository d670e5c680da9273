#pragma once
// Silence for libraries that complain on std::cerr; their failures become Errors.

#include <streambuf>

namespace fenestra {

/// Discards std::cerr during the object's life, and turns ITK's warnings off for good.
class Quiet {
public:
  Quiet();
  ~Quiet();
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;

private:
  std::streambuf* m_before;
};

} // namespace fenestra
