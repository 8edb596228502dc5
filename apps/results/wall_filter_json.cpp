#include "results/wall_filter_json.hpp"

#include "zwidth/io/wall_filter_type.hpp"
#include "zwidth/sampling/filter_section.hpp"

namespace zwidth::results {
namespace {

Json coefficients_json(const FilterCoefficients& coefficients) {
  return {{"numerator", coefficients.numerator}, {"denominator", coefficients.denominator}};
}

Json filter_json(const WallFilter& filter, double sampling_period) {
  using enum WallFilter::Kind;
  Json json{{"type", wall_filter_type(filter.kind)}};
  if (filter.frequency_hz > 0.0) json["frequency_hz"] = filter.frequency_hz;
  if (filter.kind == low_pass) json["order"] = filter.order;
  if (filter.kind == notch || (filter.kind == low_pass && filter.order == 2)) {
    json["damping_ratio"] = filter.damping_ratio;
  }
  if (filter.kind == notch) json["depth"] = filter.depth;
  if (filter.kind == lead_lag) json["ratio"] = filter.ratio;
  if (filter.kind == biquad || filter.kind == digital) {
    json["numerator"] = filter.numerator;
    json["denominator"] = filter.denominator;
  }
  const FilterSection section = filter_section(filter, sampling_period);
  json["z"] = coefficients_json(in_z(section));
  json["delta"] = coefficients_json(in_delta(section));
  return json;
}

}  // namespace

Json wall_filters_json(const Wall& wall, double sampling_period) {
  Json filters = Json::array();
  for (const WallFilter& filter : wall.filters) filters.push_back(filter_json(filter, sampling_period));
  return filters;
}

}  // namespace zwidth::results
