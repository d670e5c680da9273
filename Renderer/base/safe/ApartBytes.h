#pragma once
// Encoding of texts and lists of numbers in an answer (Apart.h): a count (8 bytes), then that many
// characters or doubles.

#include <cmath>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace fenestra {

/// Encodes an answer, in the child.
class AnswerWriter {
public:
  void put(std::string_view text) { append(text.size(), text.data(), text.size()); }
  void put(const std::vector<double>& numbers) {
    append(numbers.size(), numbers.data(), numbers.size() * sizeof(double));
  }
  const std::string& bytes() const { return m_bytes; }

private:
  void append(std::uint64_t count, const void* values, std::size_t size) {
    m_bytes.append(reinterpret_cast<const char*>(&count), sizeof count);
    m_bytes.append(static_cast<const char*>(values), size);
  }

  std::string m_bytes;
};

/// Decodes an answer, in the parent. Throws std::runtime_error for a truncated answer, or a number
/// that is not finite.
class AnswerReader {
public:
  explicit AnswerReader(std::string_view bytes) : m_bytes(bytes) {}

  bool atEnd() const { return m_bytes.empty(); }
  std::string text() { return std::string(take(count())); }
  /// Finite numbers, in the order written.
  std::vector<double> numbers() {
    const std::uint64_t count = this->count();
    if (count > m_bytes.size() / sizeof(double))
      throw std::runtime_error("an answer goes beyond its end");
    std::vector<double> numbers(static_cast<std::size_t>(count));
    const std::string_view bytes = take(count * sizeof(double));
    if (!bytes.empty())
      std::memcpy(numbers.data(), bytes.data(), bytes.size());
    for (const double number : numbers)
      if (!std::isfinite(number))
        throw std::runtime_error("a number in an answer is not finite");
    return numbers;
  }

private:
  std::uint64_t count() {
    std::uint64_t count = 0;
    std::memcpy(&count, take(sizeof count).data(), sizeof count);
    return count;
  }
  std::string_view take(std::uint64_t count) {
    if (count > m_bytes.size())
      throw std::runtime_error("an answer goes beyond its end");
    const std::string_view taken = m_bytes.substr(0, static_cast<std::size_t>(count));
    m_bytes.remove_prefix(taken.size());
    return taken;
  }

  std::string_view m_bytes;
};

} // namespace fenestra
