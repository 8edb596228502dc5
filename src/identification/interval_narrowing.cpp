#include "identification/interval_narrowing.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "identification/fit_judgement.hpp"
#include "model/uncertainty_problem.hpp"
#include "zwidth/quantity.hpp"
#include "zwidth/stability/stiffness_interval.hpp"

namespace zwidth::internal {
namespace {

/// The device with its least known parameter taken as known. Nothing where all are known well.
std::optional<Device> without_least_known(const Device& device) {
  DeviceParameters parameters = device.parameters();
  if (!parameters.uncertainty || parameters.uncertainty->parameters.size() < 2) return std::nullopt;
  constexpr double well = 0.1;  // one deviation
  const LeastKnown least = least_known(parameters, 0.0);
  if (least.share < well * well) return std::nullopt;
  parameters.uncertainty = given(*std::move(parameters.uncertainty), least.i);
  return Device(std::move(parameters));
}

}  // namespace

Finding interval_left_open(const StiffnessInterval& interval) {
  constexpr double unknown = 1000.0;
  const double factor = interval.upper / interval.lower;
  Finding found{.code = FindingCode::data_leave_interval_open,
                .evidence = {{"lower", interval.lower}, {"upper", interval.upper}}};
  if (interval.lower > 0.0) {
    found.evidence.push_back(factor > unknown ? Evidence{"more_than", unknown} : Evidence{"factor", factor});
  }
  return found;
}

std::optional<Finding> doubt_of_interval(const Identification& result) {
  const auto& interval = result.analysis.interval;
  if (!interval) {
    const bool knows_noise = result.fit.misfit.has_value();
    if (!knows_noise) return std::nullopt;
    return Finding{.code = FindingCode::no_interval};
  }
  if (is_inconclusive(*interval)) return interval_left_open(*interval);
  constexpr double wide = 1.4;
  constexpr double clear = 0.95;
  const auto& limit = result.analysis.critical.limit;
  if (!limit || !(interval->upper > wide * interval->lower)) return std::nullopt;
  const ResponsePoint& line = *std::ranges::min_element(result.response.points, {}, [&](const ResponsePoint& each) {
    return std::abs(each.frequency - limit->frequency);
  });
  if (line.coherence >= clear) return std::nullopt;
  return Finding{.code = FindingCode::noise_hides_limit,
                 .evidence = {{"frequency", hertz(limit->frequency)},
                              {"coherence", line.coherence},
                              {"threshold", clear},
                              {"factor", interval->upper / interval->lower}}};
}

void narrow_interval(Identification& result) {
  if (!result.analysis.interval) return;
  // Along a combination that does not show the response stays as it is: each may be taken as known once.
  auto combinations =
      std::ranges::count_if(result.fit.unidentifiable, [](const auto& each) { return each.parameters.size() > 1; });
  const auto is_wide = [&](const StiffnessInterval& interval) {
    constexpr double wide = 1.05;
    return is_inconclusive(interval) || (combinations > 0 && interval.upper > wide * interval.lower);
  };
  Device device = result.fit.device;
  Analysis analysis = result.analysis;
  while (is_wide(*analysis.interval)) {
    std::optional<Device> narrower = without_least_known(device);
    if (!narrower) break;
    device = *std::move(narrower);
    if (combinations > 0) --combinations;
    analysis = analyze(device, {.any_user = false});
    if (!analysis.interval) return;
  }
  const StiffnessInterval& narrow = *analysis.interval;
  const StiffnessInterval& wide = *result.analysis.interval;
  if (is_inconclusive(narrow) || (narrow.lower <= wide.lower && narrow.upper >= wide.upper)) return;
  result.fit.device = std::move(device);
  result.analysis = std::move(analysis);
}

}  // namespace zwidth::internal
