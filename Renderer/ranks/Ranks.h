#pragma once
// Processes of one mpirun and their messages. No other sources use MPI.

#include "base/Stopwatch.h"

#include <cstdint>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace fenestra::core {

/// Words of a message; sender and receiver agree on their meaning.
using RankMessage = std::vector<std::uint64_t>;

struct ReceivedMessage {
  int from = 0; ///< rank
  RankMessage message;
};

/// All methods are thread-safe.
class Ranks {
public:
  /// Initializes MPI. Throws Error (output) if MPI cannot be used from threads. At most one object
  /// per process.
  Ranks();
  /// Waits for the destructors of the other ranks.
  ~Ranks();
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  int rank() const { return m_rank; }
  int count() const { return m_count; }

  /// Texts of all ranks in rank order, the same on every rank. Each rank must call this.
  std::vector<std::string> allGather(const std::string& text);
  /// Sends the bytes of rank 0 to all others. Each rank must call this, with as many bytes.
  void broadcast(std::span<char> bytes);
  /// Sends the text of rank 0 to all others. Each rank must call this.
  void broadcast(std::string& text);

  void send(int to, const RankMessage& message);
  /// Next message, if any.
  std::optional<ReceivedMessage> receive();
  /// True if receive() would return a message.
  bool hasMessage();

  /// Ends the processes of all ranks, with a message that names this one.
  [[noreturn]] void abort(std::string_view line, int status);

private:
  std::mutex m_mutex;
  int m_rank = 0, m_count = 1;
};

/// Waits between polls for messages: an eighth of the time since the last message, within limits.
/// Rendering threads lose little time to polls during long waits (polls every 0.3 ms took a tenth
/// of rank 0's time), and short waits are hardly prolonged.
class BackoffPoller {
public:
  /// Restarts the time, after a message.
  void reset() { m_watch = {}; }
  void wait() const;

private:
  Stopwatch m_watch;
};

} // namespace fenestra::core
