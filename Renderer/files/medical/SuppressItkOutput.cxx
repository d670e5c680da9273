#include "files/medical/SuppressItkOutput.h"

#include <itkObject.h>

#include <iostream>

namespace fenestra::core {

SuppressItkOutput::SuppressItkOutput() : m_previous(std::cerr.rdbuf(nullptr)) {
  itk::Object::SetGlobalWarningDisplay(false);
}

SuppressItkOutput::~SuppressItkOutput() {
  std::cerr.rdbuf(m_previous);
  std::cerr.clear();
}

} // namespace fenestra::core
