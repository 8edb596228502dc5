#include "identification/shot_model.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "identification/lateness.hpp"
#include "identification/motion_residuals.hpp"
#include "identification/motion_slope.hpp"
#include "identification/shot_player.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/parameter.hpp"

namespace zwidth::internal {

namespace {

/// Sampling periods.
constexpr double shortest_lag = 0.05;

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

/// The shots in runs of one record, each long enough for its device to be worth making; where each begins, and the end.
std::vector<std::size_t> batches(const std::vector<Shot>& shots) {
  constexpr std::size_t enough = 8000;  // samples
  std::vector<std::size_t> starts;
  std::size_t samples = 0;
  for (std::size_t i = 0; i < shots.size(); ++i) {
    if (i == 0 || shots[i].record != shots[i - 1].record || samples >= enough) {
      starts.push_back(i);
      samples = 0;
    }
    samples += shots[i].count;
  }
  starts.push_back(shots.size());
  return starts;
}

}  // namespace

Device without_short_lag(const Device& device) {
  DeviceParameters parameters = device.parameters();
  double& lag = parameters.actuator.time_constant;
  if (lag >= shortest_lag * parameters.loop.sampling_period || lag == 0.0) return device;
  parameters.loop.delay += std::exchange(lag, 0.0);
  return Device(std::move(parameters));
}

ShotModel::ShotModel(Device structure, std::vector<MotionRecord> records, std::vector<Coordinate> coordinates,
                     std::vector<std::string> locked, double most_parts)
    : structure_(std::move(structure)),
      records_(std::move(records)),
      coordinates_(std::move(coordinates)),
      locked_(std::move(locked)),
      most_parts_(most_parts) {
  for (const MotionRecord& record : records_) {
    const double change = rms_change(record.position);
    constexpr double typical_samples = 10.0;
    units_.push_back({rms(record.force), change * typical_samples, change / record.sampling_period});
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
  for (std::size_t i = 0; i + weak_forces_.size() < coordinates_.size(); ++i) {
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
    state(0) = (mean + slope * (static_cast<double>(shot.first) - middle)) / units_[shot.record].position;
    state.tail(this->states() / 2).setConstant(slope / record.sampling_period / units_[shot.record].velocity);
    states.push_back(std::move(state));
  }
  return states;
}

ShotModel ShotModel::at(const Eigen::VectorXd& x) const {
  ShotModel fixed = *this;
  fixed.structure_ = Device(parameters_at(x));
  fixed.coordinates_.clear();
  fixed.weak_forces_.clear();
  return fixed;
}

ShotModel ShotModel::with_forces(const std::vector<std::span<const double>>& forces) const {
  ShotModel other = *this;
  for (std::size_t r = 0; r < forces.size(); ++r) other.records_[r].force = forces[r];
  return other;
}

ShotModel ShotModel::with_weak_forces(std::vector<WeakForce> forces) const {
  ShotModel wider = *this;
  for (const WeakForce& each : forces) {
    wider.coordinates_.push_back({"body." + each.body + (each.length > 0.0 ? ".coulomb" : ".damping")});
  }
  wider.weak_forces_ = std::move(forces);
  return wider;
}

bool ShotModel::is_bounded(Eigen::Index i) const {
  const auto k = static_cast<std::size_t>(i);
  return k < coordinates_.size() && coordinates_[k].kind == Coordinate::Kind::not_negative;
}

bool ShotModel::is_short_lag(Eigen::Index i, double x) const {
  const auto k = static_cast<std::size_t>(i);
  return k < coordinates_.size() && coordinates_[k].key == lag_key && x < 2.0 * shortest_lag;
}

bool ShotModel::free_friction(DeviceParameters& parameters) const {
  constexpr double least = 1e-9;
  bool any = false;
  for (const Coordinate& each : coordinates_) {
    if (!each.key.ends_with(".coulomb") || *parameter(parameters, each.key) >= least * each.unit) continue;
    set_parameter(parameters, each.key, least * each.unit);
    any = true;
  }
  return any;
}

Device ShotModel::device_in(std::size_t record, const DeviceParameters& parameters) const {
  return without_short_lag(device_in_experiment(Device(parameters), locked_, records_[record].sampling_period));
}

PlayedParameter ShotModel::played(std::size_t i, double x, std::size_t record, const DeviceParameters& parameters,
                                  const Device& device) const {
  const Coordinate& coordinate = coordinates_[i];
  const double slope = coordinate.slope(x);
  const bool is_lag = coordinate.key == lag_key;
  if (coordinate.key == delay_key || (is_lag && !(device.parameters().actuator.time_constant > 0.0))) {
    return {{.switching = slope}};  // a lag too short to follow is a delay
  }
  PlayedParameter played;
  const std::size_t known = coordinates_.size() - weak_forces_.size();
  if (i >= known) {
    const auto& [body, length] = weak_forces_[i - known];
    const auto at = std::ranges::find(device.bodies(), body, &Body::name);
    played.weighing = {static_cast<std::size_t>(at - device.bodies().begin()), length};
  }
  if (coordinate.key.ends_with(".coulomb")) {
    for (const Body& body : device.bodies()) {
      played.motion.limits.push_back(coordinate.key == "body." + body.name + ".coulomb" ? slope : 0.0);
    }
    return played;
  }
  played.motion.matrix = slope * motion_slope(parameters, coordinate,
                                              [&](const DeviceParameters& each) { return device_in(record, each); });
  if (is_lag) played.of_lag = slope;
  return played;
}

PlayedShots::Motions PlayedShots::find(const Eigen::VectorXd& x, const std::vector<Shot>& shots,
                                       const std::vector<Eigen::VectorXd>& states) const {
  const std::lock_guard lock(mutex_);
  return motions_ && x == x_ && shots == shots_ && states == states_ ? motions_ : nullptr;
}

void PlayedShots::keep(const Eigen::VectorXd& x, const std::vector<Shot>& shots,
                       const std::vector<Eigen::VectorXd>& states, Motions motions) {
  const std::lock_guard lock(mutex_);
  x_ = x;
  shots_ = shots;
  states_ = states;
  motions_ = std::move(motions);
}

PlayedShots::Motions ShotModel::play(const Eigen::VectorXd& x, const std::vector<Shot>& shots,
                                     const std::vector<Eigen::VectorXd>& states, Slopes slopes,
                                     const PlayOn& play_on) const {
  PlayedShots& last = slopes == Slopes::exact ? last_with_slopes_ : last_plain_;
  if (PlayedShots::Motions motions = last.find(x, shots, states)) return motions;
  if (slopes == Slopes::none) {
    PlayedShots::Motions motions = last_with_slopes_.find(x, shots, states);
    DeviceParameters parameters = parameters_at(x);
    if (motions && !free_friction(parameters)) return motions;
  }
  std::optional<std::vector<ShotMotion>> played = play_anew(x, shots, states, slopes, play_on);
  for (std::size_t k = 0; played && slopes == Slopes::exact && k < coordinates_.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    if (!is_short_lag(i, x(i))) continue;
    constexpr double step = 0.1;  // sampling periods: what is left beside a delay is of the second order
    Eigen::VectorXd at = x;
    at(i) += step;
    const auto moved = play_anew(at, shots, states, Slopes::none, play_on);
    if (!moved) return nullptr;
    for (std::size_t shot = 0; shot < shots.size(); ++shot) {
      (*played)[shot].slopes.row(i) = ((*moved)[shot].positions - (*played)[shot].positions).transpose() / step;
    }
  }
  if (!played) return nullptr;
  auto motions = std::make_shared<const std::vector<ShotMotion>>(*std::move(played));
  last.keep(x, shots, states, motions);
  return motions;
}

std::optional<std::vector<ShotMotion>> ShotModel::play_anew(const Eigen::VectorXd& x, const std::vector<Shot>& shots,
                                                            const std::vector<Eigen::VectorXd>& states, Slopes slopes,
                                                            const PlayOn& play_on) const {
  std::vector<ShotMotion> motions(shots.size());
  const std::vector<std::size_t> starts = batches(shots);
  std::vector<char> is_played(starts.size(), 0);
  tbb::parallel_for(std::size_t{0}, starts.size() - 1, [&](std::size_t batch) {
    const std::size_t r = shots[starts[batch]].record;
    try {
      DeviceParameters parameters = parameters_at(x);
      if (slopes == Slopes::exact) free_friction(parameters);
      const Device device = device_in(r, parameters);
      const double constant = x(static_cast<Eigen::Index>(coordinates_.size() + r)) * units_[r].force;
      Player player(device, records_[r], units_[r], constant);
      if (player.parts_per_period() > most_parts_) return;
      if (slopes == Slopes::exact) {
        std::vector<PlayedParameter> all;
        for (std::size_t i = 0; i < coordinates_.size(); ++i) {
          all.push_back(played(i, x(static_cast<Eigen::Index>(i)), r, parameters, device));
        }
        player.follow_slopes(std::move(all));
      }
      for (std::size_t i = starts[batch]; i < starts[batch + 1]; ++i) {
        std::function<bool(const Eigen::Ref<const Eigen::VectorXd>&)> goes_on;
        if (play_on)
          goes_on = [&](const Eigen::Ref<const Eigen::VectorXd>& positions) { return play_on(i, positions); };
        if (!player.play(shots[i], states[i], motions[i], goes_on) || !motions[i].positions.allFinite()) return;
        if (!motions[i].slopes.allFinite()) return;
      }
      is_played[batch] = 1;
    } catch (const Error&) {  // no device has these numbers
    }
  });
  is_played.back() = 1;
  if (std::ranges::count(is_played, 0) > 0) return std::nullopt;
  return motions;
}

}  // namespace zwidth::internal
