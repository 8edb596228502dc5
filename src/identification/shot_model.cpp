#include "identification/shot_model.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "identification/friction_test.hpp"
#include "sampling/sampling_instants.hpp"
#include "simulation/continuous_motion.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/parameter.hpp"

namespace zwidth::internal {
namespace {

/// Stick-slip instants are met in parts of 1/rate: more of them per period would take for ever.
constexpr double most_parts_per_period = 60.0;
/// Sampling periods.
constexpr double shortest_lag = 0.05;

/// A lag far below the sampling period is too fast to follow, and no other than that much delay.
Device without_short_lag(const Device& device) {
  DeviceParameters parameters = device.parameters();
  double& lag = parameters.actuator.time_constant;
  if (lag >= shortest_lag * parameters.loop.sampling_period || lag == 0.0) return device;
  parameters.loop.delay += std::exchange(lag, 0.0);
  return Device(std::move(parameters));
}

double rms_change(std::span<const double> samples) {
  double sum = 0.0;
  for (std::size_t k = 1; k < samples.size(); ++k) sum += std::pow(samples[k] - samples[k - 1], 2);
  return std::sqrt(sum / static_cast<double>(samples.size()));
}

double rms(std::span<const double> samples) {
  double sum = 0.0;
  for (const double each : samples) sum += each * each;
  return std::sqrt(sum / static_cast<double>(samples.size()));
}

/// The lagged force as the shot begins: the filter of the commands before it.
double lagged_force(const Device& device, const MotionRecord& record, std::size_t first, double constant) {
  const double lag = device.parameters().actuator.time_constant;
  if (!(lag > 0.0)) return 0.0;
  const double period = record.sampling_period;
  const SamplingInstants instants = sampling_instants({period, device.loop().delay});
  constexpr double forgotten = 30.0;  // e^-30
  constexpr double most = 1e5;
  const auto length = static_cast<std::size_t>(std::min(most, std::ceil(forgotten * lag / period)));
  const auto at = [&](std::size_t k, std::size_t late) { return record.force[k < late ? 0 : k - late] + constant; };
  const double keeps_old = std::exp(-instants.with_old / lag);
  const double keeps_new = std::exp(-instants.with_new / lag);
  std::size_t k = first < length ? 0 : first - length;
  double force = at(k, instants.whole_samples + 1);
  for (; k < first; ++k) {
    const double old = at(k, instants.whole_samples + 1);
    const double now = at(k, instants.whole_samples);
    force = old + (force - old) * keeps_old;
    force = now + (force - now) * keeps_new;
  }
  return force;
}

/// One record's device on its way through the shots of that record.
class Player {
 public:
  Player(const Device& device, const MotionRecord& record, double constant)
      : device_(device),
        record_(record),
        constant_(constant),
        instants_(sampling_instants({record.sampling_period, device.loop().delay})),
        motion_(device, {},
                instants_.with_old > 0.0 ? std::vector{instants_.with_old, instants_.with_new}
                                         : std::vector{record.sampling_period}),
        positions_(device.bodies().size()),
        velocities_(device.bodies().size()) {}

  [[nodiscard]] bool can_be_followed() const {
    return motion_.rate() * record_.sampling_period <= most_parts_per_period;
  }

  /// False where stick-slip instants were cut off.
  bool play(const Shot& shot, const Eigen::VectorXd& state, double position_unit, double velocity_unit,
            Eigen::VectorXd& out) {
    start(shot, state, position_unit, velocity_unit);
    out.resize(static_cast<Eigen::Index>(shot.count));
    for (std::size_t i = 0; i < shot.count; ++i) {
      out(static_cast<Eigen::Index>(i)) = motion_.sensed();
      const std::size_t k = shot.first + i;
      if (instants_.with_old > 0.0) {
        motion_.set_command(command(k, instants_.whole_samples + 1));
        motion_.advance_recurring(0);
        motion_.set_command(command(k, instants_.whole_samples));
        motion_.advance_recurring(1);
      } else {
        motion_.set_command(command(k, instants_.whole_samples));
        motion_.advance_recurring(0);
      }
    }
    return motion_.overloaded() == 0;
  }

 private:
  [[nodiscard]] double command(std::size_t k, std::size_t late) const {
    return record_.force[k < late ? 0 : k - late] + constant_;
  }

  void start(const Shot& shot, const Eigen::VectorXd& state, double position_unit, double velocity_unit) {
    const std::size_t sensed = device_.loop().sensed;
    const std::size_t bodies = positions_.size();
    const double own = state(0) * position_unit;
    Eigen::Index next = 1;
    for (std::size_t i = 0; i < bodies; ++i) {
      positions_[i] = i == sensed ? own : own + state(next++) * position_unit;
    }
    for (std::size_t i = 0; i < bodies; ++i) velocities_[i] = state(next++) * velocity_unit;
    motion_.reset();
    motion_.set_lagged_force(lagged_force(device_, record_, shot.first, constant_));
    motion_.set_command(command(shot.first, instants_.whole_samples + (instants_.with_old > 0.0 ? 1 : 0)));
    motion_.set_motion(positions_.data(), velocities_.data());
  }

  const Device& device_;
  const MotionRecord& record_;
  double constant_;
  SamplingInstants instants_;
  ContinuousMotion motion_;
  std::vector<double> positions_;
  std::vector<double> velocities_;
};

}  // namespace

ShotModel::ShotModel(Device structure, std::vector<MotionRecord> records, std::vector<Coordinate> coordinates,
                     std::vector<std::string> locked)
    : structure_(std::move(structure)),
      records_(std::move(records)),
      coordinates_(std::move(coordinates)),
      locked_(std::move(locked)) {
  for (const MotionRecord& record : records_) {
    force_units_.push_back(rms(record.force));
    const double change = rms_change(record.position);
    velocity_units_.push_back(change / record.sampling_period);
    constexpr double typical_samples = 10.0;
    position_units_.push_back(change * typical_samples);
  }
  bodies_ = device_in_experiment(structure_, locked_, records_.front().sampling_period).bodies().size();
}

Eigen::VectorXd ShotModel::position_of(const DeviceParameters& parameters) const {
  Eigen::VectorXd x = Eigen::VectorXd::Zero(this->parameters());
  for (std::size_t i = 0; i < coordinates_.size(); ++i) {
    x(static_cast<Eigen::Index>(i)) = coordinates_[i].position(*parameter(parameters, coordinates_[i].key));
  }
  return x;
}

DeviceParameters ShotModel::parameters_at(const Eigen::VectorXd& x) const {
  DeviceParameters parameters = structure_.parameters();
  parameters.uncertainty.reset();
  for (std::size_t i = 0; i < coordinates_.size(); ++i) {
    set_parameter(parameters, coordinates_[i].key, coordinates_[i].value(x(static_cast<Eigen::Index>(i))));
  }
  return parameters;
}

std::vector<Eigen::VectorXd> ShotModel::recorded_states(const std::vector<Shot>& shots) const {
  std::vector<Eigen::VectorXd> states;
  for (const Shot& shot : shots) {
    constexpr std::size_t reach = 5;
    const MotionRecord& record = records_[shot.record];
    const std::size_t begin = shot.first < reach ? 0 : shot.first - reach;
    const std::size_t end = std::min(record.position.size(), shot.first + reach + 1);
    const auto n = static_cast<double>(end - begin);
    double mean = 0.0;
    for (std::size_t k = begin; k < end; ++k) mean += record.position[k] / n;
    double slope = 0.0;
    double squares = 0.0;
    const double middle = 0.5 * static_cast<double>(begin + end - 1);
    for (std::size_t k = begin; k < end; ++k) {
      slope += (static_cast<double>(k) - middle) * (record.position[k] - mean);
      squares += std::pow(static_cast<double>(k) - middle, 2);
    }
    slope /= squares;
    Eigen::VectorXd state = Eigen::VectorXd::Zero(this->states());
    state(0) = (mean + slope * (static_cast<double>(shot.first) - middle)) / position_units_[shot.record];
    state.tail(this->states() / 2).setConstant(slope / record.sampling_period / velocity_units_[shot.record]);
    states.push_back(std::move(state));
  }
  return states;
}

double ShotModel::difference_step(Eigen::Index i, double x) const {
  const auto k = static_cast<std::size_t>(i);
  constexpr double step = 1e-4;
  constexpr double long_step = 0.1;
  const bool is_short_lag =
      k < coordinates_.size() && coordinates_[k].key == "actuator.time_constant" && x < 2.0 * shortest_lag;
  return is_short_lag ? long_step : step;
}

bool ShotModel::is_bounded(Eigen::Index i) const {
  const auto k = static_cast<std::size_t>(i);
  return k < coordinates_.size() && coordinates_[k].kind == Coordinate::Kind::not_negative;
}

std::optional<ShotPositions> ShotModel::play(const Eigen::VectorXd& x, const std::vector<Shot>& shots,
                                             const std::vector<Eigen::VectorXd>& states) const {
  ShotPositions positions(shots.size());
  try {
    const Device fitted(parameters_at(x));
    for (std::size_t r = 0; r < records_.size(); ++r) {
      const Device device = without_short_lag(device_in_experiment(fitted, locked_, records_[r].sampling_period));
      const double constant = x(static_cast<Eigen::Index>(coordinates_.size() + r)) * force_units_[r];
      Player player(device, records_[r], constant);
      if (!player.can_be_followed()) return std::nullopt;
      for (std::size_t i = 0; i < shots.size(); ++i) {
        if (shots[i].record != r) continue;
        if (!player.play(shots[i], states[i], position_units_[r], velocity_units_[r], positions[i]))
          return std::nullopt;
        if (!positions[i].allFinite()) return std::nullopt;
      }
    }
  } catch (const Error&) {  // no device has these numbers
    return std::nullopt;
  }
  return positions;
}

}  // namespace zwidth::internal
