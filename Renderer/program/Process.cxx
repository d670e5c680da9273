#include "program/Process.h"

#include "base/Error.h"
#include "io/InputRegistry.h"
#include "io/MessageText.h"
#include "io/Sandbox.h"
#include "io/platform/Folders.h"
#include "io/platform/Streams.h"
#include "io/platform/TempFiles.h"
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

namespace fenestra::core {
namespace {

/// Prints an error message as one line. Does not allocate, since memory may be exhausted.
int reportFailure(int status, std::string_view line, std::string_view advice = {}) {
  static char buffer[8192];
  const std::size_t size = std::min(line.size(), sizeof buffer);
  std::copy_n(line.begin(), size, buffer);
  makeOneLine({buffer, size});
  writeToStandardError("fenestra: error: ");
  writeToStandardError({buffer, size});
  writeToStandardError(advice.empty() ? "" : "; ");
  writeToStandardError(advice);
  writeToStandardError("\n");
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

/// Fails if standard output cannot be written, since printed text is also a result.
int finishOutput(int status) {
  const bool isComplete = std::cout.flush() && std::fflush(stdout) == 0 && !std::ferror(stdout);
  if (isComplete || status != 0 || (isClosedOutputAllowed() && isStandardOutputClosed()))
    return status;
  return reportFailure(outputStatus,
                       "standard output: cannot be written; disk full or pipe closed?");
}

/// Tries again to remove temporary files, and names those that the user has to remove.
int removeTempFiles(int status) {
  removeAllTempFiles();
  try {
    for (const std::filesystem::path& path : remainingTempFiles()) {
      writeToStandardError("fenestra: warning: temporary file cannot be removed: ");
      writeToStandardError(path.native());
      writeToStandardError("; remove it\n");
    }
  } catch (const std::bad_alloc&) {
    writeToStandardError(
        "fenestra: warning: temporary files remain; the next fenestra command removes them\n");
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
