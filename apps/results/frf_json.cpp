#include "results/frf_json.hpp"

#include <cmath>
#include <optional>
#include <type_traits>

#include "report/text/quantity.hpp"

namespace zwidth::report {
namespace {

using Json = results::Json;

/// A number, or null where there is none: JSON has no infinity.
Json number_or_null(std::optional<double> value) {
  return value && std::isfinite(*value) ? Json(*value) : Json(nullptr);
}

Json in_hertz(const Interval& interval) {
  return Json::array({number_or_null(hertz(interval.lower)), number_or_null(hertz(interval.upper))});
}

Json to_json(const Interval& interval) {
  return Json::array({number_or_null(interval.lower), number_or_null(interval.upper)});
}

Json to_json(const MeasuredCrossover& crossover) {
  return {{"frequency_rad_s", crossover.frequency},
          {"stiffness", crossover.stiffness},
          {"limited_by", nullptr},
          {"poles_leaving", crossover.poles_leaving},
          {"frequency_hz", hertz(crossover.frequency)},
          {"frequency_interval_hz", in_hertz(crossover.frequency_interval)},
          {"stiffness_interval", to_json(crossover.stiffness_interval)}};
}

template <typename Value>
Json column(const std::vector<ResponseLine>& points, Value&& value) {
  Json array = Json::array();
  for (const ResponseLine& point : points) array.push_back(number_or_null(value(point)));
  return array;
}

void add_lines(Json& document, const FrequencyResponse& response) {
  const std::vector<ResponseLine> points = response_lines(response);
  document["frequency_hz"] = column(points, [](const ResponseLine& p) { return hertz(p.frequency); });
  const auto add = [&](const char* key, auto member) {
    document[key] = column(points, [member](const ResponseLine& p) { return p.*member; });
  };
  add("magnitude", &ResponseLine::magnitude);
  add("magnitude_lower", &ResponseLine::magnitude_lower);
  add("magnitude_upper", &ResponseLine::magnitude_upper);
  add("phase_rad", &ResponseLine::phase);
  add("phase_lower_rad", &ResponseLine::phase_lower);
  add("phase_upper_rad", &ResponseLine::phase_upper);
  add("coherence", &ResponseLine::coherence);
}

}  // namespace

const char* name_of(MeasuredStiffnessStatus status) {
  switch (status) {
    case MeasuredStiffnessStatus::found:
      return "found";
    case MeasuredStiffnessStatus::not_in_band:
      return "not_in_band";
    case MeasuredStiffnessStatus::undetermined:
      break;
  }
  return "undetermined";
}

results::Json remarks_json(const std::vector<Remark>& remarks) { return remarks; }

results::Json frf_json(const MeasuredFrf& frf, FrfContent content) {
  const FrequencyResponse& response = frf.response;
  Json document;
  document["schema"] = "zwidth.frf/1";
  document["recording"] = frf.recording;
  document["units"] = {
      {"force", frf.units.force}, {"position", frf.units.position}, {"stiffness", frf.units.stiffness()}};
  const MeasuredStiffness* stiffness = frf.stiffness ? &*frf.stiffness : nullptr;
  const bool found = stiffness && stiffness->status == MeasuredStiffnessStatus::found && stiffness->limit;
  document["status"] = stiffness ? Json(name_of(stiffness->status)) : Json(nullptr);
  if (found) {
    const MeasuredCrossover& limit = *stiffness->limit;
    document["critical_stiffness"] = limit.stiffness;
    document["critical_stiffness_db"] = decibels(limit.stiffness);
    document["critical_stiffness_interval"] = to_json(*stiffness_interval(*stiffness));
    document["critical_frequency_rad_s"] = limit.frequency;
    document["critical_frequency_hz"] = hertz(limit.frequency);
    document["critical_frequency_interval_hz"] = in_hertz(limit.frequency_interval);
  } else {
    for (const char* key : {"critical_stiffness", "critical_stiffness_db", "critical_stiffness_interval",
                            "critical_frequency_rad_s", "critical_frequency_hz", "critical_frequency_interval_hz"}) {
      document[key] = nullptr;
    }
  }
  document["limited_by"] = nullptr;
  document["softest_proven"] = stiffness && stiffness->limit ? to_json(*stiffness->limit) : Json(nullptr);
  document["crossovers"] = Json::array();
  document["doubtful_bands_hz"] = Json::array();
  if (stiffness) {
    for (const MeasuredCrossover& crossover : stiffness->crossovers) {
      document["crossovers"].push_back(to_json(crossover));
    }
    for (const Interval& band : stiffness->doubtful_bands) document["doubtful_bands_hz"].push_back(in_hertz(band));
  }
  document["measured_band_hz"] = stiffness ? in_hertz(stiffness->measured_band) : Json(nullptr);
  document["excited_band_hz"] = in_hertz({response.points.front().frequency, response.points.back().frequency});
  document["lines"] = response.points.size();
  document["averages"] = response.averages > 0.0 ? number_or_null(response.averages) : Json(nullptr);
  document["sampling_period_s"] = number_or_null(response.sampling_period);
  if (content == FrfContent::with_lines) add_lines(document, response);
  document["basis"] = {{"virtual_damping", 0.0}, {"velocity_filter_hz", 0.0}, {"filters", 0}};
  document["trust"] = frf.trust;
  document["remarks"] = remarks_json(frf.remarks);
  return document;
}

}  // namespace zwidth::report
