#include "results/bode_json.hpp"

#include <vector>

#include "results/csv.hpp"
#include "results/stability_json.hpp"
#include "results/units.hpp"

namespace zwidth::results {
namespace {

Json response_json(const std::vector<BodePoint>& points) {
  const auto column = [&](double BodePoint::*member) {
    std::vector<double> values;
    values.reserve(points.size());
    for (const BodePoint& point : points) values.push_back(point.*member);
    return values;
  };
  return {{"frequency_rad_s", column(&BodePoint::frequency)},
          {"magnitude_db", column(&BodePoint::magnitude_db)},
          {"phase_deg", column(&BodePoint::phase_deg)}};
}

}  // namespace

Json bode_json(const Device& device, const Bode& bode) {
  Json json = document("zwidth.bode/1");
  json["device"] = device.name();
  json["sampling_period_s"] = device.loop().sampling_period;
  json["delay_s"] = device.loop().delay;
  json["nyquist_rad_s"] = bode.nyquist;
  json["sampled"] = response_json(bode.sampled);
  json["continuous"] = response_json(bode.continuous);
  json["crossovers"] = bode.analysis.critical.crossovers;
  add_findings(json, bode.analysis);
  return json;
}

std::string bode_csv(const Bode& bode) {
  Csv csv({"frequency_rad_s", "frequency_hz", "magnitude_db", "phase_deg", "continuous_magnitude_db",
           "continuous_phase_deg", "trust"});
  for (std::size_t i = 0; i < bode.continuous.size(); ++i) {
    const BodePoint& continuous = bode.continuous[i];
    const auto sampled = i < bode.sampled.size() ? std::optional(bode.sampled[i]) : std::nullopt;
    csv.row(continuous.frequency, hertz(continuous.frequency),
            sampled ? std::optional(sampled->magnitude_db) : std::nullopt,
            sampled ? std::optional(sampled->phase_deg) : std::nullopt, continuous.magnitude_db, continuous.phase_deg,
            bode.analysis.trust);
  }
  return csv.text();
}

}  // namespace zwidth::results
