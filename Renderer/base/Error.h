#pragma once
// Every failure that a user can cause is an Error, and every doubt about a result is a warning: a
// Message with a code, what it concerns and what is wrong. No message names an option of the
// command line: the program adds that advice by code (program/ErrorAdvice.h), and chooses the exit
// status by kind.

#include "base/ErrorCode.h"
#include "base/Text.h"

#include <concepts>
#include <stdexcept>
#include <string>
#include <utility>

namespace fenestra::core {

enum class ErrorKind {
  request, ///< what the user asks for is impossible
  input,   ///< a file or its content is wrong
  output,  ///< a result cannot be written, or a resource is missing
};

struct Message {
  ErrorCode code = ErrorCode::invalidFile;
  std::string subject = {}; ///< file, "file: field" or part of the request; empty: none
  std::string detail = {};

  bool operator==(const Message&) const = default;
  /// "subject: detail"
  std::string text() const { return subject.empty() ? detail : subject + ": " + detail; }
};

class Error : public std::runtime_error {
public:
  Error(ErrorKind kind, Message message)
      : std::runtime_error(message.text()), m_kind(kind), m_message(std::move(message)) {}

  ErrorKind kind() const { return m_kind; }
  const Message& message() const { return m_message; }

private:
  ErrorKind m_kind;
  Message m_message;
};

// Subjects and parts of details are those of concat(): texts, paths and integers.
template <typename Subject, typename... Parts>
Message makeMessage(ErrorCode code, const Subject& subject, const Parts&... detail) {
  return {code, concat(subject), concat(detail...)};
}
template <typename Subject, typename... Parts>
Error requestError(ErrorCode code, const Subject& subject, const Parts&... detail) {
  return {ErrorKind::request, makeMessage(code, subject, detail...)};
}
template <typename File, typename... Parts>
Error inputError(ErrorCode code, const File& file, const Parts&... detail) {
  return {ErrorKind::input, makeMessage(code, file, detail...)};
}
template <typename File, typename... Parts>
requires(!std::same_as<File, ErrorCode>) Error
    inputError(const File& file, const Parts&... detail) {
  return inputError(ErrorCode::invalidFile, file, detail...);
}
/// Error (input) about a field of a file.
template <typename File, typename Field, typename... Parts>
Error fieldError(const File& file, const Field& field, const Parts&... detail) {
  return inputError(ErrorCode::invalidField, concat(file, ": ", field), detail...);
}
template <typename File, typename... Parts>
Error outputError(ErrorCode code, const File& file, const Parts&... detail) {
  return {ErrorKind::output, makeMessage(code, file, detail...)};
}
template <typename File, typename... Parts>
requires(!std::same_as<File, ErrorCode>) Error
    outputError(const File& file, const Parts&... detail) {
  return outputError(ErrorCode::unwritableFile, file, detail...);
}

} // namespace fenestra::core
