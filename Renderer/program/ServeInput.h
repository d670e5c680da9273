#pragma once
// Input of a server while it works: changes, one JSON object a line, until the end of input.

#include "base/Stopwatch.h"
#include "program/RenderOptions.h"
#include "scene/Input.h"

#include <nlohmann/json.hpp>

#include <condition_variable>
#include <mutex>

namespace fenestra {

/// Writes a line of JSON to standard output; lines of several threads do not mix. Ends the process
/// if standard output is closed: nobody waits for pictures.
void writeEvent(const nlohmann::ordered_json& content);
/// `id`: the change's, or null.
void writeErrorEvent(const nlohmann::json& id, const std::string& message);

/// One line of input.
struct ServeChange {
  nlohmann::json options = {}; ///< {"flag": value, …}
  nlohmann::json id = nullptr; ///< null, a number, or a text of at most 256 bytes
  Stopwatch age = {};          ///< time since arrival
};
using ServeChanges = std::vector<ServeChange>;

/// The id of a change; null: none. Throws Error (usage) for an id of another type.
nlohmann::json readId(const nlohmann::json& change);

/// Flags after a change. A value is a text, a number, or a list of them, as on the command line;
/// null removes the flag. Throws Error (usage) for a flag that is unknown or cannot change.
OptionValues applyChange(const nlohmann::json& change, const OptionValues& values);

/// Throws Error: usage if the flags after a change contradict each other, input if a look that the
/// change names cannot be read.
void checkChange(const nlohmann::json& change, const OptionValues& values, const Input& input);

/// Reads standard input in its own thread. A change stops the render under way. The end of input
/// ends the process (endProcess).
class ServeInput {
public:
  ServeInput(const OptionValues& start, const Input& input, RenderMonitor& monitor);

  /// Blocks until there are changes, and takes them; afterwards only newer changes stop the render.
  ServeChanges next();
  /// Call if changes that were taken cannot be shown: newer changes then apply to `shown`.
  void revert(const OptionValues& shown);

private:
  void read();
  void handleLine(const std::string& line);

  const Input m_input; ///< of all scenes
  RenderMonitor& m_monitor;
  std::mutex m_mutex; ///< guards m_requested, m_pending and monitor.stop
  std::condition_variable m_changed;
  OptionValues m_requested; ///< flags after all changes
  ServeChanges m_pending;   ///< changes not yet taken by next()
};

} // namespace fenestra
