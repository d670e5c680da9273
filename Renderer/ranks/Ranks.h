#pragma once
// Processes of one mpirun and what they exchange. No other sources use MPI.

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <thread>
#include <type_traits>
#include <vector>

namespace fenestra::core {

/// All methods are thread-safe. Except for abort(), each rank must call them, in the same order.
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

  /// Texts of all ranks in rank order, the same on every rank.
  std::vector<std::string> allGather(const std::string& text) const;
  /// Sends the values of rank `root` to all others, which pass as many.
  template <typename T>
  void broadcast(std::span<T> values, int root = 0) const {
    static_assert(std::is_trivially_copyable_v<T>);
    broadcastBytes({reinterpret_cast<char*>(values.data()), values.size_bytes()}, root);
  }
  /// Sends the text of rank 0 to all others.
  void broadcast(std::string& text) const;
  /// Replaces each value by the smallest of all ranks. Waits for the others with hardly any load.
  void minimize(std::span<std::uint64_t> values) const;

  /// Ends the processes of all ranks, with a message that names this one unless it is rank 0.
  [[noreturn]] void abort(std::string_view line, int status) const;

private:
  void broadcastBytes(std::span<char> bytes, int root) const;

  int m_rank = 0, m_count = 1;
};

/// A thread that passes a requested stop (program/Stop.h) on to all ranks, each of which must start
/// one. Its destructor waits for those of the other ranks.
[[nodiscard]] std::jthread relayStops();

} // namespace fenestra::core
