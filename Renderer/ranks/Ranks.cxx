#include "ranks/Ranks.h"

#include "base/Error.h"
#include "io/MessageText.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <iostream>
#include <thread>

#include <mpi.h>

namespace fenestra::core {
namespace {

constexpr int messageTag = 0; ///< of all messages

} // namespace

Ranks::Ranks() {
  int level = MPI_THREAD_SINGLE;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &level);
  if (level < MPI_THREAD_SERIALIZED)
    throw outputError(ErrorCode::internal, "MPI",
                      "this library does not support threads; use another one");
  MPI_Comm_rank(MPI_COMM_WORLD, &m_rank);
  MPI_Comm_size(MPI_COMM_WORLD, &m_count);
}

Ranks::~Ranks() {
  MPI_Finalize();
}

std::vector<std::string> Ranks::allGather(const std::string& text) {
  constexpr std::size_t maxBytes = 512;
  std::vector<char> mine(maxBytes), all(maxBytes * static_cast<std::size_t>(m_count));
  std::copy_n(text.begin(), std::min(text.size(), maxBytes - 1), mine.begin());
  const std::lock_guard lock(m_mutex);
  MPI_Allgather(mine.data(), maxBytes, MPI_CHAR, all.data(), maxBytes, MPI_CHAR, MPI_COMM_WORLD);
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < all.size(); i += maxBytes)
    texts.emplace_back(&all[i]);
  return texts;
}

void Ranks::broadcast(std::span<char> bytes) {
  const std::lock_guard lock(m_mutex);
  MPI_Bcast(bytes.data(), static_cast<int>(bytes.size()), MPI_CHAR, 0, MPI_COMM_WORLD);
}

void Ranks::broadcast(std::string& text) {
  std::uint64_t size = text.size();
  broadcast({reinterpret_cast<char*>(&size), sizeof size});
  text.resize(size);
  broadcast(std::span(text));
}

void Ranks::send(int to, const RankMessage& message) {
  const std::lock_guard lock(m_mutex);
  MPI_Send(message.data(), static_cast<int>(message.size()), MPI_UINT64_T, to, messageTag,
           MPI_COMM_WORLD);
}

std::optional<ReceivedMessage> Ranks::receive() {
  const std::lock_guard lock(m_mutex);
  int isPending = 0;
  MPI_Status status = {};
  MPI_Iprobe(MPI_ANY_SOURCE, messageTag, MPI_COMM_WORLD, &isPending, &status);
  if (!isPending)
    return std::nullopt;
  int size = 0;
  MPI_Get_count(&status, MPI_UINT64_T, &size);
  ReceivedMessage received{status.MPI_SOURCE, RankMessage(static_cast<std::size_t>(size))};
  MPI_Recv(received.message.data(), size, MPI_UINT64_T, received.from, messageTag, MPI_COMM_WORLD,
           MPI_STATUS_IGNORE);
  return received;
}

bool Ranks::hasMessage() {
  const std::lock_guard lock(m_mutex);
  int isPending = 0;
  MPI_Iprobe(MPI_ANY_SOURCE, messageTag, MPI_COMM_WORLD, &isPending, MPI_STATUS_IGNORE);
  return isPending;
}

void Ranks::abort(std::string_view line, int status) {
  std::cerr << toOneLine(concat("fenestra: error: rank ", m_rank, ": ", line)) << std::endl;
  MPI_Abort(MPI_COMM_WORLD, status); // without the lock: other threads may be inside a call
  std::_Exit(status);
}

void BackoffPoller::wait() const {
  constexpr double minSeconds = 0.0003, maxSeconds = 0.005;
  std::this_thread::sleep_for(
      std::chrono::duration<double>(std::clamp(m_watch.seconds() / 8.0, minSeconds, maxSeconds)));
}

} // namespace fenestra::core
