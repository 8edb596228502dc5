#include "identification/model/motion_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "identification/model/friction_step.hpp"
#include "identification/model/linear_step.hpp"
#include "zwidth/identification/parameter_fit.hpp"
#include "zwidth/model/parameter.hpp"

namespace zwidth::internal {
namespace {

constexpr Eigen::Index most_states = 13;
constexpr Eigen::Index most_columns = 80;
using State = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, most_states, 1>;
using Slopes = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, most_states, most_columns>;
using Row = Eigen::Matrix<double, 1, Eigen::Dynamic, 1, 1, most_columns>;

bool is_of_device(const DeviceParameters& parameters, const std::string& key) { return parameter(parameters, key).has_value(); }

Device device_in(const DeviceParameters& parameters, const std::vector<std::string>& locked) {
  const Device device(parameters);
  std::vector<std::size_t> still;
  for (const std::string& name : locked) still.push_back(device.body_index(name));
  return still.empty() ? device : locked_device(device, still);
}

}  // namespace

/// The device at x in a record: its steps, and where the terms act.
struct MotionModel::Prepared {
  struct Step {
    int count = 0;  // parts of this length, before or after the command changes
    Eigen::MatrixXd columns;
    std::vector<Eigen::MatrixXd> slopes;
  };
  struct Force {
    const ForceLaw* law = nullptr;
    Eigen::Index body = 0;
    Eigen::Index against = -1;
    std::size_t number = 0;
    std::array<double, most_numbers_of_law> values = {};
  };
  struct Friction {
    Eigen::Index body = 0;
    std::size_t number = 0;
    double limit = 0.0;
  };
  Eigen::VectorXd x;
  bool with_slopes = false;
  Step before;                      // under the older command
  Step after;                       // under the newer
  std::ptrdiff_t delay_samples = 0;  // of the newer command
  Eigen::VectorXd input;            // b
  std::vector<std::pair<std::size_t, double>> delays;  // numbers that move the change of the command, s per unit of x
  std::vector<std::size_t> device_columns;  // of the numbers that the steps' slopes belong to
  std::vector<Force> forces;
  std::vector<Friction> frictions;
  std::vector<double> number_slopes;  // d value / dx
  double dead_band = 0.0;
  double limit = 0.0;
};

MotionModel::MotionModel(DeviceParameters structure, std::vector<std::string> locked, std::vector<ForceMotionRecord> records,
                         std::vector<Number> numbers, MotionTerms terms, int parts)
    : structure_(std::move(structure)),
      locked_(std::move(locked)),
      records_(std::move(records)),
      numbers_(std::move(numbers)),
      terms_(std::move(terms)),
      parts_(parts) {
  structure_.uncertainty.reset();
  for (const ForceMotionRecord& record : records_) {
    double squares = 0.0;
    for (std::size_t k = 1; k < record.position.size(); ++k) squares += std::pow(record.position[k] - record.position[k - 1], 2);
    const double change = std::sqrt(squares / static_cast<double>(record.position.size()));
    double largest = 0.0;
    for (const double each : record.force) largest = std::max(largest, std::abs(each));
    constexpr double typical_samples = 10.0;
    units_.push_back({change * typical_samples, change / record.sampling_period, largest});
  }
  const Device device = device_in(structure_, locked_);
  bodies_ = static_cast<Eigen::Index>(device.bodies().size());
  sensed_ = static_cast<Eigen::Index>(device.loop().sensed);
  actuated_ = static_cast<Eigen::Index>(device.loop().actuated);
  for (const Body& body : device.bodies()) names_.push_back(body.name);
}

DeviceParameters MotionModel::values_at(const Eigen::VectorXd& x) const {
  DeviceParameters parameters = structure_;
  for (std::size_t i = 0; i < numbers_.size(); ++i) {
    if (!is_of_device(structure_, numbers_[i].key)) continue;
    set_parameter(parameters, numbers_[i].key, numbers_[i].value(x(static_cast<Eigen::Index>(i))));
  }
  return parameters;
}

DeviceParameters MotionModel::device_at(const Eigen::VectorXd& x) const {
  DeviceParameters parameters = values_at(x);
  const bool has_lag = std::ranges::any_of(numbers_, [](const Number& each) { return each.key == "actuator.time_constant"; });
  if (!has_lag) return parameters;
  double& lag = parameters.actuator.time_constant;
  const double lateness = parameters.loop.delay;
  if (lag > lateness) lag = lateness;
  parameters.loop.delay = lateness - lag;
  return parameters;
}

double MotionModel::played_delay(const Eigen::VectorXd& x) const {
  const DeviceParameters parameters = values_at(x);
  const bool has_lag = std::ranges::any_of(numbers_, [](const Number& each) { return each.key == "actuator.time_constant"; });
  return parameters.loop.delay - (has_lag ? parameters.actuator.time_constant : 0.0);
}

Eigen::VectorXd MotionModel::recorded_state(const Segment& segment) const {
  constexpr std::size_t reach = 5;
  const ForceMotionRecord& record = records_[segment.record];
  const std::size_t begin = segment.first < reach ? 0 : segment.first - reach;
  const std::size_t end = std::min(record.position.size(), segment.first + reach + 1);
  const auto n = static_cast<double>(end - begin);
  const double middle = 0.5 * static_cast<double>(begin + end - 1);
  double mean = 0.0;
  double slope = 0.0;
  double squares = 0.0;
  for (std::size_t k = begin; k < end; ++k) mean += record.position[k] / n;
  for (std::size_t k = begin; k < end; ++k) {
    slope += (static_cast<double>(k) - middle) * (record.position[k] - mean);
    squares += std::pow(static_cast<double>(k) - middle, 2);
  }
  slope /= squares;
  Eigen::VectorXd state = Eigen::VectorXd::Zero(states());
  state(0) = (mean + slope * (static_cast<double>(segment.first) - middle)) / units_[segment.record].position;
  state.tail(bodies_).setConstant(slope / record.sampling_period / units_[segment.record].velocity);
  return state;
}

MotionModel::Prepared MotionModel::prepared(const Eigen::VectorXd& x, std::size_t record, bool with_slopes) const {
  Prepared now;
  now.x = x;
  now.with_slopes = with_slopes;
  for (std::size_t i = 0; i < numbers_.size(); ++i) now.number_slopes.push_back(numbers_[i].slope(x(static_cast<Eigen::Index>(i))));
  DeviceParameters parameters = values_at(x);
  const Device device = device_in(parameters, locked_);
  const Eigen::MatrixXd columns = motion_columns(device);
  now.input = columns.col(columns.rows());
  std::vector<Eigen::MatrixXd> slopes;
  for (std::size_t i = 0; with_slopes && i < numbers_.size(); ++i) {
    if (!is_of_device(structure_, numbers_[i].key)) continue;
    const double slope = numbers_[i].slope(x(static_cast<Eigen::Index>(i)));
    if (numbers_[i].key == "loop.delay") {
      now.delays.emplace_back(i, slope);
      continue;
    }
    if (numbers_[i].key == "actuator.time_constant") now.delays.emplace_back(i, -slope);  // the sum stays
    now.device_columns.push_back(i);
    slopes.emplace_back(slope * motion_columns_slope(parameters, numbers_[i].key, numbers_[i].unit, locked_));
  }
  for (const ForceTerm& term : terms_.forces) {
    if (term.record && *term.record != record) continue;
    Prepared::Force force{term.law.get(), std::ranges::find(names_, term.body) - names_.begin(), -1, term.number, {}};
    if (!term.against.empty()) force.against = std::ranges::find(names_, term.against) - names_.begin();
    for (std::size_t i = 0; i < most_numbers_of_law && term.number + i < numbers_.size(); ++i) {
      force.values[i] = numbers_[term.number + i].value(x(static_cast<Eigen::Index>(term.number + i)));
    }
    now.forces.push_back(force);
  }
  for (const FrictionTerm& term : terms_.frictions) {
    now.frictions.push_back({std::ranges::find(names_, term.body) - names_.begin(), term.number,
                             numbers_[term.number].value(x(static_cast<Eigen::Index>(term.number)))});
  }
  const auto number = [&](std::size_t i) { return numbers_[i].value(x(static_cast<Eigen::Index>(i))); };
  now.limit = units_[record].largest_force - (terms_.drive.saturation ? number(*terms_.drive.saturation) : 0.0);
  now.dead_band = terms_.drive.dead_band ? number(*terms_.drive.dead_band) : 0.0;
  const double period = records_[record].sampling_period;
  const double samples = played_delay(x) / period;
  now.delay_samples = static_cast<std::ptrdiff_t>(std::floor(samples));
  constexpr double least = 1e-9;
  double share = samples - std::floor(samples);
  if (share > 1.0 - least) {
    share = 0.0;
    ++now.delay_samples;
  }
  const int parts = now.forces.empty() && now.frictions.empty() ? 1 : parts_;
  const auto step = [&](double length) {
    Prepared::Step made;
    if (length < least) return made;
    made.count = std::max(1, static_cast<int>(std::lround(length * parts)));
    LinearStep linear = linear_step(columns, slopes, length * period / made.count);
    made.columns = std::move(linear.columns);
    made.slopes = std::move(linear.slopes);
    return made;
  };
  now.before = step(share);
  now.after = step(1.0 - share);
  return now;
}

namespace {

/// A motion and how it changes, moved part by part.
template <typename Prepared>
class Mover {
 public:
  Mover(const Prepared& prepared, Eigen::Index states, Eigen::Index columns, Eigen::Index bodies)
      : prepared_(prepared), bodies_(bodies), x(State::Zero(states)), slopes(Slopes::Zero(states, prepared.with_slopes ? columns : 0)) {}

  template <typename Step>
  void move(const Step& step, double command, const Row& command_slopes, double share) {
    const Eigen::Index n = x.size();
    const Eigen::Index first_force = n + 1;
    before_ = x;
    x.noalias() = step.columns.leftCols(n).lazyProduct(before_);
    x += step.columns.col(n) * command;
    if (prepared_.with_slopes) {
      before_slopes_ = slopes;
      slopes.noalias() = step.columns.leftCols(n).lazyProduct(before_slopes_);
      for (std::size_t i = 0; i < prepared_.device_columns.size(); ++i) {
        const Eigen::MatrixXd& slope = step.slopes[i];
        auto column = slopes.col(static_cast<Eigen::Index>(prepared_.device_columns[i]));
        column.noalias() += slope.leftCols(n).lazyProduct(before_);
        column += slope.col(n) * command;
      }
      if (command_slopes.size() > 0) slopes.noalias() += step.columns.col(n).lazyProduct(command_slopes);
    }
    if (!prepared_.forces.empty()) add_forces(step, share, first_force);
    if (!prepared_.frictions.empty()) add_frictions(step, first_force);
  }

 private:
  /// Position (order 0) or velocity (1) of a body.
  template <typename Values>
  [[nodiscard]] auto absolute(const Values& values, Eigen::Index body, int order) const {
    using Result = std::conditional_t<Values::ColsAtCompileTime == 1, double, Row>;
    if constexpr (std::is_same_v<Result, double>) {
      return order == 1 ? values(bodies_ + body) : values(0) + (body == 0 ? 0.0 : values(body));
    } else {
      Result row = order == 1 ? Result(values.row(bodies_ + body)) : Result(values.row(0));
      if (order == 0 && body != 0) row += values.row(body);
      return row;
    }
  }
  template <typename Values>
  [[nodiscard]] auto across(const Values& values, Eigen::Index body, Eigen::Index against, int order) const {
    auto result = absolute(values, body, order);
    if (against >= 0) result -= absolute(values, against, order);
    return result;
  }

  template <typename Step>
  void add_forces(const Step& step, double share, Eigen::Index first_force) {
    const State free = x;
    const Slopes free_slopes = slopes;
    for (const auto& force : prepared_.forces) {
      const double position = 0.5 * (across(before_, force.body, force.against, 0) + across(free, force.body, force.against, 0));
      const double velocity = 0.5 * (across(before_, force.body, force.against, 1) + across(free, force.body, force.against, 1));
      const LawForce now = force.law->at({position, velocity, share}, force.values.data());
      State column = step.columns.col(first_force + force.body);
      if (force.against >= 0) column -= step.columns.col(first_force + force.against);
      x += column * now.force;
      if (!prepared_.with_slopes) continue;
      Row slope = 0.5 * now.by_position * (across(before_slopes_, force.body, force.against, 0) + across(free_slopes, force.body, force.against, 0)) +
                  0.5 * now.by_velocity * (across(before_slopes_, force.body, force.against, 1) + across(free_slopes, force.body, force.against, 1));
      for (std::size_t i = 0; i < most_numbers_of_law; ++i) {
        if (now.by_number[i] == 0.0) continue;
        slope(static_cast<Eigen::Index>(force.number + i)) += now.by_number[i] * number_slope(force.number + i);
      }
      slopes.noalias() += column.lazyProduct(slope);
      for (std::size_t i = 0; i < prepared_.device_columns.size(); ++i) {
        auto device = slopes.col(static_cast<Eigen::Index>(prepared_.device_columns[i]));
        device += step.slopes[i].col(first_force + force.body) * now.force;
        if (force.against >= 0) device -= step.slopes[i].col(first_force + force.against) * now.force;
      }
    }
  }

  template <typename Step>
  void add_frictions(const Step& step, Eigen::Index first_force) {
    constexpr std::size_t most = 8;
    constexpr int sweeps = 3;
    const std::size_t count = prepared_.frictions.size();
    std::array<double, most> forces = {};
    std::array<FrictionStep, most> steps = {};
    const auto compliance = [&](std::size_t on, std::size_t of) {
      return step.columns(bodies_ + prepared_.frictions[on].body, first_force + prepared_.frictions[of].body);
    };
    const auto free_velocity = [&](std::size_t i) {
      double free = x(bodies_ + prepared_.frictions[i].body);
      for (std::size_t j = 0; j < count; ++j) free += j == i ? 0.0 : compliance(i, j) * forces[j];
      return free;
    };
    for (int sweep = 0; sweep < (count > 1 ? sweeps : 1); ++sweep) {
      for (std::size_t i = 0; i < count; ++i) {
        const double free = free_velocity(i);
        steps[i] = friction_step(before_(bodies_ + prepared_.frictions[i].body), free, prepared_.frictions[i].limit, compliance(i, i));
        forces[i] = (steps[i].velocity - free) / compliance(i, i);
      }
    }
    if (prepared_.with_slopes) {
      std::array<Row, most> force_slopes;
      for (std::size_t i = 0; i < count; ++i) force_slopes[i] = Row::Zero(slopes.cols());
      for (int sweep = 0; sweep < (count > 1 ? sweeps : 1); ++sweep) {
        for (std::size_t i = 0; i < count; ++i) {
          const Eigen::Index row = bodies_ + prepared_.frictions[i].body;
          Row free = slopes.row(row);
          for (std::size_t j = 0; j < count; ++j) {
            if (j == i) continue;
            free += compliance(i, j) * force_slopes[j];
            for (std::size_t d = 0; d < prepared_.device_columns.size(); ++d) {
              free(static_cast<Eigen::Index>(prepared_.device_columns[d])) +=
                  step.slopes[d](row, first_force + prepared_.frictions[j].body) * forces[j];
            }
          }
          Row velocity = steps[i].by_free * free + steps[i].by_before * before_slopes_.row(row);
          velocity(static_cast<Eigen::Index>(prepared_.frictions[i].number)) +=
              steps[i].by_limit * number_slope(prepared_.frictions[i].number);
          Row force = velocity - free;
          for (std::size_t d = 0; d < prepared_.device_columns.size(); ++d) {
            const double own = step.slopes[d](row, first_force + prepared_.frictions[i].body);
            force(static_cast<Eigen::Index>(prepared_.device_columns[d])) += (steps[i].by_compliance - forces[i]) * own;
          }
          force_slopes[i] = force / compliance(i, i);
        }
      }
      for (std::size_t i = 0; i < count; ++i) {
        slopes.noalias() += step.columns.col(first_force + prepared_.frictions[i].body).lazyProduct(force_slopes[i]);
        for (std::size_t d = 0; d < prepared_.device_columns.size(); ++d) {
          slopes.col(static_cast<Eigen::Index>(prepared_.device_columns[d])) +=
              step.slopes[d].col(first_force + prepared_.frictions[i].body) * forces[i];
        }
      }
    }
    for (std::size_t i = 0; i < count; ++i) x += step.columns.col(first_force + prepared_.frictions[i].body) * forces[i];
  }

  [[nodiscard]] double number_slope(std::size_t i) const { return prepared_.number_slopes[i]; }

  const Prepared& prepared_;
  Eigen::Index bodies_;
  State before_;
  Slopes before_slopes_;

 public:
  State x;
  Slopes slopes;
};

}  // namespace

bool MotionModel::play(const Prepared& prepared, const Segment& segment, const Eigen::VectorXd& state, PlayedSegment& out) const {
  const ForceMotionRecord& record = records_[segment.record];
  const Units& units = units_[segment.record];
  const Eigen::Index states = prepared.input.size();
  const auto numbers = static_cast<Eigen::Index>(numbers_.size());
  const Eigen::Index columns = numbers + this->states();
  Mover<Prepared> mover(prepared, states, columns, bodies_);
  const bool slopes = prepared.with_slopes;
  Eigen::VectorXd unit(this->states());
  unit.head(bodies_).setConstant(units.position);
  unit.tail(bodies_).setConstant(units.velocity);
  mover.x.head(this->states()) = state.cwiseProduct(unit);
  if (sensed_ != 0) mover.x(0) -= mover.x(sensed_);  // the state has the sensed body's place
  if (slopes) {
    for (Eigen::Index i = 0; i < this->states(); ++i) mover.slopes(i, numbers + i) = unit(i);
    if (sensed_ != 0) mover.slopes(0, numbers + sensed_) = -unit(sensed_);
  }
  const auto at = [&](std::size_t k) {
    const std::ptrdiff_t sample = static_cast<std::ptrdiff_t>(k) - prepared.delay_samples;
    return sample < 0 || sample >= static_cast<std::ptrdiff_t>(record.force.size()) ? 0.0 : record.force[static_cast<std::size_t>(sample)];
  };
  Row none(0);
  Row command_slope(0);
  const bool shapes = terms_.drive.dead_band || terms_.drive.saturation;
  const auto given = [&](double command, Row& slope) {
    if (!shapes) return command;
    const double direction = command < 0.0 ? -1.0 : 1.0;
    const double size = std::abs(command);
    slope = Row::Zero(slopes ? columns : 0);
    const double through = size > prepared.dead_band ? size - prepared.dead_band : 0.0;
    if (slopes && through > 0.0 && terms_.drive.dead_band) slope(static_cast<Eigen::Index>(*terms_.drive.dead_band)) = -direction * prepared.number_slopes[*terms_.drive.dead_band];
    if (through <= prepared.limit) return direction * through;
    if (slopes && terms_.drive.saturation) {
      slope.setZero();
      slope(static_cast<Eigen::Index>(*terms_.drive.saturation)) = -direction * prepared.number_slopes[*terms_.drive.saturation];
    }
    return direction * prepared.limit;
  };
  if (states > this->states()) {  // the lagged force is about what was commanded
    Row slope(0);
    mover.x(states - 1) = given(segment.first > 0 ? at(segment.first - 1) : 0.0, slope);
  }
  out.positions.resize(static_cast<Eigen::Index>(segment.count));
  if (slopes) out.slopes.resize(static_cast<Eigen::Index>(segment.count), columns);
  const double whole = 1.0 / static_cast<double>(record.position.size());
  Row older_slope(0);
  double older = given(segment.first > 0 ? at(segment.first - 1) : 0.0, older_slope);
  for (std::size_t k = 0; k < segment.count; ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    out.positions(row) = mover.x(0) + (sensed_ == 0 ? 0.0 : mover.x(sensed_));
    if (slopes) {
      out.slopes.row(row) = mover.slopes.row(0);
      if (sensed_ != 0) out.slopes.row(row) += mover.slopes.row(sensed_);
    }
    const std::size_t sample = segment.first + k;
    const double share = static_cast<double>(sample) * whole;
    for (int part = 0; part < prepared.before.count; ++part) mover.move(prepared.before, older, older_slope, share);
    const double newer = given(at(sample), command_slope);
    for (const auto& [number, slope] : prepared.delays) {
      if (slopes) mover.slopes.col(static_cast<Eigen::Index>(number)) += prepared.input * ((older - newer) * slope);
    }
    for (int part = 0; part < prepared.after.count; ++part) mover.move(prepared.after, newer, command_slope, share);
    older = newer;
    std::swap(older_slope, command_slope);
  }
  constexpr double beyond = 1e12;
  return std::isfinite(mover.x(0)) && out.positions.cwiseAbs().maxCoeff() < beyond * units.position;
}

std::optional<std::vector<PlayedSegment>> MotionModel::play(const Eigen::VectorXd& x, const std::vector<Segment>& segments,
                                                            const std::vector<Eigen::VectorXd>& states, bool with_slopes) const {
  if (find_problem(device_at(x))) return std::nullopt;
  std::vector<PlayedSegment> played(segments.size());
  std::optional<Prepared> now;
  std::size_t record = 0;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    if (!now || segments[i].record != record) now = prepared(x, record = segments[i].record, with_slopes);
    if (!play(*now, segments[i], states[i], played[i])) return std::nullopt;
  }
  return played;
}

}  // namespace zwidth::internal
