#pragma once
// Memory for one result that the processes of a batch have in common. Each stores its own result
// or reads that of another. Nothing depends on it except time: a miss is no error.

#include "io/platform/Descriptor.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>

namespace fenestra::core {

/// A file in memory without a name, which ends with its last process. The processes that read and
/// write it lock it meanwhile; one that is killed while it writes leaves it empty.
class SharedSlot {
public:
  using Numbers = std::array<double, 2>;

  /// Creates an empty slot, which ChildProcess can pass on.
  SharedSlot();
  /// The slot that this process got from ChildProcess; nullopt: none.
  static std::optional<SharedSlot> findInherited();

  const Descriptor& file() const { return m_file; }

  /// Reads the result of `key` into `bytes`, if the slot has one of this size; nullopt: it has not.
  std::optional<Numbers> read(std::uint64_t key, std::span<char> bytes) const;
  /// Replaces the result. Leaves the slot empty if `bytes` do not fit into an eighth of the
  /// machine's memory.
  void write(std::uint64_t key, const Numbers& numbers, std::span<const char> bytes) const;

private:
  explicit SharedSlot(Descriptor file) : m_file(std::move(file)) {}

  Descriptor m_file;
};

} // namespace fenestra::core
