#pragma once
// Runs a command with one injected fault.

#include "Page.h"

#include <filesystem>
#include <string>
#include <vector>

namespace fenestra::faults {

struct Fault {
  enum class Kind {
    none,
    counting,   ///< no fault; places for faults are counted
    call,       ///< a call that touches files fails with the error `value`
    allocation, ///< an allocation fails
    signal,     ///< the signal `value` arrives at a rename, link, unlink or write
    ignored,    ///< like `signal`, but ignored since the process began
  };
  Kind kind = Kind::none;
  long number = 0; ///< index of the fault's place since `main` began, from 1
  int value = 0;
};

struct Command {
  std::vector<std::string> arguments; ///< the executable first
  std::filesystem::path folder, temporary;
  std::filesystem::path preload; ///< the library
};

/// Result of a run.
struct Outcome {
  int status = -1;    ///< exit status; -1 where a signal ended the process
  int signal = 0;     ///< signal that ended the process; 0: none
  bool hung = false;  ///< killed at the time limit
  std::string errors; ///< standard error
  std::string place;  ///< call that met the fault; empty: none
  long calls = 0, commits = 0, allocations = 0; ///< numbers of each; calls only if traced
  long peakKilobytes = 0;                       ///< of resident memory
  std::vector<Frame> frames;                    ///< stack at a crash, innermost first
};

/// True if this machine and user permit tracing.
bool canTrace();

/// Runs a command to its end. Safe to call from several threads.
Outcome run(const Command& command, const Fault& fault);

} // namespace fenestra::faults
