#pragma once

#include <cstddef>
#include <functional>

namespace fenestra::core {

/// Calls work(begin, end) for ranges that make up [0, count), each of at least `grain`, in any
/// order and possibly at the same time.
using ParallelLoop =
    std::function<void(std::size_t count, std::size_t grain,
                       const std::function<void(std::size_t begin, std::size_t end)>& work)>;

/// A ParallelLoop on the calling thread.
inline void runSerially(std::size_t count, std::size_t,
                        const std::function<void(std::size_t, std::size_t)>& work) {
  work(0, count);
}

} // namespace fenestra::core
