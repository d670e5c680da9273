#pragma once
// Processes of one mpirun, and what they tell each other. The only sources that know MPI.

#include "base/Stopwatch.h"

#include <cstdint>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace fenestra {

/// Words of a message; their meaning is the sender's and the receiver's.
using Message = std::vector<std::uint64_t>;

struct ReceivedMessage {
  int from = 0; ///< rank
  Message message;
};

/// All methods may be called from any thread.
class Ranks {
public:
  /// Joins the other processes. Throws Error (output) where MPI cannot be used from threads. At
  /// most one object in a process.
  Ranks();
  /// Waits for the other ranks to do the same.
  ~Ranks();
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  int rank() const { return m_rank; }
  int count() const { return m_count; }

  /// Texts of all ranks, in their order, the same everywhere; each rank must call this.
  std::vector<std::string> allGather(const std::string& text);
  /// Gives the bytes of rank 0 to all others; each rank must call this, with as many bytes.
  void broadcast(std::span<char> bytes);
  /// Gives the text of rank 0 to all others.
  void broadcast(std::string& text);

  void send(int to, const Message& message);
  /// Next message, if there is one.
  std::optional<ReceivedMessage> receive();
  /// True if receive() would return a message.
  bool hasMessage();

  /// Ends the processes of all ranks, with a line that names this one.
  [[noreturn]] void abort(std::string_view line, int status);

private:
  std::mutex m_mutex;
  int m_rank = 0, m_count = 1;
};

/// Rests between looks for messages, each an eighth of the time since the last one that was there:
/// looks take next to nothing of a long wait from threads that render, and make a short one hardly
/// longer.
class BackoffPoller {
public:
  /// Counts from now, for a message was there.
  void reset() { m_watch = {}; }
  void wait() const;

private:
  Stopwatch m_watch;
};

} // namespace fenestra
