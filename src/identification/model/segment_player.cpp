#include "identification/model/segment_player.hpp"

#include <algorithm>
#include <cmath>

#include "identification/model/friction_step.hpp"
#include "identification/model/presliding_step.hpp"

namespace zwidth::internal {
namespace {

/// The recorded force: 0 before the record, the last one behind it.
double command_at(const ForceMotionRecord& record, std::ptrdiff_t sample) {
  const auto size = static_cast<std::ptrdiff_t>(record.force.size());
  return sample < 0 ? 0.0 : record.force[static_cast<std::size_t>(std::min(sample, size - 1))];
}

}  // namespace

PlayedDevice::PlayedDevice(const DeviceFamily& family, const MotionTerms& terms, const std::vector<std::string>& bodies,
                           std::size_t record, double largest_force, double period, int parts, const Eigen::VectorXd& x,
                           bool with_slopes_asked)
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
    if (number.key == "loop.delay") instants.emplace_back(i, number_slopes(i));
    if (number.key == "actuator.time_constant") instants.emplace_back(i, -number_slopes(i));  // the sum stays
  }
  for (const ForceTerm& term : terms.forces) {
    if (term.record && *term.record != record) continue;
    Force force{.law = term.law.get(), .body = index(term.body)};
    if (!term.against.empty()) force.against = index(term.against);
    for (std::size_t i = 0; i < term.numbers.size(); ++i) {
      force.numbers[i] = place(term.numbers[i]);
      force.values[i] = value(force.numbers[i]);
    }
    forces.push_back(force);
  }
  for (const FrictionTerm& term : terms.frictions) {
    frictions.push_back({index(term.body), place(term.number), value(place(term.number))});
    if (!term.presliding_length) continue;
    constexpr double least_length = 0.01;  // of a unit: shorter, and it sticks
    const Eigen::Index length = place(*term.presliding_length);
    if (value(length) < least_length * numbers[static_cast<std::size_t>(length)].unit) continue;
    frictions.back().length_number = length;
    frictions.back().length = value(length);
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
  Eigen::MatrixXd columns = motion_columns(family.recorded_device(x));
  input = columns.col(columns.rows());
  std::vector<Eigen::MatrixXd> slopes = with_slopes ? motion_slopes(family, x) : std::vector<Eigen::MatrixXd>{};
  if (family.has_further_body()) {  // no term acts on it: 1 / mass, which has no bound, stays out of the exponential
    columns.rightCols(1).setZero();
    for (Eigen::MatrixXd& each : slopes) each.rightCols(1).setZero();
  }
  const int wanted = forces.empty() && frictions.empty() ? 1 : parts;
  const auto step = [&](double length) {
    if (length < least) return LinearStep{};
    const int count = std::max(1, static_cast<int>(std::lround(length * wanted)));
    return linear_step(columns, slopes, length * period / count, count);
  };
  before = step(share);
  after = step(1.0 - share);
}

SegmentPlayer::SegmentPlayer(const PlayedDevice& device, Eigen::Index bodies, Eigen::Index columns)
    : x(State::Zero(device.input.size())),
      slopes(Slopes::Zero(device.input.size(), device.with_slopes ? columns : 0)),
      device_(device),
      bodies_(bodies),
      bend_slopes_(decltype(bend_slopes_)::Zero(bodies, slopes.cols())),
      forces_(bodies),
      force_slopes_(bodies, slopes.cols()) {}

double SegmentPlayer::given(const ForceMotionRecord& record, std::ptrdiff_t sample, double share,
                            Row& command_slopes) const {
  if (!device_.drift_number) return through_drive(command_at(record, sample), command_slopes);
  const double late = device_.drift * share;
  const double whole = std::floor(late);
  const double weight = late - whole;
  sample -= static_cast<std::ptrdiff_t>(whole);
  Row earlier_slopes(0);
  const double newer = through_drive(command_at(record, sample), command_slopes);
  const double earlier = through_drive(command_at(record, sample - 1), earlier_slopes);
  if (slopes.cols() > 0) {
    if (earlier_slopes.size() > 0) {
      command_slopes = (1.0 - weight) * command_slopes + weight * earlier_slopes;
    } else {
      command_slopes.setZero(slopes.cols());
    }
    command_slopes(*device_.drift_number) = (earlier - newer) * share * device_.drift_slope;
  }
  return (1.0 - weight) * newer + weight * earlier;
}

double SegmentPlayer::through_drive(double command, Row& command_slopes) const {
  if (!device_.dead_band_number && !device_.saturation_number) return command;
  const double direction = command < 0.0 ? -1.0 : 1.0;
  const double through = std::max(0.0, std::abs(command) - device_.dead_band);
  const std::optional<Eigen::Index>& number =
      through > device_.limit ? device_.saturation_number : device_.dead_band_number;
  command_slopes.setZero(slopes.cols());
  if (command_slopes.size() > 0 && number && through > 0.0)
    command_slopes(*number) = -direction * device_.number_slopes(*number);
  return direction * std::min(through, device_.limit);
}

void SegmentPlayer::bend_as_recorded(const ForceMotionRecord& record, std::size_t sample) {
  constexpr std::size_t reach = 200;
  for (const PlayedDevice::Friction& friction : device_.frictions) {
    if (!friction.length_number) continue;
    double bend = 0.0;
    double by_length = 0.0;
    for (std::size_t k = sample < reach ? 0 : sample - reach; k < sample; ++k) {
      const double change = record.position[k + 1] - record.position[k];
      const double direction = change < 0.0 ? -1.0 : 1.0;
      const double travel = std::abs(change) / friction.length;
      const double left = std::exp(-travel);
      by_length = left * by_length - (direction - bend) * left * travel / friction.length;
      bend = direction - (direction - bend) * left;
    }
    bends_[static_cast<std::size_t>(friction.body)] = bend;
    if (slopes.cols() > 0) {
      const Eigen::Index number = *friction.length_number;
      bend_slopes_(friction.body, number) = by_length * device_.number_slopes(number);
    }
  }
}

void SegmentPlayer::move(const LinearStep& step, double command, const Row& command_slopes, double share) {
  const Eigen::Index n = x.size();
  before_ = x;
  x.noalias() = step.columns.leftCols(n).lazyProduct(before_);
  x += step.columns.col(n) * command;
  if (slopes.cols() > 0) {
    before_slopes_.swap(slopes);
    slopes.resize(before_slopes_.rows(), before_slopes_.cols());
    for (Eigen::Index i = 0; i < n; ++i) {
      slopes.row(i) = step.columns(i, 0) * before_slopes_.row(0);
      for (Eigen::Index j = 1; j < n; ++j) {
        if (step.columns(i, j) != 0.0) slopes.row(i) += step.columns(i, j) * before_slopes_.row(j);
      }
      if (command_slopes.size() > 0) slopes.row(i) += step.columns(i, n) * command_slopes;
    }
    const auto numbers = step.slopes.front().cols();
    auto own = slopes.leftCols(numbers);
    for (Eigen::Index j = 0; j < n; ++j) own += step.slopes[static_cast<std::size_t>(j)] * before_(j);
    own += step.slopes[static_cast<std::size_t>(n)] * command;
  }
  if (!device_.forces.empty()) {
    add_forces(share);
    apply(step);
  }
  if (!device_.frictions.empty()) {
    add_frictions(step);
    apply(step);
  }
}

void SegmentPlayer::add_forces(double share) {
  forces_.setZero();
  if (slopes.cols() > 0) force_slopes_.setZero();
  const auto middle = [&](Eigen::Index body, int order) {
    const Eigen::Index row = order == 1 ? bodies_ + body : body;
    const double own = 0.5 * (before_(row) + x(row));
    return order == 1 || body == 0 ? own : own + 0.5 * (before_(0) + x(0));
  };
  const auto add_slopes = [&](auto&& row, Eigen::Index body, int order, double factor) {
    const Eigen::Index own = order == 1 ? bodies_ + body : body;
    row += (0.5 * factor) * (before_slopes_.row(own) + slopes.row(own));
    if (order == 0 && body != 0) row += (0.5 * factor) * (before_slopes_.row(0) + slopes.row(0));
  };
  for (const PlayedDevice::Force& force : device_.forces) {
    LawState state{middle(force.body, 0), middle(force.body, 1), share};
    if (force.against >= 0) {
      state.position -= middle(force.against, 0);
      state.velocity -= middle(force.against, 1);
    }
    const LawForce now = force.law->at(state, force.values.data());
    forces_(force.body) += now.force;
    if (force.against >= 0) forces_(force.against) -= now.force;
    if (slopes.cols() == 0) continue;
    const auto add = [&](Eigen::Index on, double sign) {
      auto row = force_slopes_.row(on);
      if (now.by_position != 0.0) {
        add_slopes(row, force.body, 0, sign * now.by_position);
        if (force.against >= 0) add_slopes(row, force.against, 0, -sign * now.by_position);
      }
      if (now.by_velocity != 0.0) {
        add_slopes(row, force.body, 1, sign * now.by_velocity);
        if (force.against >= 0) add_slopes(row, force.against, 1, -sign * now.by_velocity);
      }
      for (std::size_t i = 0; i < most_numbers_of_law; ++i) {
        const Eigen::Index at = force.numbers[i];
        if (now.by_number[i] != 0.0) row(at) += sign * now.by_number[i] * device_.number_slopes(at);
      }
    };
    add(force.body, 1.0);
    if (force.against >= 0) add(force.against, -1.0);
  }
}

void SegmentPlayer::add_frictions(const LinearStep& step) {
  constexpr int most_sweeps = 3;
  const std::size_t count = device_.frictions.size();
  const int sweeps = count > 1 ? most_sweeps : 1;
  const Eigen::Index first = x.size() + 1;
  std::array<PreslidingStep, most_bodies> steps = {};
  const auto body = [&](std::size_t i) { return device_.frictions[i].body; };
  const auto compliance = [&](std::size_t on, std::size_t of) {
    return step.columns(bodies_ + body(on), first + body(of));
  };
  forces_.setZero();
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    for (std::size_t i = 0; i < count; ++i) {
      double free = x(bodies_ + body(i));
      for (std::size_t j = 0; j < count; ++j) free += j == i ? 0.0 : compliance(i, j) * forces_(body(j));
      const PlayedDevice::Friction& friction = device_.frictions[i];
      const double before = before_(bodies_ + body(i));
      if (friction.length_number) {
        steps[i] = presliding_step(before, free, friction.limit, compliance(i, i),
                                   bends_[static_cast<std::size_t>(body(i))], friction.length, step.length);
      } else {
        const FrictionStep sticks = friction_step(before, free, friction.limit, compliance(i, i));
        steps[i].velocity = {sticks.velocity, sticks.by_before, sticks.by_free, sticks.by_limit, sticks.by_compliance};
      }
      forces_(body(i)) = (steps[i].velocity.value - free) / compliance(i, i);
    }
  }
  for (std::size_t i = 0; i < count; ++i) bends_[static_cast<std::size_t>(body(i))] = steps[i].bend.value;
  if (slopes.cols() == 0) return;
  force_slopes_.setZero();
  const Eigen::Index numbers = step.slopes.front().cols();
  const auto compliance_slopes = [&](std::size_t on, std::size_t of) {
    return step.slopes[static_cast<std::size_t>(first + body(of))].row(bodies_ + body(on));
  };
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    const bool is_last = sweep + 1 == sweeps;
    for (std::size_t i = 0; i < count; ++i) {
      const Eigen::Index row = bodies_ + body(i);
      const PlayedDevice::Friction& friction = device_.frictions[i];
      Row free = slopes.row(row);
      for (std::size_t j = 0; j < count; ++j) {
        if (j == i) continue;
        free += compliance(i, j) * force_slopes_.row(body(j));
        free.head(numbers) += compliance_slopes(i, j) * forces_(body(j));
      }
      // (v - v_free) / compliance
      auto force = force_slopes_.row(body(i));
      const auto change_of = [&](const PreslidingStep::End& end, double by_free, double by_compliance) {
        Row change = by_free * free + end.by_before * before_slopes_.row(row);
        change(friction.number) += end.by_limit * device_.number_slopes(friction.number);
        change.head(numbers) += by_compliance * compliance_slopes(i, i);
        if (!friction.length_number) return change;
        if (end.by_bend != 0.0) change += end.by_bend * bend_slopes_.row(body(i));
        change(*friction.length_number) += end.by_length * device_.number_slopes(*friction.length_number);
        return change;
      };
      const PreslidingStep::End& velocity = steps[i].velocity;
      force = change_of(velocity, velocity.by_free - 1.0, velocity.by_compliance - forces_(body(i)));
      force /= compliance(i, i);
      if (is_last && friction.length_number) {
        const PreslidingStep::End& bend = steps[i].bend;
        bend_slopes_.row(body(i)) = change_of(bend, bend.by_free, bend.by_compliance);
      }
    }
  }
}

void SegmentPlayer::apply(const LinearStep& step) {
  const Eigen::Index first = x.size() + 1;
  for (Eigen::Index body = 0; body < bodies_; ++body) {
    const double force = forces_(body);
    x += step.columns.col(first + body) * force;
    if (slopes.cols() == 0) continue;
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      if (step.columns(i, first + body) != 0.0)
        slopes.row(i) += step.columns(i, first + body) * force_slopes_.row(body);
    }
    if (force != 0.0)
      slopes.leftCols(step.slopes.front().cols()) += step.slopes[static_cast<std::size_t>(first + body)] * force;
  }
}

}  // namespace zwidth::internal
