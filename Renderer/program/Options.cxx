#include "program/Options.h"

#include "base/Error.h"
#include "io/MessageText.h"
#include "program/UsageError.h"

#include <algorithm>
#include <stdexcept>

namespace fenestra::core {
namespace {

/// Finite number, optionally surrounded by blanks.
std::optional<double> parseFinite(std::string_view text) {
  const auto value = parseNumber<double>(trim(text, " "));
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

Error invalidValue(const std::string& option, const std::string& expected, const std::string& got) {
  return usageError("--", option, ": expected ", expected, ", got '", toOneLine(got), "'");
}

/// " from 0 to 1". Bounds that only exclude absurd values are omitted unless `given` exceeds them.
std::string formatRange(const ValueSpec& spec, std::optional<double> given) {
  constexpr double absurd = 1e9;
  constexpr int exact = 20; // significant digits
  const bool showsLeast = spec.least > -absurd || (given && *given < spec.least);
  const bool showsGreatest = spec.greatest < absurd || (given && *given > spec.greatest);
  const auto format = [](double bound) {
    return std::floor(bound) == bound ? toString(bound, exact) : toString(bound);
  };
  return concat(showsLeast ? " from " + format(spec.least) : "",
                showsGreatest ? " to " + format(spec.greatest) : "");
}

/// Throws Error (usage) unless the value exists and is in the option's range.
template <typename Number>
Number requireInRange(std::optional<Number> value, const Option& option, const std::string& given,
                      const char* alternative = "") {
  const auto [least, greatest] = std::pair(option.spec.least, option.spec.greatest);
  if (value && least <= static_cast<double>(*value) && static_cast<double>(*value) <= greatest)
    return *value;
  const char* const kind = std::is_integral_v<Number> ? "an integer" : "a number";
  throw invalidValue(
      option.name, concat(kind, formatRange(option.spec, parseFinite(given)), alternative), given);
}

} // namespace

std::string Option::help() const {
  const bool hasDefault = spec.defaultValue.empty() || description.ends_with(']');
  return hasDefault ? description : description + " [" + spec.defaultValue + "]";
}

std::string Option::resolveAlias(const std::string& value) const {
  const auto alias = spec.aliases.find(value);
  return alias == spec.aliases.end() ? value : alias->second;
}

OptionNames::OptionNames(const char* canonical, const char* formerName)
    : name(canonical), oneWord(formerName) {
  if (oneWord.empty())
    oneWord = replaceAll(name, "-", "");
}

bool OptionNames::hasName(std::string_view given) const {
  return given == name || given == oneWord || given == replaceAll(name, "-", "");
}

const Option* findOption(std::span<const Option> options, std::string_view name) {
  const auto it =
      std::ranges::find_if(options, [name](const Option& option) { return option.hasName(name); });
  return it == options.end() ? nullptr : &*it;
}

const Option* findOption(std::span<const Option> options, char letter) {
  const auto it = std::ranges::find(options, letter, &Option::letter);
  return it == options.end() || letter == 0 ? nullptr : &*it;
}

std::optional<OptionWord> parseOptionWord(std::span<const Option> options, std::string_view word) {
  if (word.starts_with("--")) {
    const std::size_t equals = word.find('=');
    const Option* const option = findOption(options, word.substr(2, equals - 2));
    if (!option)
      return std::nullopt;
    return OptionWord{option, equals == word.npos ? std::optional<std::string_view>()
                                                  : word.substr(equals + 1)};
  }
  const Option* const option =
      word.size() >= 2 && word[0] == '-' ? findOption(options, word[1]) : nullptr;
  if (!option)
    return std::nullopt;
  if (word.size() == 2)
    return OptionWord{option, std::nullopt};
  const bool isNumber = word.find_first_not_of("0123456789", 2) == word.npos;
  if (option->spec.type == "integer" && isNumber)
    return OptionWord{option, word.substr(2)};
  return std::nullopt;
}

const Option& OptionValues::option(const std::string& name) const {
  if (const Option* option = findOption(m_options, name))
    return *option;
  throw std::logic_error("--" + name + " is not in the table");
}

bool OptionValues::hasNonDefault(const std::string& name) const {
  return has(name) && text(name) != option(name).spec.defaultValue;
}

std::optional<std::string> OptionValues::text(const std::string& name) const {
  const auto it = m_values.find(name);
  if (it == m_values.end())
    return std::nullopt;
  if (it->second.size() > 1)
    throw usageError("--" + name + ": given more than once; give it once");
  return it->second.front();
}

std::vector<std::string> OptionValues::texts(const std::string& name) const {
  const auto it = m_values.find(name);
  return it == m_values.end() ? std::vector<std::string>() : it->second;
}

std::optional<double> OptionValues::number(const std::string& name) const {
  const auto given = text(name);
  return given ? std::optional(requireInRange(parseFinite(*given), option(name), *given))
               : std::nullopt;
}

std::optional<double> OptionValues::numberOrAuto(const std::string& name) const {
  const std::string given = *text(name);
  if (given == "auto")
    return std::nullopt;
  return requireInRange(parseFinite(given), option(name), given, ", or auto");
}

bool OptionValues::hasNoEffect(const std::string& name) const {
  const std::optional<double>& idle = option(name).spec.noEffectValue;
  return idle && parseFinite(text(name).value_or("")) == idle;
}

std::optional<std::uint64_t> OptionValues::integer(const std::string& name) const {
  const auto given = text(name);
  return given ? std::optional(
                     requireInRange(parseNumber<std::uint64_t>(*given), option(name), *given))
               : std::nullopt;
}

std::vector<double> OptionValues::numbers(const std::string& name, std::size_t size) const {
  const std::string given = *text(name);
  const std::vector<std::string> parts = splitAtCommas(given);
  std::vector<double> values;
  for (const std::string& part : parts)
    if (const auto value = parseFinite(part))
      values.push_back(*value);
  if (parts.size() != size || values.size() != size)
    throw invalidValue(name, std::to_string(size) + " numbers separated by commas", given);
  return values;
}

Vec3 OptionValues::triple(const std::string& name) const {
  const std::vector<double> values = numbers(name, 3);
  return Vec3(values[0], values[1], values[2]);
}

std::string OptionValues::word(const std::string& name) const {
  std::string given = option(name).resolveAlias(*text(name));
  const std::vector<std::string>& words = option(name).spec.choices;
  if (words.empty() || std::ranges::find(words, given) != words.end())
    return given;
  std::string known;
  for (const std::string& w : words)
    known += (known.empty() ? "" : w == words.back() ? " or " : ", ") + w;
  throw invalidValue(name, known, given);
}

std::vector<std::string> OptionValues::list(const std::string& name) const {
  std::vector<std::string> all;
  for (const std::string& given : texts(name))
    for (const std::string& part : splitAtCommas(given)) {
      if (part.empty())
        throw invalidValue(name, "names separated by commas", given);
      all.push_back(part);
    }
  return all;
}

std::string OptionValues::echo() const {
  std::string lines;
  for (const auto& [name, values] : m_values)
    for (const std::string& value : values)
      lines += name + ": " + (value.empty() ? "yes" : toOneLine(value)) + '\n';
  return lines;
}

std::vector<std::string> OptionValues::arguments() const {
  std::vector<std::string> arguments;
  for (const auto& [name, values] : m_values)
    for (const std::string& value : values)
      if (!findOption(m_options, name)) // a positional argument
        arguments.push_back(value);
      else
        arguments.push_back("--" + name + (value.empty() ? "" : "=" + value));
  return arguments;
}

} // namespace fenestra::core
