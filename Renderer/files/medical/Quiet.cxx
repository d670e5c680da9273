#include "files/medical/Quiet.h"

#include <itkObject.h>

#include <iostream>

namespace fenestra {

Quiet::Quiet() : m_before(std::cerr.rdbuf(nullptr)) {
  itk::Object::SetGlobalWarningDisplay(false);
}

Quiet::~Quiet() {
  std::cerr.rdbuf(m_before);
  std::cerr.clear();
}

} // namespace fenestra
