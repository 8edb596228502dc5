#include "identification/contradicted_numbers.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "identification/model/device_numbers.hpp"
#include "identification/optimiser/bounded_step.hpp"
#include "identification/verdict/log_critical_stiffness.hpp"
#include "identification/verdict/profile.hpp"
#include "model/loop_keys.hpp"
#include "zwidth/identification/parameter_fit.hpp"

namespace zwidth::internal {
namespace {

/// The numbers of the structure that were not free, but for those of the loop.
std::vector<Number> numbers_given(const MotionStart& start, const std::vector<std::string>& locked) {
  const RivalSetting setting = rival_setting(start.device, locked, start.records);
  const TypicalSizes typical{setting.sampling_period, typical_damping(setting), typical_stiffness(setting)};
  std::vector<Number> given;
  for (const std::string& key : fittable_parameters(Device(start.device), locked)) {
    const bool is_of_loop = key == key_of_delay || key == key_of_lag;
    if (!is_of_loop && !start.parts.has(key)) given.push_back(device_number(key, start.device, typical));
  }
  return given;
}

}  // namespace

std::vector<Finding> contradicted_numbers(const FoundMotion& found, const MotionStart& start,
                                          const std::vector<std::string>& locked, const Interval& interval,
                                          const std::string& source) {
  constexpr double significant = 5.0;
  std::vector<Number> numbers = numbers_given(start, locked);
  const auto count = static_cast<Eigen::Index>(numbers.size());
  if (count == 0) return {};
  numbers.insert(numbers.end(), start.parts.numbers.begin(), start.parts.numbers.end());
  const DeviceFamily family(start.device, numbers, locked);
  const MotionModel model(family, start.parts.terms, start.records, found.model->substeps());
  const auto order = static_cast<Eigen::Index>(found.evidence->noise().front().filter.size()) - 1;
  const auto evidence = std::make_shared<TimeEvidence>(model, found.evidence->segments(), start.encoder_steps, order);
  evidence->set_noise(found.evidence->noise());
  const Likelihood likelihood(model.numbers(), {evidence});
  Eigen::VectorXd z(count + found.best.z.size());
  z << family.coordinates_of(start.device).head(count), found.best.z;
  const auto picture = likelihood.picture(z);
  if (!picture) return {};
  const Eigen::VectorXd step = bounded_step(picture->hessian, picture->gradient, likelihood.lowest() - z);
  const auto log_then = log_critical_stiffness(family.device_at(z + step));
  const double then = log_then ? std::exp(*log_then) : 0.0;
  if (then >= interval.lower && then <= interval.upper) return {};
  const Eigen::MatrixXd covariance = covariance_of(picture->hessian);
  std::vector<Finding> findings;
  for (Eigen::Index i = 0; i < count; ++i) {
    if (std::abs(step(i)) <= significant * std::sqrt(std::max(0.0, covariance(i, i)))) continue;
    const Number& number = numbers[static_cast<std::size_t>(i)];
    findings.push_back({.code = FindingCode::residual_stands_out,
                        .evidence = {{"given", number.value(z(i))}, {"shown", number.value(z(i) + step(i))}},
                        .subjects = {{"source", source}, {"kind", "given"}, {"number", number.key}},
                        .key = number.key,
                        .effect = {{"critical_stiffness", then}}});
  }
  return findings;
}

}  // namespace zwidth::internal
