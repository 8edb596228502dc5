#include "zwidth/model/wall_filter.hpp"

#include <algorithm>
#include <cmath>

#include "counted.hpp"
#include "model/key_members.hpp"

namespace zwidth {
using namespace internal;
namespace {

constexpr double smallest_frequency = 1e-30;  // Hz: its square is still a number

using Found = std::optional<OptionProblem>;

Found check_range(const char* member, double value) {
  const NumberRange range = key_of(DeviceTable::filter, member).range.value();
  if (range.contains(value)) return std::nullopt;
  return option_problem(member, {.code = ProblemCode::not_between,
                                 .evidence = {{"value", value}, {"least", range.least}, {"most", range.greatest}}});
}

// All roots in Re s < 0: for degrees 1 and 2, all coefficients of one sign.
bool is_stable_in_s(const std::vector<double>& d) {
  return std::ranges::all_of(d, [&](double c) { return c * d.front() > 0.0; });
}

// All roots in |z| < 1: |a1| < 1 for z + a1; |a2| < 1 and |a1| < 1 + a2 for z² + a1 z + a2.
bool is_stable_in_z(const std::vector<double>& d) {
  const double a1 = d[1] / d[0];
  if (d.size() == 2) return std::abs(a1) < 1.0;
  const double a2 = d[2] / d[0];
  return std::abs(a2) < 1.0 && std::abs(a1) < 1.0 + a2;
}

double sum(const std::vector<double>& coefficients) {
  double total = 0.0;
  for (const double c : coefficients) total += c;
  return total;
}

Found check_coefficients(const WallFilter& filter) {
  const bool digital = filter.kind == WallFilter::Kind::digital;
  const std::vector<double>& numerator = filter.numerator;
  const std::vector<double>& denominator = filter.denominator;
  if (denominator.size() < 2 || denominator.size() > 3) {
    return option_problem(
        "denominator", {.code = ProblemCode::number_of_coefficients,
                        .evidence = {counted("count", denominator.size()), counted("least", 2), counted("most", 3)}});
  }
  if (numerator.empty() || numerator.size() > denominator.size()) {
    return option_problem(
        "numerator", {.code = ProblemCode::number_of_coefficients,
                      .evidence = {counted("count", numerator.size()), counted("denominator", denominator.size())}});
  }
  for (const std::vector<double>* each : {&numerator, &denominator}) {
    for (const double c : *each) {
      if (c == 0.0 || (std::abs(c) >= smallest_coefficient && std::abs(c) <= largest_coefficient)) continue;
      return option_problem(
          each == &numerator ? "numerator" : "denominator",
          {.code = ProblemCode::coefficient_out_of_range,
           .evidence = {{"value", c}, {"least", smallest_coefficient}, {"most", largest_coefficient}}});
    }
  }
  if (denominator.front() == 0.0) {
    return option_problem("denominator", {.code = ProblemCode::begins_with_zero});
  }
  if (digital ? !is_stable_in_z(denominator) : !is_stable_in_s(denominator)) {
    return option_problem("denominator",
                          {.code = ProblemCode::filter_not_stable, .subjects = {{"variable", digital ? "z" : "s"}}});
  }
  const double gain = digital ? sum(numerator) / sum(denominator) : numerator.back() / denominator.back();
  if (!(gain > 0.0)) {
    return option_problem("numerator", {.code = ProblemCode::static_gain_not_positive, .evidence = {{"gain", gain}}});
  }
  return std::nullopt;
}

Found check_frequency(const WallFilter& filter, double sampling_period) {
  using enum WallFilter::Kind;
  const double nyquist = 0.5 / sampling_period;
  if (filter.kind == digital) {
    if (filter.frequency_hz == 0.0) return std::nullopt;
    return option_problem("frequency_hz", {.code = ProblemCode::frequency_of_digital_filter,
                                           .evidence = {{"value", filter.frequency_hz}}});
  }
  if (filter.kind == biquad && filter.frequency_hz == 0.0) return std::nullopt;
  if (filter.frequency_hz >= smallest_frequency && filter.frequency_hz < nyquist) return std::nullopt;
  return option_problem(
      "frequency_hz",
      {.code = ProblemCode::filter_frequency_out_of_range,
       .evidence = {{"value", filter.frequency_hz}, {"least", smallest_frequency}, {"nyquist", nyquist, "Hz"}}});
}

}  // namespace

std::optional<OptionProblem> find_problem(const WallFilter& filter, double sampling_period) {
  using enum WallFilter::Kind;
  if (auto problem = check_frequency(filter, sampling_period)) return problem;
  const auto damping_ratio = [&] { return check_range("damping_ratio", filter.damping_ratio); };
  switch (filter.kind) {
    case low_pass:
      if (filter.order != 1 && filter.order != 2) {
        return option_problem("order", {.code = ProblemCode::not_one_of,
                                        .evidence = {{"value", static_cast<double>(filter.order)}},
                                        .subjects = {{"choices", "1 or 2"}}});
      }
      return filter.order == 2 ? damping_ratio() : std::nullopt;
    case notch:
      if (auto problem = damping_ratio()) return problem;
      return check_range("depth", filter.depth);
    case lead_lag:
      return check_range("ratio", filter.ratio);
    case biquad:
    case digital:
      return check_coefficients(filter);
  }
  return std::nullopt;
}

}  // namespace zwidth
