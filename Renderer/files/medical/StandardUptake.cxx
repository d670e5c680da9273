#include "files/medical/StandardUptake.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace fenestra::core {
namespace {

constexpr double secondsPerDay = 86400.0;

/// Seconds since midnight of a time HHMMSS or HHMMSS.FFFFFF.
std::optional<double> toSeconds(std::optional<double> number) {
  if (!number || !(*number >= 0.0 && *number < 240000.0))
    return std::nullopt;
  const auto whole = static_cast<int>(*number);
  const int hours = whole / 10000, minutes = whole / 100 % 100, seconds = whole % 100;
  return 3600.0 * hours + 60.0 * minutes + seconds + (*number - whole);
}
std::optional<double> parseTime(const std::string& text) {
  return toSeconds(text.size() >= 6 ? parseNumber<double>(text) : std::nullopt);
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

/// Seconds since the beginning of the day of the series; without a date: on that day.
std::optional<double> findAcquisition(const DicomHeader& h) {
  const auto time = toSeconds(h.acquisitionTime);
  const auto seriesDay = parseDate(h.seriesDate), day = parseDate(h.acquisitionDate);
  return time && day && seriesDay ? *time + secondsPerDay * (*day - *seriesDay) : time;
}

/// Seconds from the injection to the scan; nullopt: not stated, or not from 0 s to a day.
std::optional<double> computeDelay(const DicomHeader& h) {
  const auto series = parseTime(h.seriesTime);
  const std::string& both = h.injectionDateTime; // YYYYMMDDHHMMSS, perhaps with a time zone
  const auto injection = both.size() >= 14
                             ? parseTime(both.substr(8, both.find_first_of("+-", 8) - 8))
                             : parseTime(h.injectionTime);
  if (!series || !injection)
    return std::nullopt;
  double delay = std::min(*series, findAcquisition(h).value_or(*series)) - *injection;
  const auto seriesDay = parseDate(h.seriesDate);
  const auto injectionDay = both.size() >= 14 ? parseDate(both.substr(0, 8)) : std::nullopt;
  if (seriesDay && injectionDay)
    delay += secondsPerDay * (*seriesDay - *injectionDay);
  else // on the last day before the scan
    delay -= secondsPerDay * std::floor(delay / secondsPerDay);
  return delay >= 0.0 && delay <= secondsPerDay ? std::optional(delay) : std::nullopt;
}

/// Decimals of a date and time, to compare; nullopt: no time is stated.
std::optional<std::pair<double, double>> getAcquisition(const DicomSlice& slice) {
  const DicomHeader& h = slice.header;
  if (!h.acquisitionTime)
    return std::nullopt;
  return std::pair(parseDate(h.acquisitionDate).value_or(0.0), *h.acquisitionTime);
}

/// The header with the date and time of the first acquisition of the series.
DicomHeader setFirstAcquisition(DicomHeader h, const DicomSeries& series) {
  std::optional<std::pair<double, double>> first;
  for (const DicomSlices& frame : series.frames)
    for (const DicomSlice& slice : frame)
      if (const auto one = getAcquisition(slice); one && (!first || *one < *first)) {
        first = one;
        h.acquisitionDate = slice.header.acquisitionDate;
        h.acquisitionTime = slice.header.acquisitionTime;
      }
  return h;
}

} // namespace

std::optional<double> computeSuvFactor(const DicomHeader& h, std::string& fault) {
  const auto refuse = [&](const auto&... what) {
    fault = concat(what...);
    return std::nullopt;
  };
  constexpr double heaviest = 500.0; // kg; beyond, it is in g
  constexpr double leastDose = 1e5;  // Bq; below, it is in MBq
  if (h.units != "BQML")
    return refuse("lacks Units BQML");
  if (!h.weight)
    return refuse("lacks PatientWeight");
  if (!(*h.weight > 0.0 && *h.weight <= heaviest))
    return refuse("states an implausible PatientWeight of ", toString(*h.weight), " kg");
  if (!h.dose)
    return refuse("lacks RadionuclideTotalDose");
  if (!(*h.dose >= leastDose))
    return refuse("states an implausible RadionuclideTotalDose of ", toString(*h.dose), " Bq");
  double dose = *h.dose;
  if (h.decayCorrection == "START") {
    const auto delay = computeDelay(h);
    if (!h.halfLife || !(*h.halfLife > 0.0) || !delay)
      return refuse("lacks RadionuclideHalfLife, SeriesTime or RadiopharmaceuticalStartTime");
    dose *= std::exp2(-*delay / *h.halfLife);
  } else if (h.decayCorrection != "ADMIN") {
    return refuse("lacks DecayCorrection START or ADMIN");
  }
  constexpr double gramsPerKilogram = 1000.0;
  const double factor = *h.weight * gramsPerKilogram / dose;
  return std::isfinite(factor) ? std::optional(factor) : refuse("lacks a plausible dose");
}

void convertToSuv(DicomSlices& slices, const DicomSeries& series, const std::string& name,
                  std::vector<Message>& warnings) {
  const DicomHeader header = setFirstAcquisition(slices.front().header, series);
  if (header.units == "GML")
    return;
  std::string fault;
  const auto factor = computeSuvFactor(header, fault);
  if (!factor) {
    warnings.push_back(makeMessage(ErrorCode::assumedUnits, name,
                                   "PET values are not SUV, since the header ", fault));
    return;
  }
  for (DicomSlice& slice : slices) {
    slice.header.slope *= *factor;
    slice.header.intercept *= *factor;
  }
}

} // namespace fenestra::core
