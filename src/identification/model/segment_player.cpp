#include "identification/model/segment_player.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "identification/model/friction_step.hpp"

namespace zwidth::internal {
namespace {

/// The recorded force: 0 before the record, the last one behind it.
double command_at(const ForceMotionRecord& record, std::ptrdiff_t sample) {
  const auto size = static_cast<std::ptrdiff_t>(record.force.size());
  return sample < 0 ? 0.0 : record.force[static_cast<std::size_t>(std::min(sample, size - 1))];
}

constexpr int most_sweeps = 3;  // over frictions that rub on each other's bodies

}  // namespace

SegmentPlayer::SegmentPlayer(const PlayedDevice& device, Eigen::Index bodies, Eigen::Index columns)
    : x(State::Zero(device.input.size())),
      device_(device),
      bodies_(bodies),
      frictions_(static_cast<Eigen::Index>(device.frictions.size())),
      with_slopes_(device.with_slopes),
      forces_(bodies),
      friction_forces_(device.frictions.size()),
      bends_(device.frictions.size()),
      held_(device.frictions.size()),
      ends_(device.frictions.size()) {
  if (!with_slopes_) return;
  const Eigen::Index rows = x.size() + device.bends;
  command_at_ = rows;
  forces_at_ = command_at_ + 1;
  frictions_at_ = forces_at_ + bodies;
  numbers_at_ = padded(frictions_at_ + frictions_);
  const Eigen::Index width = numbers_at_ + device.step().slopes.cols();
  slopes = Rows::Zero(rows, padded(columns));
  next_slopes_ = slopes;
  ends_slopes_ = Rows::Zero(rows, width);
  force_slopes_ = Rows::Zero(bodies, width);
  free_slopes_ = Rows::Zero(frictions_, width);
  added_slopes_ = Rows::Zero(frictions_, width);
  answers_ = Rows::Zero(frictions_, frictions_);
  heard_ = answers_;
  gradients_ = Rows::Zero(bodies, x.size());
}

DriveForce SegmentPlayer::given(const ForceMotionRecord& record, std::ptrdiff_t sample, double share) const {
  if (!device_.drift_number) return through_drive(command_at(record, sample));
  const double late = device_.drift * share;
  const double whole = std::floor(late);
  const double weight = late - whole;
  sample -= static_cast<std::ptrdiff_t>(whole);
  const DriveForce newer = through_drive(command_at(record, sample));
  const DriveForce earlier = through_drive(command_at(record, sample - 1));
  const auto mean = [&](double a, double b) { return (1.0 - weight) * a + weight * b; };
  return {mean(newer.force, earlier.force), mean(newer.by_dead_band, earlier.by_dead_band),
          mean(newer.by_saturation, earlier.by_saturation),
          (earlier.force - newer.force) * share * device_.drift_slope};
}

DriveForce SegmentPlayer::through_drive(double command) const {
  DriveForce given{command};
  if (!device_.dead_band_number && !device_.saturation_number) return given;
  const double direction = command < 0.0 ? -1.0 : 1.0;
  const double through = std::max(0.0, std::abs(command) - device_.dead_band);
  const bool is_limited = through > device_.limit;
  const std::optional<Eigen::Index>& number = is_limited ? device_.saturation_number : device_.dead_band_number;
  given.force = direction * std::min(through, device_.limit);
  if (number && through > 0.0)
    (is_limited ? given.by_saturation : given.by_dead_band) = -direction * device_.number_slopes(*number);
  return given;
}

void SegmentPlayer::bend_as_recorded(const ForceMotionRecord& record, std::size_t sample) {
  constexpr std::size_t reach = 200;
  for (std::size_t i = 0; i < bends_.size(); ++i) {
    const PlayedDevice::Friction& friction = device_.frictions[i];
    if (!friction.length_number || friction.bodies.size() > 1) continue;
    double by_length = 0.0;
    for (std::size_t k = sample < reach ? 0 : sample - reach; k < sample; ++k) {
      const double change = record.position[k + 1] - record.position[k];
      const double direction = change < 0.0 ? -1.0 : 1.0;
      const double travel = std::abs(change) / friction.length;
      const double left = std::exp(-travel);
      by_length = left * by_length - (direction - bends_[i]) * left * travel / friction.length;
      bends_[i] = direction - (direction - bends_[i]) * left;
    }
    if (!with_slopes_ || friction.bend < 0) continue;
    const Eigen::Index number = *friction.length_number;
    slopes(x.size() + friction.bend, number) = by_length * device_.number_slopes(number);
  }
}

void SegmentPlayer::move(const std::vector<Step>& halves, std::size_t halved, const DriveForce& command, double share) {
  const Step& step = halves[halved];
  const Eigen::Index n = x.size();
  before_ = x;
  for (Eigen::Index i = 0; i < n; ++i) {
    const double* by = &step.columns(i, 0);
    double sum = by[n] * command.force;
    for (Eigen::Index j = 0; j < n; ++j) sum += by[j] * before_(j);
    x(i) = sum;
  }
  if (with_slopes_) begin_slopes(step, command.force);
  if (!device_.forces.empty()) {
    add_forces(share);
    apply(step);
  }
  if (device_.rubbing > 0 || (with_slopes_ && !device_.frictions.empty())) {
    add_frictions(step);
    if (halved + 1 < halves.size() && changes()) {
      x = before_;
      for (int half = 0; half < 2; ++half) move(halves, halved + 1, command, share);
      return;
    }
    take_frictions();
    if (with_slopes_) add_friction_slopes(step);
    if (device_.rubbing > 0) apply(step);
  }
  if (with_slopes_) end_slopes(command);
}

void SegmentPlayer::begin_slopes(const Step& step, double command) {
  const Eigen::Index n = x.size();
  const Eigen::Index numbers = step.slopes.cols();
  ends_slopes_.setZero();
  own_slopes_.clear();
  bend_slopes_.clear();
  for (Eigen::Index i = 0; i < n; ++i) {
    double* row = &ends_slopes_(i, 0);
    std::copy_n(&step.columns(i, 0), n, row);
    row[command_at_] = step.columns(i, n);
    add_rows(row + numbers_at_, before_.data(), n, step.slopes.row(i).data(), n * numbers, numbers);
    add_row(row + numbers_at_, command, step.slopes.row(n * n + i).data(), numbers);
  }
}

void SegmentPlayer::add_forces(double share) {
  forces_.setZero();
  if (with_slopes_) gradients_.setZero();
  const auto middle = [&](Eigen::Index i) { return 0.5 * (before_(i) + x(i)); };
  const auto position_of = [&](Eigen::Index body) { return body == 0 ? middle(0) : middle(0) + middle(body); };
  for (const PlayedDevice::Force& force : device_.forces) {
    const LawState state{position_of(force.body), middle(bodies_ + force.body), share};
    add_force(force, force.law(state, force.values.data()));
  }
  if (!with_slopes_) return;
  force_slopes_.setZero();
  for (Eigen::Index body = 0; body < bodies_; ++body) {
    double* row = &force_slopes_(body, 0);
    row[forces_at_ + body] = 1.0;
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      const double by = 0.5 * gradients_(body, i);  // of the state halfway
      if (by == 0.0) continue;
      row[i] += by;
      add_row(row, by, &ends_slopes_(i, 0), ends_slopes_.cols());
    }
  }
}

void SegmentPlayer::add_force(const PlayedDevice::Force& force, const LawForce& now) {
  const Eigen::Index on = force.body;
  forces_(on) += now.force;
  if (!with_slopes_) return;
  gradients_(on, on) += now.by_position;
  if (on != 0) gradients_(on, 0) += now.by_position;
  gradients_(on, bodies_ + on) += now.by_velocity;
  for (std::size_t i = 0; i < most_numbers_of_law; ++i) {
    const Eigen::Index number = force.numbers[i];
    if (now.by_number[i] != 0.0)
      own_slopes_.push_back({number, forces_at_ + on, now.by_number[i] * device_.number_slopes(number)});
  }
}

double SegmentPlayer::speed(const State& of, Eigen::Index i) const {
  double sum = 0.0;
  for (const auto& [body, sign] : friction(i).bodies) sum += sign * of(bodies_ + body);
  return sum;
}

void SegmentPlayer::add_compliance_slopes(double* row, double by, const Step& step, Eigen::Index on,
                                          Eigen::Index of) const {
  for (const auto& [moved, with] : friction(on).bodies) {
    for (const auto& [pushed, sign] : friction(of).bodies) {
      const Eigen::Index at = (x.size() + 1 + pushed) * x.size() + bodies_ + moved;
      add_row(row, by * with * sign, step.slopes.row(at).data(), step.slopes.cols());
    }
  }
}

void SegmentPlayer::add_frictions(const Step& step) {
  const int sweeps = device_.rubbing > 1 ? most_sweeps : 1;
  std::ranges::fill(friction_forces_, 0.0);
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    for (Eigen::Index i = 0; i < frictions_; ++i) {
      if (rubs(i)) rub(step, i, with_slopes_ && sweep + 1 == sweeps);
    }
  }
  for (Eigen::Index i = 0; i < frictions_; ++i) {
    if (with_slopes_ && !rubs(i)) rub(step, i, true);  // no force, but one by the limit
  }
  forces_.setZero();
  for (Eigen::Index i = 0; i < frictions_; ++i) {
    for (const auto& [body, sign] : friction(i).bodies)
      forces_(body) += sign * friction_forces_[static_cast<std::size_t>(i)];
  }
}

bool SegmentPlayer::changes() const {
  for (std::size_t i = 0; i < ends_.size(); ++i) {
    const PlayedDevice::Friction& friction = device_.frictions[i];
    if (friction.limit <= 0.0 || friction.length_number) continue;
    const double after = ends_[i].velocity.value;
    const bool was_held = held_[i] != 0;
    const double before = speed(before_, static_cast<Eigen::Index>(i));
    if (was_held != (after == 0.0) || (!was_held && before * after < 0.0)) return true;
  }
  return false;
}

void SegmentPlayer::take_frictions() {
  for (std::size_t i = 0; i < ends_.size(); ++i) {
    bends_[i] = ends_[i].bend.value;
    held_[i] = ends_[i].velocity.value == 0.0 ? 1 : 0;
  }
}

void SegmentPlayer::rub(const Step& step, Eigen::Index i, bool with_slopes) {
  double free = speed(x, i);
  for (Eigen::Index j = 0; j < frictions_; ++j)
    free += j == i ? 0.0 : step.compliance(i, j) * friction_forces_[static_cast<std::size_t>(j)];
  const double before = speed(before_, i);
  const double own = step.compliance(i, i);
  const double limit = friction(i).limit;
  if (friction(i).length_number) {
    const double bend = bends_[static_cast<std::size_t>(i)];
    end(i) = presliding_step(before, free, limit, own, bend, friction(i).length, step.length, with_slopes);
  } else {
    const FrictionStep sticks = friction_step(before, free, limit, own);
    end(i).velocity = {sticks.velocity, sticks.by_before, sticks.by_free, sticks.by_limit, sticks.by_compliance};
  }
  if (rubs(i)) friction_forces_[static_cast<std::size_t>(i)] = (end(i).velocity.value - free) / own;
}

void SegmentPlayer::add_friction_slopes(const Step& step) {
  const Eigen::Index width = ends_slopes_.cols();
  added_slopes_.setZero();
  force_slopes_.setZero();
  for (Eigen::Index i = 0; i < frictions_; ++i) {
    const Eigen::Index column = frictions_at_ + i;
    const double own = step.compliance(i, i);
    const auto add_own = [&](Eigen::Index number, double by) {
      own_slopes_.push_back({number, column, by / own * device_.number_slopes(number)});
    };
    add_own(friction(i).number, end(i).velocity.by_limit);
    if (friction(i).bend >= 0) add_own(*friction(i).length_number, end(i).velocity.by_length);
    added_slopes_(i, column) = 1.0;
    if (rubs(i)) add_slopes_of(step, i);
    if (device_.rubbing > 0) continue;
    for (const auto& [body, sign] : friction(i).bodies)  // none answers
      ends_slopes_.col(column).head(x.size()) += sign * step.columns.col(x.size() + 1 + body);
  }
  if (device_.rubbing == 0) return;
  answer(step);
  for (Eigen::Index i = 0; i < frictions_; ++i) {
    const double* by = answers_.row(i).data();
    for (const auto& [body, sign] : friction(i).bodies) {
      for (Eigen::Index j = 0; j < frictions_; ++j)
        add_row(&force_slopes_(body, 0), sign * by[j], &added_slopes_(j, 0), width);
    }
    if (friction(i).bend >= 0) bend_slopes_of(step, i);
  }
}

void SegmentPlayer::add_slopes_of(const Step& step, Eigen::Index i) {
  const PreslidingStep::End& velocity = end(i).velocity;
  const double own = step.compliance(i, i);
  double* free = &free_slopes_(i, 0);
  double* added = &added_slopes_(i, 0);
  free_slopes_.row(i).setZero();
  for (const auto& [body, sign] : friction(i).bodies)
    add_row(free, sign, &ends_slopes_(bodies_ + body, 0), free_slopes_.cols());
  for (Eigen::Index j = 0; j < frictions_; ++j) {
    if (j != i) add_compliance_slopes(free + numbers_at_, friction_forces_[static_cast<std::size_t>(j)], step, i, j);
  }
  add_row(added, (velocity.by_free - 1.0) / own, free, added_slopes_.cols());
  for (const auto& [body, sign] : friction(i).bodies) added[bodies_ + body] += sign * velocity.by_before / own;
  if (friction(i).bend >= 0) added[x.size() + friction(i).bend] += velocity.by_bend / own;
  const double by_compliance = (velocity.by_compliance - friction_forces_[static_cast<std::size_t>(i)]) / own;
  add_compliance_slopes(added + numbers_at_, by_compliance, step, i, i);
}

void SegmentPlayer::answer(const Step& step) {
  const int sweeps = device_.rubbing > 1 ? most_sweeps : 1;
  for (Eigen::Index i = 0; i < frictions_; ++i) {
    answers_.row(i).setZero();
    answers_(i, i) = rubs(i) ? 0.0 : 1.0;
  }
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    for (Eigen::Index i = 0; i < frictions_; ++i) {
      if (!rubs(i)) continue;
      const double by_free = (end(i).velocity.by_free - 1.0) / step.compliance(i, i);
      for (Eigen::Index k = 0; k < frictions_; ++k) {
        double heard = 0.0;
        for (Eigen::Index j = 0; j < frictions_; ++j) heard += j == i ? 0.0 : step.compliance(i, j) * answers_(j, k);
        heard_(i, k) = heard;
      }
      for (Eigen::Index k = 0; k < frictions_; ++k) answers_(i, k) = (k == i ? 1.0 : 0.0) + by_free * heard_(i, k);
    }
  }
}

void SegmentPlayer::bend_slopes_of(const Step& step, Eigen::Index i) {
  const PreslidingStep::End& bend = end(i).bend;
  const Eigen::Index row = x.size() + friction(i).bend;
  const Eigen::Index width = ends_slopes_.cols();
  double* free = &free_slopes_(i, 0);
  double* own = &ends_slopes_(row, 0);
  add_rows(free, &heard_(i, 0), frictions_, added_slopes_.data(), width, width);
  add_row(own, bend.by_free, free, width);
  for (const auto& [body, sign] : friction(i).bodies) own[bodies_ + body] += sign * bend.by_before;
  own[row] += bend.by_bend;
  add_compliance_slopes(own + numbers_at_, bend.by_compliance, step, i, i);
  for (const auto& [number, by] :
       {std::pair(friction(i).number, bend.by_limit), std::pair(*friction(i).length_number, bend.by_length)})
    bend_slopes_.push_back({row, number, by * device_.number_slopes(number)});
}

void SegmentPlayer::apply(const Step& step) {
  const Eigen::Index n = x.size();
  const Eigen::Index numbers = step.slopes.cols();
  for (Eigen::Index i = 0; i < n; ++i) {
    const double* by = &step.columns(i, n + 1);
    for (Eigen::Index body = 0; body < bodies_; ++body) x(i) += by[body] * forces_(body);
    if (!with_slopes_) continue;
    double* row = &ends_slopes_(i, 0);
    add_rows(row, by, bodies_, force_slopes_.data(), force_slopes_.cols(), force_slopes_.cols());
    add_rows(row + numbers_at_, forces_.data(), bodies_, step.slopes.row((n + 1) * n + i).data(), n * numbers, numbers);
  }
}

void SegmentPlayer::end_slopes(const DriveForce& command) {
  const Eigen::Index width = slopes.cols();
  const Eigen::Index numbers = ends_slopes_.cols() - numbers_at_;
  const auto add_own = [&](const std::optional<Eigen::Index>& number, double slope) {
    if (number && slope != 0.0) own_slopes_.push_back({*number, command_at_, slope});
  };
  add_own(device_.dead_band_number, command.by_dead_band);
  add_own(device_.saturation_number, command.by_saturation);
  add_own(device_.drift_number, command.by_drift);
  for (Eigen::Index i = 0; i < slopes.rows(); ++i) {
    const double* part = &ends_slopes_(i, 0);
    double* row = &next_slopes_(i, 0);
    std::copy_n(part + numbers_at_, numbers, row);
    std::fill(row + numbers, row + width, 0.0);
    add_rows(row, part, slopes.rows(), slopes.data(), width, width);
    for (const OwnSlope& own : own_slopes_) row[own.number] += part[own.column] * own.slope;
  }
  for (const BendSlope& bend : bend_slopes_) next_slopes_(bend.row, bend.number) += bend.slope;
  slopes.swap(next_slopes_);
}

}  // namespace zwidth::internal
