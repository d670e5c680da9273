#include "ranks/Ranks.h"

#include "base/Error.h"
#include "base/Stopwatch.h"
#include "io/MessageText.h"
#include "io/platform/TempFiles.h"
#include "program/Stop.h"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <iostream>
#include <mutex>

#include <mpi.h>

namespace fenestra::core {
namespace {

std::mutex mpiMutex; ///< only one thread at a time may use MPI
MPI_Comm stopRanks;  ///< all ranks; for relayStops(), whose calls have an order of their own

/// Ranks::minimize(). Polls, so that other threads can use MPI meanwhile and those that render lose
/// little time: after an eighth of the time waited so far, within limits (polls every 0.3 ms took a
/// tenth of the time).
void minimizeAmong(MPI_Comm ranks, std::span<std::uint64_t> values) {
  constexpr double minSeconds = 0.0003, maxSeconds = 0.005;
  MPI_Request request = MPI_REQUEST_NULL;
  {
    const std::lock_guard lock(mpiMutex);
    MPI_Iallreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), MPI_UINT64_T,
                   MPI_MIN, ranks, &request);
  }
  for (const Stopwatch watch;;) {
    {
      const std::lock_guard lock(mpiMutex);
      int isDone = 0;
      MPI_Test(&request, &isDone, MPI_STATUS_IGNORE);
      if (isDone)
        return;
    }
    std::this_thread::sleep_for(
        std::chrono::duration<double>(std::clamp(watch.seconds() / 8.0, minSeconds, maxSeconds)));
  }
}

} // namespace

Ranks::Ranks() {
  int level = MPI_THREAD_SINGLE;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &level);
  if (level < MPI_THREAD_SERIALIZED)
    throw outputError(ErrorCode::internal, "MPI",
                      "this library does not support threads; use another one");
  MPI_Comm_rank(MPI_COMM_WORLD, &m_rank);
  MPI_Comm_size(MPI_COMM_WORLD, &m_count);
  MPI_Comm_dup(MPI_COMM_WORLD, &stopRanks);
}

Ranks::~Ranks() {
  MPI_Comm_free(&stopRanks);
  MPI_Finalize();
}

std::vector<std::string> Ranks::allGather(const std::string& text) const {
  constexpr std::size_t maxBytes = 512;
  std::vector<char> mine(maxBytes), all(maxBytes * static_cast<std::size_t>(m_count));
  std::copy_n(text.begin(), std::min(text.size(), maxBytes - 1), mine.begin());
  const std::lock_guard lock(mpiMutex);
  MPI_Allgather(mine.data(), maxBytes, MPI_CHAR, all.data(), maxBytes, MPI_CHAR, MPI_COMM_WORLD);
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < all.size(); i += maxBytes)
    texts.emplace_back(&all[i]);
  return texts;
}

void Ranks::broadcastBytes(std::span<char> bytes, int root) const {
  constexpr std::size_t maxBytes = 1 << 30; // MPI counts in int
  while (!bytes.empty()) {
    const std::span block = bytes.first(std::min(bytes.size(), maxBytes));
    const std::lock_guard lock(mpiMutex);
    MPI_Bcast(block.data(), static_cast<int>(block.size()), MPI_CHAR, root, MPI_COMM_WORLD);
    bytes = bytes.subspan(block.size());
  }
}

void Ranks::broadcast(std::string& text) const {
  std::uint64_t size = text.size();
  broadcast(std::span(&size, 1));
  text.resize(size);
  broadcast(std::span(text));
}

void Ranks::minimize(std::span<std::uint64_t> values) const {
  minimizeAmong(MPI_COMM_WORLD, values);
}

void Ranks::abort(std::string_view line, int status) const {
  const std::string name = m_rank > 0 ? concat("rank ", m_rank, ": ") : "";
  std::cerr << toOneLine(concat("fenestra: error: ", name, line)) << std::endl;
  removeAllTempFiles();
  MPI_Abort(MPI_COMM_WORLD, status); // without the mutex: other threads may be inside a call
  std::_Exit(status);
}

std::jthread relayStops() {
  return std::jthread([](const std::stop_token& end) {
    for (bool isLast = false; !isLast;) {
      std::uint64_t states[] = {!isStopRequested(), end.stop_requested()};
      minimizeAmong(stopRanks, states);
      if (states[0] == 0 && !isStopRequested()) // another rank was stopped
        std::raise(SIGTERM);
      isLast = states[1] != 0; // all ranks end
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  });
}

} // namespace fenestra::core
