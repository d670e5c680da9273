#pragma once
// Changes that a running server reads from standard input, one JSON object per line.

#include "base/Error.h"
#include "base/Stopwatch.h"
#include "program/RenderOptions.h"
#include "scene/Input.h"

#include <nlohmann/json.hpp>

#include <condition_variable>
#include <mutex>

namespace fenestra::core {

/// Writes one line of JSON to standard output; thread-safe. Ends the process if standard output is
/// closed, since no client is left.
void writeEvent(const nlohmann::ordered_json& content);
/// `id`: of the change, or null.
void writeErrorEvent(const nlohmann::json& id, const Message& message);

/// One line of input.
struct ServeChange {
  nlohmann::json options = {}; ///< {"option": value, …}
  nlohmann::json id = nullptr; ///< null, a number, or a text of at most 256 bytes
  Stopwatch age = {};          ///< started on arrival
};
using ServeChanges = std::vector<ServeChange>;

/// The id of a change; null: none. Throws Error (usage) for an id of any other type.
nlohmann::json readId(const nlohmann::json& change);

/// True for {"pause": true}, which ends the render; the next change renders again. Throws Error
/// (usage) for anything else with that key.
bool isPause(const nlohmann::json& change);

/// Option values after a change. A value is a text, a number, or a list of them, as on the command
/// line; null removes the option. Throws Error (usage) for unknown or fixed options.
OptionValues applyChange(const nlohmann::json& change, const OptionValues& values);

/// Throws Error: usage if the options after a change contradict each other; input if lights,
/// transfer function or materials that it names cannot be read.
void checkChange(const nlohmann::json& change, const OptionValues& values, const Input& input);

/// Reads standard input in its own thread. Each change, and each pause, stops the current render.
/// The end of input ends the process (endProcess).
class ServeInput {
public:
  ServeInput(const OptionValues& start, const Input& input, RenderMonitor& monitor);

  /// Waits for changes and returns them. From then on only newer lines stop the render.
  ServeChanges next();
  /// Call if returned changes were rejected: newer changes then apply to `shown`.
  void revert(const OptionValues& shown);

private:
  void read();
  void handleLine(const std::string& line);

  const Input m_input; ///< shared by all scenes
  RenderMonitor& m_monitor;
  std::mutex m_mutex; ///< guards m_requested, m_pending and monitor.stop
  std::condition_variable m_changed;
  OptionValues m_requested; ///< option values after all changes
  ServeChanges m_pending;   ///< not yet returned by next()
  bool m_isPaused = false;  ///< until the next change
};

} // namespace fenestra::core
