#include "files/medical/SuppressItkOutput.h"

#include <itkObject.h>

#include <iostream>
#include <mutex>
#include <streambuf>

namespace fenestra::core {
namespace {

std::mutex mutex;
int count = 0; ///< number of objects
std::streambuf* previous = nullptr;
bool hadWarnings = false;

} // namespace

SuppressItkOutput::SuppressItkOutput() {
  const std::lock_guard lock(mutex);
  if (count++ > 0)
    return;
  previous = std::cerr.rdbuf(nullptr);
  hadWarnings = itk::Object::GetGlobalWarningDisplay();
  itk::Object::SetGlobalWarningDisplay(false);
}

SuppressItkOutput::~SuppressItkOutput() {
  const std::lock_guard lock(mutex);
  if (--count > 0)
    return;
  itk::Object::SetGlobalWarningDisplay(hadWarnings);
  std::cerr.rdbuf(previous);
  std::cerr.clear();
}

} // namespace fenestra::core
