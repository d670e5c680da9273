#pragma once
// Stage: a pure function and its last result, kept with the arguments, which are its key: numbers
// and names by value, results of earlier stages by handle. Nothing has to be marked as outdated.

#include "base/Stopwatch.h"

#include <functional>
#include <memory>
#include <tuple>

namespace fenestra {

/// Shared result of a stage; null: the stage is not used. Equal for one and the same result.
template <typename Result>
using Handle = std::shared_ptr<const Result>;

template <auto function, typename Type = decltype(function)>
class CachedStage;

/// For results of namespace-scope functions.
template <auto function, typename Result, typename... Arguments>
class CachedStage<function, Result (*)(Arguments...)> {
public:
  /// Marks the stage as unused; its result is kept for later equal arguments.
  void markUnused() {
    m_result = nullptr;
    m_seconds = 0.0;
  }

  /// Result of function(arguments...), kept from before if the arguments are equal. Throws as the
  /// function does.
  Handle<Result> get(const std::remove_cvref_t<Arguments>&... arguments) {
    if (!m_cached || m_cached->key != std::tie(arguments...)) {
      const Stopwatch watch;
      m_cached.reset(new Entry{{arguments...}, std::invoke(function, arguments...)});
      m_seconds = watch.seconds();
    }
    return m_result = {m_cached, &m_cached->result};
  }

  /// Null: not used since begin().
  const Handle<Result>& result() const { return m_result; }
  const Result& operator*() const { return *m_result; }
  const Result* operator->() const { return m_result.get(); }
  /// Wall-clock seconds of the function since begin(); 0: not called.
  double seconds() const { return m_seconds; }
  bool isUpdated() const { return m_seconds > 0.0; }

private:
  struct Entry {
    std::tuple<std::remove_cvref_t<Arguments>...> key;
    Result result;
  };

  std::shared_ptr<const Entry> m_cached;
  Handle<Result> m_result;
  double m_seconds = 0.0;
};

/// For results of member functions: the object is the first argument.
template <auto function, typename Object, typename Result, typename... Arguments>
class CachedStage<function, Result (Object::*)(Arguments...) const>
    : public CachedStage<function, Result (*)(const Object&, Arguments...)> {};

} // namespace fenestra
