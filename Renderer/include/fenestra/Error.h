#pragma once

#include "fenestra/Types.h"

#include <stdexcept>
#include <string>

namespace fenestra {
inline namespace v1 {

enum class ErrorKind {
  request, ///< what the caller asks for is impossible
  input,   ///< a volume, a segmentation or a file is wrong
  output,  ///< a result cannot be written, or memory or another resource is missing
};

/// A doubt about a result. It does not prevent the result.
struct Warning {
  std::string code;    ///< kind of problem, like "assumed-geometry"
  std::string subject; ///< what it concerns: a file, "file: field" or a part of the request
  std::string detail;

  /// "subject: detail"
  std::string text() const { return subject.empty() ? detail : subject + ": " + detail; }
};

/// Every error of this library, except std::bad_alloc. what() is "subject: detail".
class FENESTRA_EXPORT Error : public std::runtime_error {
public:
  Error(ErrorKind kind, Warning what);
  Error(const Error&) = default;
  Error& operator=(const Error&) = default;
  ~Error() override;

  ErrorKind kind() const { return m_kind; }
  /// Kind of problem, like "missing-file"; callers may depend on it.
  const std::string& code() const { return m_what.code; }
  const std::string& subject() const { return m_what.subject; }
  const std::string& detail() const { return m_what.detail; }

private:
  ErrorKind m_kind;
  Warning m_what;
};

} // namespace v1
} // namespace fenestra
