#include "identification/model/played_device.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "model/loop_keys.hpp"

namespace zwidth::internal {
namespace {

constexpr int finest_substeps = 64;  // of a sampling period: where a body among others stops, starts or turns

PlayedDevice::Step step_of(LinearStep linear, const std::vector<PlayedDevice::Friction>& frictions) {
  const auto count = static_cast<Eigen::Index>(frictions.size());
  const Eigen::Index states = linear.columns.rows();
  const Eigen::Index bodies = linear.columns.cols() - states - 1;
  Eigen::MatrixXd compliance = Eigen::MatrixXd::Zero(count, count);
  for (Eigen::Index on = 0; on < count; ++on) {
    for (Eigen::Index of = 0; of < count; ++of) {
      for (const auto& [moved, with] : frictions[static_cast<std::size_t>(on)].bodies) {
        for (const auto& [pushed, sign] : frictions[static_cast<std::size_t>(of)].bodies)
          compliance(on, of) += with * sign * linear.columns(bodies + moved, states + 1 + pushed);
      }
    }
  }
  return {std::move(linear), std::move(compliance)};
}

}  // namespace

PlayedDevice::PlayedDevice(const DeviceFamily& family, const MotionTerms& terms, const std::vector<std::string>& bodies,
                           std::size_t record, double largest_force, double period, int substeps,
                           const Eigen::VectorXd& x, bool with_slopes_asked)
    : with_slopes(with_slopes_asked) {
  const std::vector<Number>& numbers = family.numbers();
  const auto place = [&](const std::string& key) {
    return static_cast<Eigen::Index>(std::ranges::find(numbers, key, &Number::key) - numbers.begin());
  };
  const auto value = [&](Eigen::Index i) { return numbers[static_cast<std::size_t>(i)].value(x(i)); };
  const auto index = [&](const std::string& name) { return std::ranges::find(bodies, name) - bodies.begin(); };
  number_slopes.resize(x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const Number& number = numbers[static_cast<std::size_t>(i)];
    number_slopes(i) = number.slope(x(i));
    if (number.key == key_of_delay) instants.emplace_back(i, number_slopes(i));
    if (number.key == key_of_lag) instants.emplace_back(i, -number_slopes(i));  // the sum stays
  }
  for (const ForceTerm& term : terms.forces) {
    if (term.record && *term.record != record) continue;
    Force force{.law = term.law, .body = index(term.body)};
    for (std::size_t i = 0; i < term.numbers.size(); ++i) {
      force.numbers[i] = place(term.numbers[i]);
      force.values[i] = value(force.numbers[i]);
    }
    forces.push_back(force);
  }
  for (const FrictionTerm& term : terms.frictions) {
    frictions.push_back({.number = place(term.number), .limit = value(place(term.number))});
    frictions.back().bodies.push_back({index(term.body), 1.0});
    if (term.against) frictions.back().bodies.push_back({index(*term.against), -1.0});
    const bool rubs = frictions.back().limit > 0.0;
    if (rubs) ++rubbing;
    if (!term.presliding_length) continue;
    constexpr double least_length = 0.01;  // of a unit: shorter, and it sticks
    const Eigen::Index length = place(*term.presliding_length);
    if (value(length) < least_length * numbers[static_cast<std::size_t>(length)].unit) continue;
    frictions.back().length_number = length;
    frictions.back().length = value(length);
    if (rubs) frictions.back().bend = bends++;
  }
  if (terms.drive.dead_band) dead_band_number = place(*terms.drive.dead_band);
  if (terms.drive.saturation) saturation_number = place(*terms.drive.saturation);
  if (terms.drive.delay_drift) {
    drift_number = place(*terms.drive.delay_drift);
    drift = value(*drift_number) / period;
    drift_slope = number_slopes(*drift_number) / period;
  }
  dead_band = dead_band_number ? value(*dead_band_number) : 0.0;
  limit = largest_force - (saturation_number ? value(*saturation_number) : 0.0);

  const double samples = family.played_delay(x) / period;
  constexpr double least = 1e-9;
  delay_samples = static_cast<std::ptrdiff_t>(std::floor(samples + least));
  const double share = std::max(0.0, samples - static_cast<double>(delay_samples));
  const Eigen::MatrixXd columns = motion_columns(family.recorded_device(x));
  input = columns.col(columns.rows());
  const std::vector<Eigen::MatrixXd> slopes = with_slopes ? motion_slopes(family, x) : std::vector<Eigen::MatrixXd>{};
  const int wanted = forces.empty() && frictions.empty() ? 1 : substeps;
  // Forces on one body hardly change within a step, and its stops are exact (friction_step()).
  const int finest = rubbing > 0 && bodies.size() > 1 ? finest_substeps : wanted;
  const auto steps = [&](double length) {
    Steps made;
    if (length < least) return made;
    made.count = std::max(1, static_cast<int>(std::lround(length * wanted)));
    double each = length * period / made.count;
    for (int parts = wanted; parts <= finest; parts *= 2, each *= 0.5)
      made.halves.push_back(step_of(linear_step(columns, slopes, each), frictions));
    return made;
  };
  before = steps(share);
  after = steps(1.0 - share);
}

}  // namespace zwidth::internal
