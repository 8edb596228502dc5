#include "results/frf_json.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <optional>
#include <vector>

#include "results/csv.hpp"
#include "results/identification_json.hpp"
#include "results/units.hpp"
#include "zwidth/io/recording_file.hpp"

namespace zwidth::results {

void to_json(Json& json, const Interval& interval) { json = Json::array({interval.lower, interval.upper}); }

namespace {

/// "N m" and "m/s" in brackets below a fraction's line.
std::string in_brackets(const std::string& unit) {
  return unit.find_first_of(" /*") == std::string::npos ? unit : "(" + unit + ")";
}

Interval in_hertz(const Interval& interval) { return {hertz(interval.lower), hertz(interval.upper)}; }

std::optional<double> in_degrees(std::optional<double> angle) {
  return angle ? std::optional(degrees(*angle)) : std::nullopt;
}

}  // namespace

FrfUnits frf_units(const MeasuredResponse& measured) {
  FrfUnits units;
  if (!measured.force_unit.empty()) units.force = measured.force_unit;
  if (!measured.length_unit.empty()) units.position = measured.length_unit;
  return units;
}

FrfUnits frf_units(const Device& device) {
  const Units units = units_of(device.parameters().motion);
  return {std::string(units.force), std::string(units.length)};
}

static void to_json(Json& json, const MeasuredCrossover& crossover) {
  json = {{"frequency_rad_s", crossover.frequency},
          {"stiffness", crossover.stiffness},
          {"limited_by", nullptr},
          {"poles_leaving", crossover.poles_leaving},
          {"frequency_hz", hertz(crossover.frequency)},
          {"frequency_interval_hz", in_hertz(crossover.frequency_interval)},
          {"stiffness_interval", crossover.stiffness_interval}};
}

static void to_json(Json& json, const AmplitudeDependence& found) {
  json = {{"difference", found.difference}, {"force_ratio", found.force_ratio},
          {"lines", found.lines},           {"grows_with_force", found.grows_with_force},
          {"friction", found.friction},     {"friction_deviation", found.friction_deviation}};
}

namespace {

void add_lines(Json& document, const FrequencyResponse& response) {
  const std::vector<ResponseLine> lines = response_lines(response);
  Json frequencies = Json::array();
  for (const ResponseLine& line : lines) frequencies.push_back(hertz(line.frequency));
  document["frequency_hz"] = std::move(frequencies);
  const auto add = [&](const char* key, auto member) {
    Json column = Json::array();
    for (const ResponseLine& line : lines) column.push_back(line.*member);
    document[key] = std::move(column);
  };
  add("magnitude", &ResponseLine::magnitude);
  add("magnitude_lower", &ResponseLine::magnitude_lower);
  add("magnitude_upper", &ResponseLine::magnitude_upper);
  add("phase_rad", &ResponseLine::phase);
  add("phase_lower_rad", &ResponseLine::phase_lower);
  add("phase_upper_rad", &ResponseLine::phase_upper);
  add("coherence", &ResponseLine::coherence);
}

/// What is null where it is not found: all but the frequency is that of `limit`.
void add_limit(Json& document, const MeasuredStiffness* stiffness) {
  const bool found = stiffness && stiffness->status == MeasuredStiffnessStatus::found && stiffness->limit;
  const auto limit = found ? stiffness->limit : std::nullopt;
  const auto frequency = limit ? std::optional(limit->frequency) : std::nullopt;
  const auto value = limit ? std::optional(limit->stiffness) : std::nullopt;
  document["critical_stiffness"] = value;
  document["critical_stiffness_db"] = decibels(value);
  document["critical_stiffness_interval"] = limit ? stiffness_interval(*stiffness) : std::nullopt;
  document["critical_frequency_rad_s"] = frequency;
  document["critical_frequency_hz"] = hertz(frequency);
  document["critical_frequency_interval_hz"] =
      limit ? std::optional(in_hertz(limit->frequency_interval)) : std::nullopt;
}

}  // namespace

std::string FrfUnits::stiffness() const { return force + "/" + in_brackets(position); }
std::string FrfUnits::compliance() const { return position + "/" + in_brackets(force); }

Json frf_json(const MeasuredResponse& measured, const FrfUnits& units, FrfContent content) {
  const FrequencyResponse& response = measured.response;
  const MeasuredStiffness* stiffness = measured.stiffness ? &*measured.stiffness : nullptr;
  Json json = document("zwidth.frf/1");
  json["recording"] = measured.source;
  json["units"] = {{"force", units.force}, {"position", units.position}, {"stiffness", units.stiffness()}};
  json["status"] = stiffness ? Json(stiffness->status) : Json(nullptr);
  add_limit(json, stiffness);
  json["limited_by"] = nullptr;
  json["softest_proven"] = stiffness ? stiffness->limit : std::nullopt;
  json["crossovers"] = stiffness ? Json(stiffness->crossovers) : Json::array();
  json["doubtful_bands_hz"] = Json::array();
  if (stiffness) {
    for (const Interval& band : stiffness->doubtful_bands) json["doubtful_bands_hz"].push_back(in_hertz(band));
  }
  json["measured_band_hz"] = stiffness ? std::optional(in_hertz(stiffness->measured_band)) : std::nullopt;
  json["excited_band_hz"] = in_hertz({response.points.front().frequency, response.points.back().frequency});
  json["lines"] = response.points.size();
  json["averages"] = response.averages > 0.0 ? std::optional(response.averages) : std::nullopt;
  json["amplitude_dependence"] = measured.dependence;
  json["sampling_period_s"] = response.sampling_period;
  if (content == FrfContent::with_lines) add_lines(json, response);
  json["basis"] = StiffnessBasis{};
  add_findings(json, measured);
  return json;
}

std::string frf_csv(const MeasuredResponse& measured) {
  const FrequencyResponse& response = measured.response;
  Csv csv({"frequency_rad_s", "frequency_hz", "magnitude", "magnitude_lower", "magnitude_upper", "phase_deg",
           "phase_lower_deg", "phase_upper_deg", "coherence", "real", "imaginary", "trust", "trust_reasons"});
  const std::vector<ResponseLine> lines = response_lines(response);
  const std::string reasons = fmt::format("{}", fmt::join(measured.trust.reasons, between_reasons));
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const ResponseLine& line = lines[i];
    const std::complex<double>& value = response.points[i].value;
    csv.row(line.frequency, hertz(line.frequency), line.magnitude, line.magnitude_lower, line.magnitude_upper,
            in_degrees(line.phase), in_degrees(line.phase_lower), in_degrees(line.phase_upper), line.coherence,
            value.real(), value.imag(), measured.trust, i == 0 ? reasons : "");
  }
  return csv.text();
}

}  // namespace zwidth::results
