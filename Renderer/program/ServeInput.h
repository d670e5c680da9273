#pragma once
// What a server is told while it works: changes, one JSON object a line, and the end of them.

#include "base/Stopwatch.h"
#include "program/RenderFlags.h"

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

/// A line.
struct ServeChange {
  nlohmann::json flags;        ///< {"flag": value, …}
  nlohmann::json id = nullptr; ///< null, a number, or a text of at most 256 bytes
  Stopwatch since = {};        ///< it came
};
using ServeChanges = std::vector<ServeChange>;

/// What a line says. Throws Error for what is no JSON or has another id; `id` is its own as soon as
/// it is known.
ServeChange parseChange(const std::string& line, nlohmann::json& id);

/// The flags after a line's changes: {"flag": value, …}, where a value is what the command line
/// takes: a text, a number, or a list of them; null takes the flag back. Throws Error (usage) for
/// what cannot change or be understood.
FlagValues changedFlags(const nlohmann::json& change, const FlagValues& flags);

/// Throws Error where the flags after a change cannot be together (usage), or a look that the
/// change names cannot be read (input).
void checkChange(const nlohmann::json& change, const FlagValues& flags);

/// Reads standard input in a thread of its own. A change stops the render under way; the end of
/// input ends the process, as signals do (program/Stop), but for a picture that is being put in
/// place.
class ServeInput {
public:
  ServeInput(const FlagValues& start, RenderMonitor& monitor, ServeAnswers& answers);
  ServeInput(const ServeInput&) = delete;
  ServeInput& operator=(const ServeInput&) = delete;

  /// Blocks until there are changes, and takes them; from then on nothing stops the render but
  /// newer ones.
  ServeChanges next();
  /// Some of what was taken cannot be shown: newer changes are to what is shown.
  void takeBack(const FlagValues& shown);

private:
  void read();
  void takeLine(const std::string& line);

  RenderMonitor& m_monitor;
  ServeAnswers& m_answers;
  std::mutex m_mutex; ///< of what is wanted, and of monitor.stop
  std::condition_variable m_changed;
  FlagValues m_wanted; ///< after all changes
  ServeChanges m_new;  ///< that nobody has taken
  std::thread m_thread;
};

} // namespace fenestra
