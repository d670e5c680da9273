#include "program/Flags.h"

#include "base/Error.h"
#include "base/TextStream.h"
#include "base/safe/ShownText.h"

#include <algorithm>
#include <charconv>
#include <stdexcept>

namespace fenestra {
namespace {

std::optional<double> parseNumber(std::string_view text) {
  while (text.starts_with(' '))
    text.remove_prefix(1);
  while (text.ends_with(' '))
    text.remove_suffix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
    return std::nullopt;
  return value;
}

std::vector<std::string> splitAtCommas(const std::string& text) {
  std::vector<std::string> parts(1);
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\\' && i + 1 < text.size() && text[i + 1] == ',')
      parts.back() += text[++i];
    else if (text[i] == ',')
      parts.emplace_back();
    else
      parts.back() += text[i];
  }
  return parts;
}

Error badValue(const std::string& flag, const std::string& expected, const std::string& got) {
  return usageError("--" + flag + ": expected " + expected + ", got '" + oneLine(got) + "'");
}

} // namespace

const Flag* findFlag(std::span<const Flag> flags, std::string_view name) {
  const auto it = std::find_if(flags.begin(), flags.end(),
                               [name](const Flag& flag) { return flag.name == name; });
  return it == flags.end() ? nullptr : &*it;
}

bool isWritten(const Flag& flag) {
  const Takes::Kind kind = flag.takes.kind;
  return kind == Takes::Kind::picture || kind == Takes::Kind::surface ||
         kind == Takes::Kind::report;
}

std::string shortNumber(double x) {
  TextWriter out;
  out << x;
  return out.str();
}

const Flag& FlagValues::flag(const std::string& name) const {
  if (const Flag* flag = findFlag(m_flags, name))
    return *flag;
  throw std::logic_error("--" + name + " is not in the table");
}

bool FlagValues::differs(const std::string& name) const {
  return has(name) && text(name) != flag(name).standard;
}

std::optional<std::string> FlagValues::text(const std::string& name) const {
  const auto it = m_values.find(name);
  if (it == m_values.end())
    return std::nullopt;
  if (it->second.size() > 1)
    throw usageError("--" + name + ": is given more than once; give it once");
  return it->second.front();
}

std::vector<std::string> FlagValues::texts(const std::string& name) const {
  const auto it = m_values.find(name);
  return it == m_values.end() ? std::vector<std::string>() : it->second;
}

std::optional<double> FlagValues::number(const std::string& name) const {
  const auto given = text(name);
  if (!given)
    return std::nullopt;
  const auto [kind, least, greatest, words] = flag(name).takes;
  const auto value = parseNumber(*given);
  if (!value || *value < least || *value > greatest)
    throw badValue(name, "a number from " + shortNumber(least) + " to " + shortNumber(greatest),
                   *given);
  return value;
}

std::optional<std::uint64_t> FlagValues::count(const std::string& name) const {
  const auto given = text(name);
  if (!given)
    return std::nullopt;
  const auto [kind, least, greatest, words] = flag(name).takes;
  std::uint64_t value = 0;
  const char* last = given->data() + given->size();
  const auto [end, error] = std::from_chars(given->data(), last, value);
  const auto comparable = static_cast<double>(value);
  if (error != std::errc() || end != last || comparable < least || comparable > greatest)
    throw badValue(
        name, "a whole number from " + shortNumber(least) + " to " + shortNumber(greatest), *given);
  return value;
}

std::optional<std::vector<double>> FlagValues::numbers(const std::string& name,
                                                       std::size_t size) const {
  const auto given = text(name);
  if (!given)
    return std::nullopt;
  std::vector<double> values;
  for (const std::string& part : splitAtCommas(*given))
    if (const auto value = parseNumber(part))
      values.push_back(*value);
    else
      throw badValue(name, std::to_string(size) + " numbers separated by commas", *given);
  if (values.size() != size)
    throw badValue(name, std::to_string(size) + " numbers separated by commas", *given);
  return values;
}

std::optional<Vec3> FlagValues::triple(const std::string& name) const {
  const auto values = numbers(name, 3);
  if (!values)
    return std::nullopt;
  return Vec3((*values)[0], (*values)[1], (*values)[2]);
}

std::optional<std::string> FlagValues::word(const std::string& name) const {
  auto given = text(name);
  const std::vector<std::string> words = splitAt(flag(name).takes.words, '|');
  if (!given || std::find(words.begin(), words.end(), *given) != words.end())
    return given;
  std::string known;
  for (const std::string& w : words)
    known += (known.empty() ? "" : w == words.back() ? " or " : ", ") + w;
  throw badValue(name, known, *given);
}

std::vector<std::string> FlagValues::list(const std::string& name) const {
  std::vector<std::string> all;
  for (const std::string& given : texts(name))
    for (const std::string& part : splitAtCommas(given)) {
      if (part.empty())
        throw badValue(name, "names separated by commas", given);
      all.push_back(part);
    }
  return all;
}

std::string FlagValues::echo() const {
  std::string lines;
  for (const auto& [name, values] : m_values)
    for (const std::string& value : values)
      lines += name + ": " + (value.empty() ? "yes" : oneLine(value)) + '\n';
  return lines;
}

std::vector<std::string> FlagValues::arguments() const {
  std::vector<std::string> arguments;
  for (const auto& [name, values] : m_values)
    for (const std::string& value : values)
      if (!findFlag(m_flags, name)) // a positional argument
        arguments.push_back(value);
      else
        arguments.push_back("--" + name + (value.empty() ? "" : "=" + value));
  return arguments;
}

std::vector<std::string> splitAt(std::string_view text, char separator) {
  std::vector<std::string> parts(1);
  for (const char c : text)
    if (c == separator)
      parts.emplace_back();
    else
      parts.back() += c;
  return parts;
}

} // namespace fenestra
