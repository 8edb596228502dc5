#include "identification/verdict/plausible_device.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "model/implausible_numbers.hpp"
#include "zwidth/model/parameter.hpp"

namespace zwidth::internal {
namespace {

/// "ms" for a ratio of about 1000, "us" for a million, ...; nothing for a ratio that no unit explains.
std::string prefix_of(double ratio) {
  struct Prefix {
    double ratio;
    const char* name;
  };
  constexpr double close = 0.3;  // decades
  for (const Prefix& each : {Prefix{1e3, "milli"}, Prefix{1e6, "micro"}, Prefix{1e9, "nano"}, Prefix{1e-3, "kilo"}}) {
    if (std::abs(std::log10(ratio / each.ratio)) < close) return each.name;
  }
  return "";
}

/// A fitted mass beside the structure's.
struct OddMass {
  std::string key;
  double ratio;  ///< fitted over given
  /// Nobody knows a mass that badly.
  [[nodiscard]] bool is_beyond_belief() const {
    constexpr double hundred = 90.0;  // a fit finds a little less
    return ratio >= hundred || ratio <= 1.0 / hundred;
  }
};

/// Those that are a power of ten off; a fit finds it a little less than ten.
std::vector<OddMass> odd_masses(const Device& fitted, const Device& known) {
  constexpr double far = 9.0;
  std::vector<OddMass> found;
  for (const std::string& key : parameter_keys(known.parameters())) {
    if (!key.starts_with("body.") || !key.ends_with(".mass")) continue;
    const double ratio =
        parameter(fitted.parameters(), key).value_or(1.0) / parameter(known.parameters(), key).value_or(1.0);
    if (ratio >= far || ratio <= 1.0 / far) found.push_back({key, ratio});
  }
  return found;
}

Finding odd_mass_finding(const OddMass& odd) {
  Finding found{.code = FindingCode::mass_far_from_structure, .evidence = {{"ratio", odd.ratio}}, .key = odd.key};
  if (const std::string prefix = prefix_of(1.0 / odd.ratio); !prefix.empty()) {
    found.subjects.push_back({"prefix", prefix});
  }
  return found;
}

}  // namespace

std::optional<Finding> doubt_of_masses(const Device& fitted, const Device& structure, bool is_known) {
  const std::size_t bodies = structure.bodies().size();  // the fitted one may have a further one
  if (is_known) {
    const std::vector<OddMass> odd = odd_masses(fitted, structure);
    if (odd.size() < bodies || !std::ranges::all_of(odd, &OddMass::is_beyond_belief)) return std::nullopt;
    return odd_mass_finding(odd.front());
  }
  const double heaviest = fitted.parameters().motion == Motion::rotary ? 10.0 : 100.0;  // kg m^2, kg
  const std::vector<Remark> heavy = implausible_masses(fitted, heaviest);
  if (heavy.empty() || heavy.size() < bodies) return std::nullopt;
  Finding found = heavy.front().finding.value();
  found.code = FindingCode::fitted_body_too_heavy;
  return found;
}

std::vector<Remark> implausible_device(const Device& fitted, const Device* known,
                                       std::optional<double> recorded_period) {
  std::vector<Remark> remarks;
  const double period = fitted.loop().sampling_period;
  if (auto remark = implausible_period(period, "structure")) {
    remarks.push_back(*std::move(remark));
  } else if (recorded_period) {
    constexpr double far = 100.0;
    const double ratio = period / *recorded_period;
    if (ratio > far || ratio < 1.0 / far) {
      Finding found{.code = FindingCode::period_far_from_record,
                    .evidence = {{"period", period}, {"ratio", ratio}},
                    .key = "loop.sampling_period"};
      if (const std::string prefix = prefix_of(ratio); !prefix.empty()) found.subjects.push_back({"prefix", prefix});
      remarks.push_back(warning(std::move(found)));
    }
  }
  if (const auto remark = implausible_actuation_delay(fitted, recorded_period.value_or(period))) {
    Finding found = remark->finding.value();
    found.code = FindingCode::fitted_late_beyond_drives;
    remarks.push_back(warning(std::move(found)));
  }
  if (!known || doubt_of_masses(fitted, *known, true)) return remarks;
  for (const OddMass& each : odd_masses(fitted, *known)) remarks.push_back(warning(odd_mass_finding(each)));
  return remarks;
}

}  // namespace zwidth::internal
