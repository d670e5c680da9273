#pragma once
// Runs a command and makes one thing go wrong in it.

#include "Page.h"

#include <filesystem>
#include <string>
#include <vector>

namespace fenestra::faults {

struct Fault {
  enum class Kind {
    none,
    counting,   ///< none, but places for faults are counted
    call,       ///< a call that touches files fails with the error `value`
    allocation, ///< one fails
    signal,     ///< `value` comes at a rename, link, unlink or write
    ignored,    ///< the same, where it was ignored when the process began
  };
  Kind kind = Kind::none;
  long number = 0; ///< which one of its places since `main` began, from 1
  int value = 0;
};

struct Command {
  std::vector<std::string> words; ///< the executable first
  std::filesystem::path folder, temporary;
  std::filesystem::path preload; ///< the library
};

/// What a run came to.
struct Outcome {
  int status = -1;    ///< exit status; -1 where a signal ended the process
  int signal = 0;     ///< that did
  bool hung = false;  ///< and was killed
  std::string errors; ///< standard error
  std::string place;  ///< the call that the fault met; empty where it met none
  long calls = 0, commits = 0, allocations = 0; ///< how many there were; calls where it was traced
  long peakKilobytes = 0;                       ///< of resident memory
  std::vector<Frame> frames; ///< where it died of a fault of its own, innermost first
};

/// Whether this machine, and whoever runs this, may do so.
bool canTrace();

/// Runs it to its end. From several threads at a time, if need be.
Outcome run(const Command& command, const Fault& fault);

} // namespace fenestra::faults
