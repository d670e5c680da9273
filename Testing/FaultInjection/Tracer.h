#pragma once
// Runs a command with one injected fault, by ptrace and seccomp.

#include "Page.h"

#include <filesystem>
#include <string>
#include <vector>

namespace fenestra::core::faults {

struct Fault {
  enum class Kind {
    none,
    counting,   ///< no fault: counts the calls and allocations that could fail
    call,       ///< a call on a file fails with the error `value`
    allocation, ///< an allocation fails
    signal,     ///< the signal `value` is sent before a rename, link, unlink or write
    ignored,    ///< like `signal`, but the process starts with the signal ignored
  };
  Kind kind = Kind::none;
  long number = 0; ///< number of the place since the start of `main`, from 1
  int value = 0;
};

struct Command {
  std::vector<std::string> arguments; ///< executable and arguments
  std::filesystem::path folder, temporary;
  std::filesystem::path preload; ///< path of the preloaded library
};

/// Result of a run.
struct Outcome {
  int status = -1;          ///< exit status; -1 if a signal ended the process
  int signal = 0;           ///< signal that ended the process; 0: none
  bool hasTimedOut = false; ///< killed at the limit of processor time, or because it hangs
  std::string errors;       ///< standard error
  std::string place;        ///< call at which the fault was injected; empty: none
  long calls = 0, changes = 0, allocations = 0; ///< counts; calls and changes only if traced
  long peakKilobytes = 0;                       ///< maximum resident memory
  std::vector<Frame> frames;                    ///< stack at a crash, innermost first
};

/// True if this process can use ptrace and seccomp.
bool canTrace();

/// Runs a command until it ends. Thread-safe.
Outcome run(const Command& command, const Fault& fault);

} // namespace fenestra::core::faults
