#include "io/Sandbox.h"

#include "base/Error.h"
#include "io/ReaderProgram.h"
#include "io/platform/SelfExec.h"
#include "io/platform/SystemErrors.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <stdexcept>
#include <utility>

namespace fenestra::core {
namespace {

constexpr const char* subcommand = "read-sandboxed"; // first argument of a child; internal
constexpr std::uint64_t maxRequestBytes = 1 << 16;   // bytes; fits into a socket's buffer

// ---- the child

bool servesSandbox = false; ///< main has called serveSandbox
bool isChild = false;       ///< this process is a child
thread_local bool readsInProcess = false;

/// All jobs of this program.
std::vector<const SandboxJob*>& registeredJobs() {
  static std::vector<const SandboxJob*> jobs;
  return jobs;
}

[[noreturn]] void serveRequests(const SandboxJob& job) {
  isChild = true;
  const SandboxJob::Handler handler = job.handler;
  while (const auto request = receiveFromParent(maxRequestBytes)) {
    limitCpuTime(job.limits.seconds);
    std::string reply;
    try {
      reply = handler(*request);
    } catch (...) { // the parent reports the error
      reply.clear();
    }
    if (!sendToParent(reply))
      break;
  }
  std::_Exit(0);
}

// ---- starting a child

/// Throws Error (output) for an error code of SandboxProcess::start.
void checkStart(int failed, const std::filesystem::path& program) {
  if (failed == EACCES || failed == ENOEXEC)
    throw outputError(ErrorCode::unreadableFile, program,
                      "cannot be executed: ", systemMessage(failed), "; install it again");
  if (failed != 0)
    throw outputError(ErrorCode::outOfMemory, "memory",
                      "cannot start a process to read files; close other programs");
}

/// Receives the child's build. Throws Error (output) unless it is this one.
void checkBuild(SandboxProcess& child, const std::filesystem::path& program) {
  constexpr std::chrono::seconds maxTime(60); // to load its libraries from a slow disk
  constexpr std::uint64_t maxBytes = 256;
  const auto build = child.receive(maxBytes, maxTime);
  if (!build)
    throw outputError(ErrorCode::outOfMemory, program,
                      "ended before it could read a file; close other programs, or install it "
                      "again");
  if (*build != readerBuild)
    throw outputError(ErrorCode::invalidFile, program,
                      "is of another build than this library; install both together");
}

} // namespace

SandboxJob::SandboxJob(std::string nameIn, Handler handlerIn, SandboxLimits limitsIn)
    : name(std::move(nameIn)), handler(std::move(handlerIn)), limits(limitsIn) {
  registeredJobs().push_back(this);
}

void SandboxedReader::start() {
  std::vector<std::string> arguments = {subcommand, m_job.name};
  std::filesystem::path program = selfExecutable;
  if (servesSandbox) {
    arguments = makeSelfArguments(std::move(arguments));
  } else {
    program = findReaderProgram();
    arguments.insert(arguments.begin(), readerName);
  }
  try {
    checkStart(m_child.start(program, std::move(arguments)), program);
    checkBuild(m_child, program);
  } catch (...) {
    m_child.end();
    throw;
  }
}

std::optional<std::string> SandboxedReader::request(const std::string& message,
                                                    std::uint64_t maxBytes) {
  if (message.size() > maxRequestBytes)
    return std::nullopt;
  if (readsInProcess)
    return handleHere(message, maxBytes);
  if (!m_child.isOwn()) {
    m_child.end();
    start();
  }
  constexpr unsigned wallClockFactor = 3;
  std::optional<std::string> reply;
  if (m_child.send(message))
    reply = m_child.receive(maxBytes, std::chrono::seconds(wallClockFactor * m_job.limits.seconds));
  if (!reply)
    m_child.end();
  return reply;
}

std::optional<std::string> SandboxedReader::handleHere(const std::string& message,
                                                       std::uint64_t maxBytes) {
  static std::mutex mutex; // the libraries have global state, and HDF5 no locks
  const std::lock_guard lock(mutex);
  if (!m_handler)
    m_handler = m_job.handler;
  try {
    std::string reply = m_handler(message);
    return reply.size() > maxBytes ? std::nullopt : std::optional(std::move(reply));
  } catch (...) { // the caller reports the error
    return "";
  }
}

InProcessReading::InProcessReading() : m_previous(std::exchange(readsInProcess, true)) {}

InProcessReading::~InProcessReading() {
  readsInProcess = m_previous;
}

std::string ReplyReader::text() {
  const auto take = [this](std::uint64_t size) {
    if (size > m_bytes.size())
      throw std::runtime_error("reply is truncated");
    std::string taken(m_bytes.substr(0, static_cast<std::size_t>(size)));
    m_bytes.remove_prefix(taken.size());
    return taken;
  };
  std::uint64_t size = 0;
  std::memcpy(&size, take(sizeof size).data(), sizeof size);
  return take(size);
}

std::vector<double> ReplyReader::numbers() {
  const std::string bytes = text();
  std::vector<double> numbers(bytes.size() / sizeof(double));
  if (bytes.size() != numbers.size() * sizeof(double))
    throw std::runtime_error("reply ends within a number");
  std::ranges::copy(bytes, reinterpret_cast<char*>(numbers.data()));
  if (!std::ranges::all_of(numbers, [](double x) { return std::isfinite(x); }))
    throw std::runtime_error("reply contains a number that is not finite");
  return numbers;
}

void limitMemory(std::uint64_t bytes) {
  if (isChild)
    limitAddressSpace(bytes);
}

void serveSandbox(int argc, char** argv) {
  servesSandbox = true;
  if (argc != 4 || std::string_view(argv[1]) != subcommand)
    return;
  const auto job =
      std::ranges::find(registeredJobs(), std::string_view(argv[2]), &SandboxJob::name);
  if (job == registeredJobs().end())
    sendToParent(""); // of another build: the parent has this job
  else if (confineProcess((*job)->limits.bytes, argv[3]) && sendToParent(readerBuild))
    serveRequests(**job);
  std::_Exit(1);
}

} // namespace fenestra::core
