#include "program/Process.h"

#include "base/Error.h"
#include "io/Folders.h"
#include "io/InputRegistry.h"
#include "io/MessageText.h"
#include "io/Sandbox.h"
#include "io/TempFiles.h"
#include "program/ErrorAdvice.h"
#include "program/Messages.h"
#include "program/Stop.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <new>
#include <string>
#include <string_view>

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

namespace fenestra::core {
namespace {

void print(std::string_view text) {
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, text.data(), text.size());
}

/// Prints an error message as one line. Does not allocate, since memory may be exhausted.
int reportFailure(int status, std::string_view line, std::string_view advice = {}) {
  static char buffer[8192];
  const std::size_t size = std::min(line.size(), sizeof buffer);
  std::copy_n(line.begin(), size, buffer);
  makeOneLine({buffer, size});
  print("fenestra: error: ");
  print({buffer, size});
  print(advice.empty() ? "" : "; ");
  print(advice);
  print("\n");
  return status;
}

constexpr int outputStatus = exitStatus(ErrorKind::output);

int run(int argc, char** argv, DispatchFunction dispatch) {
  try {
    return dispatch(argc, argv);
  } catch (const Error& error) {
    return reportFailure(exitStatus(error.kind()), error.what(), findAdvice(error.message().code));
  } catch (const std::bad_alloc&) {
    return reportFailure(outputStatus, "memory: is exhausted; use a smaller volume or image");
  } catch (const std::exception& error) {
    return reportFailure(outputStatus, error.what());
  }
}

/// Opens closed standard streams, so that no file gets their descriptors. Reads find an empty file;
/// writes to /dev/full fail, as they would have.
void openStandardStreams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (::fcntl(stream, F_GETFD) < 0)
      ::open(stream == STDIN_FILENO ? "/dev/null" : "/dev/full", O_RDWR); // gets this descriptor
}

/// True if standard output is a pipe without a reader.
bool isOutputClosed() {
  pollfd output = {STDOUT_FILENO, POLLOUT, 0};
  return ::poll(&output, 1, 0) > 0 && (output.revents & POLLERR) != 0;
}

/// Fails if standard output cannot be written, since printed text is also a result.
int finishOutput(int status) {
  const bool isComplete = std::cout.flush() && std::fflush(stdout) == 0 && !std::ferror(stdout);
  if (isComplete || status != 0 || (isClosedOutputAllowed() && isOutputClosed()))
    return status;
  return reportFailure(outputStatus,
                       "standard output: cannot be written; disk full or pipe closed?");
}

/// Tries again to remove temporary files, and names those that the user has to remove.
int removeTempFiles(int status) {
  removeAllTempFiles();
  try {
    for (const std::filesystem::path& path : remainingTempFiles()) {
      print("fenestra: warning: temporary file cannot be removed: ");
      print(path.native());
      print("; remove it\n");
    }
  } catch (const std::bad_alloc&) {
    print("fenestra: warning: temporary files remain; the next fenestra command removes them\n");
  }
  return status;
}

} // namespace

void runProcess(int argc, char** argv, DispatchFunction dispatch) {
  openStandardStreams();
  serveSandbox(argc, argv); // the child does not return
  installStopHandlers();
  removeStaleFolders();
  const InputRegistry registry;
  const int status = removeTempFiles(finishOutput(run(argc, argv, dispatch)));
  // All results are written. Destructors of the libraries' static objects are useless, take a tenth
  // of a short command's time, and print messages if memory is exhausted (HDF5).
  std::_Exit(status == 0 && isStopRequested() ? stopStatus() : status);
}

} // namespace fenestra::core
