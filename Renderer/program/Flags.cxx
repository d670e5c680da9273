#include "program/Flags.h"

#include "base/Error.h"
#include "base/safe/ShownText.h"

#include <algorithm>
#include <stdexcept>

namespace fenestra {
namespace {

/// Finite number, perhaps between blanks.
std::optional<double> parsedNumber(std::string_view text) {
  const auto value = parsed<double>(trimmed(text, " "));
  return value && std::isfinite(*value) ? value : std::nullopt;
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
  return usageError("--", flag, ": expected ", expected, ", got '", oneLine(got), "'");
}

/// Throws Error (usage) unless there is a value, and in the flag's range.
template <typename Number>
Number inRange(std::optional<Number> value, const Flag& flag, const std::string& given,
               const char* otherwise = "") {
  const auto [least, greatest] = std::pair(flag.takes.least, flag.takes.greatest);
  if (value && least <= static_cast<double>(*value) && static_cast<double>(*value) <= greatest)
    return *value;
  const char* const kind = std::is_integral_v<Number> ? "a whole number from " : "a number from ";
  throw badValue(flag.name,
                 textOf(kind, numberText(least), " to ", numberText(greatest), otherwise), given);
}

} // namespace

std::string Flag::help() const {
  const bool isTold = takes.standard.empty() || text.ends_with(']');
  return isTold ? text : text + " [" + takes.standard + "]";
}

const Flag* findFlag(std::span<const Flag> flags, std::string_view name) {
  const auto it = std::ranges::find(flags, name, &Flag::name);
  return it == flags.end() ? nullptr : &*it;
}

const Flag& FlagValues::flag(const std::string& name) const {
  if (const Flag* flag = findFlag(m_flags, name))
    return *flag;
  throw std::logic_error("--" + name + " is not in the table");
}

bool FlagValues::differs(const std::string& name) const {
  return has(name) && text(name) != flag(name).takes.standard;
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
  return given ? std::optional(inRange(parsedNumber(*given), flag(name), *given)) : std::nullopt;
}

std::optional<double> FlagValues::numberOrAuto(const std::string& name) const {
  const std::string given = *text(name);
  if (given == "auto")
    return std::nullopt;
  return inRange(parsedNumber(given), flag(name), given, ", or auto");
}

bool FlagValues::isIdle(const std::string& name) const {
  const std::optional<double>& idle = flag(name).takes.idle;
  return idle && parsedNumber(text(name).value_or("")) == idle;
}

std::optional<std::uint64_t> FlagValues::count(const std::string& name) const {
  const auto given = text(name);
  return given ? std::optional(inRange(parsed<std::uint64_t>(*given), flag(name), *given))
               : std::nullopt;
}

std::vector<double> FlagValues::numbers(const std::string& name, std::size_t size) const {
  const std::string given = *text(name);
  const std::vector<std::string> parts = splitAtCommas(given);
  std::vector<double> values;
  for (const std::string& part : parts)
    if (const auto value = parsedNumber(part))
      values.push_back(*value);
  if (parts.size() != size || values.size() != size)
    throw badValue(name, std::to_string(size) + " numbers separated by commas", given);
  return values;
}

Vec3 FlagValues::triple(const std::string& name) const {
  const std::vector<double> values = numbers(name, 3);
  return Vec3(values[0], values[1], values[2]);
}

std::string FlagValues::word(const std::string& name) const {
  std::string given = *text(name);
  const std::vector<std::string>& words = flag(name).takes.words;
  if (words.empty() || std::ranges::find(words, given) != words.end())
    return given;
  std::string known;
  for (const std::string& w : words)
    known += (known.empty() ? "" : w == words.back() ? " or " : ", ") + w;
  throw badValue(name, known, given);
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

} // namespace fenestra
