#pragma once
// Silence for libraries that complain on std::cerr; their failures become Errors.

#include <itkObject.h>

#include <iostream>

namespace fenestra {

/// Discards std::cerr during the object's life, and turns ITK's warnings off for good.
class Quiet {
public:
  Quiet() : m_before(std::cerr.rdbuf(nullptr)) { itk::Object::SetGlobalWarningDisplay(false); }
  ~Quiet() {
    std::cerr.rdbuf(m_before);
    std::cerr.clear();
  }
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;

private:
  std::streambuf* m_before;
};

} // namespace fenestra
