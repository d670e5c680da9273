#pragma once
// CachedStage: a pure function with its last result. The arguments are the cache key: numbers and
// names by value, results of earlier stages by handle. No explicit invalidation is needed.

#include "base/Stopwatch.h"

#include <functional>
#include <memory>
#include <tuple>
#include <type_traits>

namespace fenestra::core {

/// Shared result of a stage; null: unused. Handles are equal if they share one result.
template <typename Result>
using Handle = std::shared_ptr<const Result>;

/// Type of what a stage's function returns, a value or a handle.
template <typename Returned>
struct StageResult {
  using Type = Returned;
};
template <typename Result>
struct StageResult<Handle<Result>> {
  using Type = Result;
};

template <auto function, typename Type = decltype(function)>
class CachedStage;

template <auto function, typename Returned, typename... Arguments>
class CachedStage<function, Returned (*)(Arguments...)> {
public:
  using Result = typename StageResult<Returned>::Type;

  /// Marks the stage as unused. The result stays cached for later calls with equal arguments.
  void markUnused() {
    m_result = nullptr;
    m_seconds = 0.0;
  }

  /// Returns function(arguments...), from the cache if the arguments equal those of the last call.
  /// Throws what the function throws.
  Handle<Result> get(const std::remove_cvref_t<Arguments>&... arguments) {
    if (!isCached(arguments...)) {
      const Stopwatch watch;
      m_cached.reset(new Entry{{arguments...}, std::invoke(function, arguments...)});
      m_seconds = watch.seconds();
    }
    if constexpr (std::is_same_v<Result, Returned>)
      m_result = {m_cached, &m_cached->result};
    else
      m_result = m_cached->result;
    return m_result;
  }

  /// True if get() would return the result of the last call.
  bool isCached(const std::remove_cvref_t<Arguments>&... arguments) const {
    return m_cached && m_cached->key == std::tie(arguments...);
  }

  /// Null if get() was not called since markUnused().
  const Handle<Result>& result() const { return m_result; }
  const Result& operator*() const { return *m_result; }
  const Result* operator->() const { return m_result.get(); }
  /// Wall-clock seconds of the function since markUnused(); 0: not called.
  double seconds() const { return m_seconds; }
  bool isUpdated() const { return m_seconds > 0.0; }

private:
  struct Entry {
    std::tuple<std::remove_cvref_t<Arguments>...> key;
    Returned result;
  };

  std::shared_ptr<const Entry> m_cached;
  Handle<Result> m_result;
  double m_seconds = 0.0;
};

/// For const member functions: the object is the first argument.
template <auto function, typename Object, typename Result, typename... Arguments>
class CachedStage<function, Result (Object::*)(Arguments...) const>
    : public CachedStage<function, Result (*)(const Object&, Arguments...)> {};

} // namespace fenestra::core
