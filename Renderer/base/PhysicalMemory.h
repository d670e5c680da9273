#pragma once

namespace fenestra::core {

/// Bytes of memory that the machine has.
double physicalMemory();

} // namespace fenestra::core
