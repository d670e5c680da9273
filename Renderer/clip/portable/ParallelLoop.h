#pragma once

#include <cstddef>
#include <functional>

namespace fenestra::core {

/// Calls work(begin, end) for ranges that make up [0, count), each of at least `grain`, in any
/// order and possibly at the same time.
using ParallelLoop =
    std::function<void(std::size_t count, std::size_t grain,
                       const std::function<void(std::size_t begin, std::size_t end)>& work)>;

} // namespace fenestra::core
