#pragma once
// Libraries that complain on std::cerr do so to no one; what matters becomes an Error.

#include <itkObject.h>

#include <iostream>

namespace fenestra {

/// While one of these lives, std::cerr goes nowhere and ITK's warnings are off.
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
