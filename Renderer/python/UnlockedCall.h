#pragma once
// Calls of the library without Python's global lock (GIL). The lock guards the count of such calls,
// so that a fork in another thread cannot leave it locked.

#include <pybind11/pybind11.h>

#include <atomic>
#include <chrono>
#include <optional>
#include <thread>

namespace fenestra::python {

/// Releases the lock during its life. Until it has the lock again, the interpreter does not end:
/// that would end the thread inside C++ code.
class UnlockedCall {
public:
  /// While the interpreter ends: throws SystemExit, which ends the thread.
  UnlockedCall() {
    requireLife();
    ++s_count;
    m_release.emplace();
  }
  ~UnlockedCall() {
    m_release.reset();
    --s_count;
  }
  UnlockedCall(const UnlockedCall&) = delete;
  UnlockedCall& operator=(const UnlockedCall&) = delete;

  /// True if all renders have to stop.
  static bool isEnding() { return s_isEnding; }

  /// Throws SystemExit while the interpreter ends. Needs the lock.
  static void requireLife() {
    if (!s_isEnding)
      return;
    PyErr_SetNone(PyExc_SystemExit);
    throw pybind11::error_already_set();
  }

  /// Stops all renders, prevents new calls, and waits for the calls of other threads. For atexit.
  static void endAll() {
    s_isEnding = true;
    while (s_count > 0) {
      const pybind11::gil_scoped_release release;
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
  }

  /// For the child of a fork, in which no other thread exists.
  static void forgetAll() { s_count = 0; }

private:
  inline static int s_count = 0; ///< guarded by Python's lock
  inline static std::atomic<bool> s_isEnding = false;

  std::optional<pybind11::gil_scoped_release> m_release;
};

} // namespace fenestra::python
