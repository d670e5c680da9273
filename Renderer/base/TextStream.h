#pragma once
// Streams that throw std::bad_alloc where memory fails. Those of the standard library keep it to
// themselves: a text then ends early, and a file is written that says less than it should.

#include <fstream>
#include <ios>
#include <sstream>
#include <utility>

namespace fenestra {

template <typename Stream>
class Throwing : public Stream {
public:
  template <typename... Arguments>
  explicit Throwing(Arguments&&... arguments) : Stream(std::forward<Arguments>(arguments)...) {
    this->exceptions(std::ios::badbit);
  }
};

using TextWriter = Throwing<std::ostringstream>;
using TextReader = Throwing<std::istringstream>;

} // namespace fenestra
