#include "base/PhysicalMemory.h"

#include <unistd.h>

namespace fenestra::core {

double physicalMemory() {
  return static_cast<double>(::sysconf(_SC_PHYS_PAGES)) *
         static_cast<double>(::sysconf(_SC_PAGESIZE));
}

} // namespace fenestra::core
