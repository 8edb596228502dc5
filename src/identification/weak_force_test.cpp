#include "identification/weak_force_test.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <utility>

#include "identification/response/encoder_rounding.hpp"
#include "identification/fit_judgement.hpp"
#include "identification/shot_fit.hpp"
#include "identification/suspected_motions.hpp"
#include "simulation/continuous_motion.hpp"
#include "zwidth/error.hpp"

namespace zwidth::internal {
namespace {

double stiffness_of(DeviceParameters parameters) {
  for (Body& body : parameters.bodies) body.coulomb = 0.0;
  try {
    return limit_of(Device(std::move(parameters))).stiffness;
  } catch (const Error&) {
    return std::numeric_limits<double>::quiet_NaN();
  }
}

using Kind = WeakForceEvidence::Kind;

/// Of the last column; nothing for a force with the sign of a motor.
std::optional<double> ratio_of(const std::optional<LineRegression>& found, Kind kind) {
  if (!found) return std::nullopt;
  const Eigen::Index last = found->values.size() - 1;
  if (!(found->deviations(last) > 0.0)) return std::nullopt;
  const double ratio = found->values(last) / found->deviations(last);
  if (kind == Kind::presliding || kind == Kind::clock_skew || kind == Kind::changing_damping) return std::abs(ratio);
  return ratio > 0.0 ? std::optional(ratio) : std::nullopt;
}

Kind kind_of(SuspectedMotion::Kind kind) {
  switch (kind) {
    case SuspectedMotion::Kind::clock_skew:
      return Kind::clock_skew;
    case SuspectedMotion::Kind::link_friction:
      return Kind::link_friction;
    case SuspectedMotion::Kind::changing_damping:
      return Kind::changing_damping;
  }
  return Kind::link_friction;
}

/// K_CR at the worse of the two dampings between which a body's changes.
double softest(DeviceParameters parameters, const SuspectedMotion& suspect, double change) {
  const auto at = std::ranges::find(parameters.bodies, suspect.body, &Body::name);
  if (at == parameters.bodies.end()) return std::numeric_limits<double>::quiet_NaN();
  const double mean = at->damping;
  double least = std::numeric_limits<double>::quiet_NaN();
  for (const double end : {suspect.share - 1.0, suspect.share}) {
    at->damping = std::max(0.0, mean + end * change);
    least = std::fmin(least, stiffness_of(parameters));
  }
  return least;
}

using Beside = std::function<DeviceParameters(const LineRegression&)>;  ///< the numbers beside what was found

/// Nothing where its motion may be the encoder's rounding alone.
std::optional<WeakForceEvidence> mode_in(const RestLines& rest, std::span<const double> position,
                                         const ModeQuestion& question, const Beside& beside) {
  const auto mode = find_missing_mode(rest, question);
  if (!mode || mode->peak < largest_rounding(position)) return std::nullopt;
  DeviceParameters parameters = beside(mode->found);
  for (Body& body : parameters.bodies) body.coulomb = 0.0;
  try {
    const Device device(std::move(parameters));
    return WeakForceEvidence{Kind::mode, mode->ratio, stiffness_with(device, *mode), mode->frequency,
                             share_of(device, *mode)};
  } catch (const Error&) {  // no device has such numbers
    return std::nullopt;
  }
}

/// A suspected motion beside all numbers; nothing where it has the sign of a motor, or is too small to matter.
std::optional<WeakForceEvidence> suspect_in(const RestLines& rest, const SuspectedMotion& suspect,
                                            const ModeQuestion& question, const Beside& beside) {
  const auto regressed = regress_lines(rest.known, rest.lines(suspect.motion), rest.target, rest.stretches);
  const Kind kind = kind_of(suspect.kind);
  const auto ratio = ratio_of(regressed, kind);
  if (!ratio) return std::nullopt;
  const double size = regressed->values(rest.known.cols());
  WeakForceEvidence evidence{kind, *ratio};
  if (kind == Kind::changing_damping) {
    evidence.body = suspect.body;
    evidence.change = size;
    evidence.stiffness_beside = softest(beside(*regressed), suspect, size);
  } else {
    evidence.stiffness_beside = stiffness_of(beside(*regressed));
  }
  constexpr double notable = 0.05;  // sampling periods
  if (kind == Kind::clock_skew) {
    evidence.change = size * static_cast<double>(suspect.motion.size()) * question.sampling_period;
    if (!(std::abs(evidence.change) > notable * question.sampling_period)) return std::nullopt;
  }
  return evidence;
}

/// A mode and suspected motions. `device`: the fitted one, without friction, as it was in the experiment.
std::vector<WeakForceEvidence> suspects_in(const RestLines& rest, const Device& device,
                                           std::span<const double> position, const ModeQuestion& question,
                                           const Beside& beside) {
  const std::vector<SuspectedMotion> suspects = suspected_motions(device, question.force, position);
  std::vector<std::optional<WeakForceEvidence>> each(suspects.size() + 1);
  each.front() = mode_in(rest, position, question, beside);
  tbb::parallel_for(std::size_t{0}, suspects.size(),
                    [&](std::size_t i) { each[i + 1] = suspect_in(rest, suspects[i], question, beside); });
  std::vector<WeakForceEvidence> found;
  for (std::optional<WeakForceEvidence>& evidence : each) {
    if (evidence) found.push_back(*std::move(evidence));
  }
  return found;
}

/// Median distance from turn to turn of a recorded motion.
double stroke_of(const MotionRecord& record) {
  std::vector<double> strokes;
  double turned = record.position.front();
  int direction = 0;
  constexpr std::size_t reach = 8;  // samples, against noise
  for (std::size_t k = reach; k < record.position.size(); k += reach) {
    const double moved = record.position[k] - record.position[k - reach];
    const int now = moved > 0.0 ? 1 : moved < 0.0 ? -1 : direction;
    if (now != direction && direction != 0) {
      strokes.push_back(std::abs(record.position[k - reach] - turned));
      turned = record.position[k - reach];
    }
    direction = now;
  }
  if (strokes.empty()) return 0.0;
  const auto middle = strokes.begin() + static_cast<std::ptrdiff_t>(strokes.size() / 2);
  std::ranges::nth_element(strokes, middle);
  return *middle;
}

double drag_of_unit_size(double speed) { return speed * speed; }

/// Neighbouring lines of one shot.
struct Stretch {
  std::size_t shot = 0;
  LineBand band;
};

/// The lines of one recording's shots: what is left of them, and what the numbers, the shots' own states and weak forces
/// change of that.
class RecordLines {
 public:
  /// `slopes`: of the fitted model with these forces.
  RecordLines(const FittedDevice& fitted, const ShotSlopes& slopes, std::vector<Kind> kinds, std::size_t record,
              double lowest, double highest)
      : fitted_(fitted), kinds_(std::move(kinds)) {
    const ShotFit& fit = fitted.fitted.fit;
    for (Eigen::Index i = 0; i < fit.x.size(); ++i) {
      if (!fit.held[static_cast<std::size_t>(i)]) varied_.push_back(i);
    }
    stretches_ = stretches_of(slopes, record, lowest, highest);
    const auto numbers = static_cast<Eigen::Index>(varied_.size());
    const Eigen::Index states = fitted.model.states();
    const auto known = static_cast<Eigen::Index>(fitted.model.coordinates().size());
    const auto forces = static_cast<Eigen::Index>(kinds_.size());
    Eigen::Index rows = 0;
    for (const Eigen::Index size : sizes_) rows += size;
    known_ = Eigen::MatrixXcd::Zero(rows, numbers + states * static_cast<Eigen::Index>(stretches_.size()));
    forces_.resize(rows, forces);
    target_.resize(rows);
    Eigen::Index row = 0;
    for (std::size_t s = 0; s < stretches_.size(); ++s) {
      const std::size_t shot = stretches_[s].shot;
      const LineBand band = stretches_[s].band;  // no structured binding: the closure below captures it
      const auto put = [&](const Eigen::VectorXd& signal) {
        return lines_of({signal.data(), static_cast<std::size_t>(signal.size())}, band);
      };
      const Eigen::MatrixXd& of_numbers = slopes.of_parameters[shot];
      const Eigen::Index size = sizes_[s];
      target_.segment(row, size) = -put(slopes.residuals[shot]);
      for (Eigen::Index j = 0; j < numbers; ++j) {
        const Eigen::Index i = varied_[static_cast<std::size_t>(j)];
        known_.col(j).segment(row, size) = put(of_numbers.col(i < known ? i : i + forces));
      }
      for (Eigen::Index j = 0; j < states; ++j) {
        const Eigen::Index column = numbers + states * static_cast<Eigen::Index>(s) + j;
        known_.col(column).segment(row, size) = put(slopes.of_states[shot].col(j));
      }
      for (Eigen::Index j = 0; j < forces; ++j) {
        forces_.col(j).segment(row, size) = put(of_numbers.col(known + j));
      }
      row += size;
    }
  }

  [[nodiscard]] std::vector<WeakForceEvidence> find() const {
    std::vector<WeakForceEvidence> forces;
    constexpr Eigen::Index lines_each = 4;
    if (known_.rows() < lines_each * (known_.cols() + 1)) return forces;
    for (std::size_t j = 0; j < kinds_.size(); ++j) {
      const auto found = regress_lines(known_, forces_.col(static_cast<Eigen::Index>(j)), target_, sizes_);
      if (const auto ratio = ratio_of(found, kinds_[j]))
        forces.push_back({kinds_[j], *ratio, stiffness_of(parameters_beside(*found))});
    }
    return forces;
  }

  /// A mode that the device lacks, and suspected motions.
  [[nodiscard]] std::vector<WeakForceEvidence> find_suspects(const Device& device, const MotionRecord& record,
                                                             double lowest, double highest) const {
    constexpr Eigen::Index lines_each = 4;
    if (known_.rows() < lines_each * (known_.cols() + 2)) return {};
    const auto lines = [this](std::span<const double> motion) {
      Eigen::VectorXcd all(known_.rows());
      Eigen::Index row = 0;
      for (std::size_t s = 0; s < stretches_.size(); ++s) {
        const Shot& shot = fitted_.shots[stretches_[s].shot];
        const std::span<const double> part = motion.subspan(shot.first, shot.count);
        const Eigen::Map<const Eigen::VectorXd> samples(part.data(), static_cast<Eigen::Index>(part.size()));
        const Eigen::VectorXd filtered = whitened(fitted_.fitted.noise[shot.record], samples);
        all.segment(row, sizes_[s]) =
            lines_of({filtered.data(), static_cast<std::size_t>(filtered.size())}, stretches_[s].band);
        row += sizes_[s];
      }
      return all;
    };
    std::vector<RestPart> parts;
    Eigen::VectorXcd filter(known_.rows());
    Eigen::Index row = 0;
    for (const Stretch& stretch : stretches_) {
      const Shot& shot = fitted_.shots[stretch.shot];
      const ShotNoise& noise = fitted_.fitted.noise[shot.record];
      const std::size_t order = noise.filter.size() - 1;
      parts.push_back({shot.first + order, shot.count - order, stretch.band});
      const double turn = 2.0 * std::numbers::pi / static_cast<double>(shot.count - order);
      for (std::size_t k = stretch.band.first; k < stretch.band.last; ++k) {
        filter(row++) = response_of(noise, turn * static_cast<double>(k));
      }
    }
    return suspects_in({known_, target_, std::move(parts), sizes_, std::move(filter), lines}, device, record.position,
                       {record.force, record.sampling_period, device.loop().delay, lowest, highest},
                       [this](const LineRegression& found) { return parameters_beside(found); });
  }

 private:
  [[nodiscard]] std::vector<Stretch> stretches_of(const ShotSlopes& slopes, std::size_t record, double lowest,
                                                  double highest) {
    std::vector<Stretch> stretches;
    for (std::size_t i = 0; i < fitted_.shots.size(); ++i) {
      if (fitted_.shots[i].record != record) continue;
      const auto samples = static_cast<std::size_t>(slopes.residuals[i].size());
      const double period = fitted_.model.records()[record].sampling_period;
      const LineBand band = band_with_harmonics(lowest, highest, samples, period);
      if (band.size() == 0) continue;
      stretches.push_back({i, band});
      sizes_.push_back(static_cast<Eigen::Index>(band.size()));
    }
    return stretches;
  }

  [[nodiscard]] DeviceParameters parameters_beside(const LineRegression& found) const {
    Eigen::VectorXd x = fitted_.fitted.fit.x;
    for (std::size_t j = 0; j < varied_.size(); ++j) {
      const Eigen::Index i = varied_[j];
      x(i) += found.values(static_cast<Eigen::Index>(j));
      if (fitted_.model.is_bounded(i)) x(i) = std::max(0.0, x(i));
    }
    return fitted_.model.parameters_at(x);
  }

  const FittedDevice& fitted_;
  std::vector<Kind> kinds_;
  std::vector<Stretch> stretches_;
  std::vector<Eigen::Index> varied_;  ///< elements of x
  std::vector<Eigen::Index> sizes_;   ///< rows of each stretch
  Eigen::MatrixXcd known_;            ///< numbers and states
  Eigen::MatrixXcd forces_;           ///< a column each
  Eigen::VectorXcd target_;
};

}  // namespace

std::vector<WeakForceEvidence> find_weak_forces(const MotionQuestion& question, std::span<const double> force,
                                                std::span<const double> position) try {
  std::vector<WeakForceEvidence> forces;
  const MotionResiduals residuals(question, force, position);
  if (!residuals.are_enough()) return forces;
  for (const Opposing& each : residuals.opposing_forces(drag_of_unit_size)) {
    const auto found = residuals.beside(each);
    if (const auto ratio = ratio_of(found, Kind::drag)) {
      forces.push_back({Kind::drag, *ratio, stiffness_of(residuals.parameters_beside(*found))});
    }
  }
  const std::span<const double> played = residuals.force();
  const auto suspects =
      suspects_in(residuals.rest(), device_in_experiment(question.device, question.locked, question.sampling_period),
                  position.first(played.size()),
                  {played, question.sampling_period, question.device.loop().delay, question.lowest, question.highest},
                  [&](const LineRegression& found) { return residuals.parameters_beside(found); });
  forces.insert(forces.end(), suspects.begin(), suspects.end());
  return forces;
} catch (const Error&) {  // a device that cannot be played says nothing
  return {};
}

std::vector<std::vector<WeakForceEvidence>> find_weak_forces(const FittedDevice& fitted,
                                                             const std::vector<std::string>& locked, double lowest,
                                                             double highest) {
  std::vector<std::vector<WeakForceEvidence>> found(fitted.model.records().size());
  const ShotFit& fit = fitted.fitted.fit;
  std::vector<WeakForce> forces;
  std::vector<Kind> kinds;
  double stroke = 0.0;
  for (const MotionRecord& record : fitted.model.records()) stroke = std::max(stroke, stroke_of(record));
  const DeviceParameters device = fitted.model.parameters_at(fit.x);
  const bool may_all_rub = device.bodies.size() <= ContinuousMotion::max_friction_bodies;
  for (const Body& body : device.bodies) {
    if (std::ranges::count(locked, body.name) > 0) continue;
    forces.push_back({body.name});
    kinds.push_back(Kind::drag);
    if (!(stroke > 0.0) || !(may_all_rub || body.coulomb > 0.0)) continue;
    for (const double share : {0.003, 0.01, 0.03, 0.1, 0.3, 1.0}) {
      forces.push_back({body.name, share * stroke});
      kinds.push_back(Kind::presliding);
    }
  }
  const auto known = static_cast<Eigen::Index>(fitted.model.coordinates().size());
  Eigen::VectorXd x = Eigen::VectorXd::Zero(fit.x.size() + static_cast<Eigen::Index>(forces.size()));
  x.head(known) = fit.x.head(known);
  x.tail(fit.x.size() - known) = fit.x.tail(fit.x.size() - known);
  const ShotModel model = fitted.model.with_weak_forces(std::move(forces));
  const auto slopes = shot_slopes(model, fitted.shots, fitted.fitted.noise, x, fit.states);
  if (!slopes) return found;
  DeviceParameters linear = device;
  for (Body& body : linear.bodies) body.coulomb = 0.0;
  for (std::size_t r = 0; r < found.size(); ++r) {
    const RecordLines lines(fitted, *slopes, kinds, r, lowest, highest);
    found[r] = lines.find();
    const MotionRecord& record = fitted.model.records()[r];
    const Device experiment = device_in_experiment(Device(linear), locked, record.sampling_period);
    const auto suspects = lines.find_suspects(experiment, record, lowest, highest);
    found[r].insert(found[r].end(), suspects.begin(), suspects.end());
  }
  return found;
}

}  // namespace zwidth::internal
