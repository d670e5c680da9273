#pragma once
// What a server is told while it works: changes, one JSON object a line, and the end of them.

#include "cli/RenderFlags.h"
#include "core/Stopwatch.h"

#include <nlohmann/json.hpp>

#include <condition_variable>
#include <mutex>
#include <thread>

namespace fenestra {

/// Answers on standard output: one JSON object a line, whole lines from whichever thread.
class ServeAnswers {
public:
  /// Returns false where nobody reads any more.
  bool say(const nlohmann::ordered_json& answer);
  /// `id` is that of the change, or null.
  bool error(const nlohmann::json& id, const std::string& message);

private:
  std::mutex m_mutex;
};

/// All flags as they are wanted after some changes.
struct ServeWish {
  FlagValues flags;
  nlohmann::json id = nullptr; ///< of the last change
  std::uint64_t number = 0;    ///< of changes so far
  Stopwatch since = {};        ///< the last of them came
};

/// A line's changes to `flags`: {"flag": value, …}, where a value is what the command line takes: a
/// text, a number, or a list of them; null takes the flag back. Throws Error (usage) for what
/// cannot change or be understood; `flags` is as it was then.
void applyChange(const nlohmann::json& change, FlagValues& flags);

/// Reads standard input in a thread of its own. A change stops the render under way; the end of
/// input ends the process, as signals do (cli/Stop), but for a picture that is being put in place.
class ServeInput {
public:
  ServeInput(const FlagValues& start, RenderMonitor& monitor, ServeAnswers& answers);
  ServeInput(const ServeInput&) = delete;
  ServeInput& operator=(const ServeInput&) = delete;

  /// Blocks until there are more changes than `seen`; from then on nothing stops the render but
  /// newer ones.
  ServeWish next(std::uint64_t seen);
  /// What could not be shown is not wanted any more, unless there are newer changes.
  void takeBack(const ServeWish& refused, const FlagValues& shown);

private:
  void read();
  void takeLine(const std::string& line);

  RenderMonitor& m_monitor;
  ServeAnswers& m_answers;
  std::mutex m_mutex; ///< of the wish, and of monitor.stop
  std::condition_variable m_changed;
  ServeWish m_wish;
  std::thread m_thread;
};

} // namespace fenestra
