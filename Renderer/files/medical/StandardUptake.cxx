#include "files/medical/StandardUptake.h"

#include <chrono>
#include <cmath>

namespace fenestra {
namespace {

constexpr double secondsPerDay = 86400.0;

/// Seconds since midnight of a time HHMMSS or HHMMSS.FFFFFF.
std::optional<double> parseTime(const std::string& text) {
  const auto number = text.size() >= 6 ? parseNumber<double>(text) : std::nullopt;
  if (!number || !(*number >= 0.0 && *number < 240000.0))
    return std::nullopt;
  const auto whole = static_cast<int>(*number);
  const int hours = whole / 10000, minutes = whole / 100 % 100, seconds = whole % 100;
  return 3600.0 * hours + 60.0 * minutes + seconds + (*number - whole);
}

/// Days since 1970 of a date YYYYMMDD.
std::optional<double> parseDate(const std::string& text) {
  const auto number = text.size() == 8 ? parseNumber<int>(text) : std::nullopt;
  if (!number)
    return std::nullopt;
  using namespace std::chrono;
  const year_month_day date{year(*number / 10000),
                            month(static_cast<unsigned>(*number / 100 % 100)),
                            day(static_cast<unsigned>(*number % 100))};
  return date.ok() ? std::optional<double>(sys_days(date).time_since_epoch().count())
                   : std::nullopt;
}

/// Seconds from the injection to the series; nullopt: not stated, or not from 0 s to a day.
std::optional<double> computeDelay(const DicomHeader& h) {
  const auto start = parseTime(h.seriesTime);
  const std::string& both = h.injectionDateTime; // YYYYMMDDHHMMSS, perhaps with a time zone
  const auto injection = both.size() >= 14
                             ? parseTime(both.substr(8, both.find_first_of("+-", 8) - 8))
                             : parseTime(h.injectionTime);
  if (!start || !injection)
    return std::nullopt;
  double delay = *start - *injection;
  const auto seriesDay = parseDate(h.seriesDate);
  const auto injectionDay = both.size() >= 14 ? parseDate(both.substr(0, 8)) : std::nullopt;
  if (seriesDay && injectionDay)
    delay += secondsPerDay * (*seriesDay - *injectionDay);
  else if (delay < 0.0)
    delay += secondsPerDay; // past midnight
  return delay >= 0.0 && delay <= secondsPerDay ? std::optional(delay) : std::nullopt;
}

} // namespace

std::optional<double> computeSuvFactor(const DicomHeader& h, std::string& missing) {
  const auto refuse = [&](const char* what) {
    missing = what;
    return std::nullopt;
  };
  const auto isPositive = [](const std::optional<double>& x) { return x && *x > 0.0; };
  if (h.units != "BQML")
    return refuse("Units BQML");
  if (!isPositive(h.weight))
    return refuse("PatientWeight");
  if (!isPositive(h.dose))
    return refuse("RadionuclideTotalDose");
  double dose = *h.dose;
  if (h.decayCorrection == "START") {
    const auto delay = computeDelay(h);
    if (!isPositive(h.halfLife) || !delay)
      return refuse("RadionuclideHalfLife, SeriesTime or RadiopharmaceuticalStartTime");
    dose *= std::exp2(-*delay / *h.halfLife);
  } else if (h.decayCorrection != "ADMIN") {
    return refuse("DecayCorrection START or ADMIN");
  }
  constexpr double gramsPerKilogram = 1000.0;
  const double factor = *h.weight * gramsPerKilogram / dose;
  return std::isfinite(factor) ? std::optional(factor) : refuse("a plausible dose");
}

void convertToSuv(DicomSlices& slices, const std::string& name, std::vector<Message>& warnings) {
  std::string missing;
  const auto factor = computeSuvFactor(slices.front().header, missing);
  if (!factor) {
    warnings.push_back(makeMessage(ErrorCode::assumedUnits, name,
                                   "PET values are not SUV, since the header lacks ", missing));
    return;
  }
  for (DicomSlice& slice : slices) {
    slice.header.slope *= *factor;
    slice.header.intercept *= *factor;
  }
}

} // namespace fenestra
