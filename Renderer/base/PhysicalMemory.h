#pragma once

namespace fenestra {

/// Bytes of memory that the machine has.
double physicalMemory();

} // namespace fenestra
