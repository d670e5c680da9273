#pragma once
// Events of a running `fenestra serve`.

#include "CommandTesting.h"

#include <nlohmann/json.hpp>

#include <sstream>

namespace fenestra::core {

using nlohmann::json;

class ServeTest : public SmallScene {
protected:
  static std::vector<json> readEvents(const Process& process) {
    std::vector<json> all;
    std::istringstream lines(process.output());
    for (std::string line; std::getline(lines, line);)
      all.push_back(json::parse(line));
    return all;
  }
  /// Waits for the final image of a change; `id`: as JSON, null for the image before any change.
  static bool waitForImage(const Process& process, const std::string& id) {
    return process.waitForOutput("\"picture\",\"id\":" + id + ",[^\n]*\"done\":true[^\n]*\n");
  }
  /// Waits for the error event of a change, or of a line without a valid id (null).
  static bool waitForError(const Process& process, const std::string& id,
                           const std::string& message) {
    return process.waitForOutput("\"error\",\"id\":" + id + ",\"message\":\"[^\n]*" + message +
                                 "[^\n]*\",\"code\":\"[a-z-]+\"");
  }
};

} // namespace fenestra::core
