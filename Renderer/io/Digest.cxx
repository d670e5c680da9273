#include "io/Digest.h"

#include "base/Random.h"
#include "io/platform/SystemErrors.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <fstream>
#include <vector>

namespace fenestra::core {
namespace {

constexpr std::size_t wordBytes = 8;
static_assert(std::endian::native == std::endian::little, "words are read in memory order");

std::uint64_t mixWord(std::uint64_t state, const char* bytes) {
  std::uint64_t word = 0;
  std::memcpy(&word, bytes, wordBytes);
  return mixBits((state ^ word) + Random::gamma);
}

} // namespace

void Digest::add(std::string_view bytes) {
  m_size += bytes.size();
  if (!m_rest.empty()) {
    const std::size_t taken = std::min(wordBytes - m_rest.size(), bytes.size());
    m_rest += bytes.substr(0, taken);
    bytes.remove_prefix(taken);
    if (m_rest.size() < wordBytes)
      return;
    m_state = mixWord(m_state, m_rest.data());
    m_rest.clear();
  }
  for (; bytes.size() >= wordBytes; bytes.remove_prefix(wordBytes))
    m_state = mixWord(m_state, bytes.data());
  m_rest = bytes;
}

std::uint64_t Digest::value() const {
  std::string last = m_rest;
  last.resize(wordBytes, '\0');
  return mixBits(mixWord(m_state, last.data()) ^ m_size);
}

std::uint64_t computeDigest(const std::filesystem::path& file, std::uint64_t bytes) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream)
    throw readError(file, errno, "check its permissions");
  Digest digest;
  std::vector<char> block(1 << 20);
  for (std::uint64_t left = bytes; left > 0 && stream;) {
    stream.read(block.data(),
                static_cast<std::streamsize>(std::min<std::uint64_t>(block.size(), left)));
    const auto count = static_cast<std::size_t>(stream.gcount());
    digest.add({block.data(), count});
    left -= count;
  }
  if (stream.bad())
    throw readError(file, EIO, "check its disk");
  return digest.value();
}

} // namespace fenestra::core
