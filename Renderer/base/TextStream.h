#pragma once
// Streams that throw std::bad_alloc if memory runs out. The standard library's streams swallow the
// exception: a text would end early, and a truncated file would be written.

#include <fstream>
#include <ios>
#include <sstream>
#include <utility>

namespace fenestra::core {

template <typename Stream>
class ThrowingStream : public Stream {
public:
  template <typename... Arguments>
  explicit ThrowingStream(Arguments&&... arguments)
      : Stream(std::forward<Arguments>(arguments)...) {
    this->exceptions(std::ios::badbit);
  }
};

using TextWriter = ThrowingStream<std::ostringstream>;
using TextReader = ThrowingStream<std::istringstream>;

} // namespace fenestra::core
