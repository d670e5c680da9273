#pragma once
// What only the program adds to errors and warnings: advice that names options, and exit statuses.

#include "base/Error.h"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace fenestra::core {

/// Exit status of a command that fails with an error of this kind.
constexpr int exitStatus(ErrorKind kind) {
  return kind == ErrorKind::request ? 2 : kind == ErrorKind::input ? 3 : 4;
}

/// How options resolve this situation; empty: no advice.
std::string_view findAdvice(ErrorCode code);

/// "subject: detail; advice"
std::string composeMessage(const Message& message);
std::vector<std::string> composeMessages(const std::vector<Message>& messages);
/// Replaces the messages in a report of scene/Inspection.h by such lines.
void composeReport(nlohmann::ordered_json& report);

} // namespace fenestra::core
