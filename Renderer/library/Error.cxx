#include "fenestra/Error.h"

#include <utility>

namespace fenestra {
inline namespace v1 {

Error::Error(ErrorKind kind, Warning what)
    : std::runtime_error(what.text()), m_kind(kind), m_what(std::move(what)) {}

Error::~Error() = default;

} // namespace v1
} // namespace fenestra
