#include "io/HostProcess.h"

#include <unistd.h>

namespace fenestra::core {

bool isForkedHost() {
  static const pid_t first = ::getpid();
  return ::getpid() != first;
}

} // namespace fenestra::core
