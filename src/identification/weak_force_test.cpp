#include "identification/weak_force_test.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "identification/fit_judgement.hpp"
#include "identification/friction_test.hpp"
#include "identification/nonlinear_forces.hpp"
#include "identification/shot_fit.hpp"
#include "simulation/continuous_motion.hpp"
#include "zwidth/error.hpp"
#include "zwidth/quantity.hpp"

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

/// Of the last column; nothing for drag with the sign of a motor.
std::optional<double> ratio_of(const std::optional<LineRegression>& found, Kind kind) {
  if (!found) return std::nullopt;
  const Eigen::Index last = found->values.size() - 1;
  if (!(found->deviations(last) > 0.0)) return std::nullopt;
  const double ratio = found->values(last) / found->deviations(last);
  if (kind == Kind::presliding) return std::abs(ratio);
  return ratio > 0.0 ? std::optional(ratio) : std::nullopt;
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
    const std::vector<Stretch> stretches = stretches_of(slopes, record, lowest, highest);
    const auto numbers = static_cast<Eigen::Index>(varied_.size());
    const Eigen::Index states = fitted.model.states();
    const auto known = static_cast<Eigen::Index>(fitted.model.coordinates().size());
    const auto forces = static_cast<Eigen::Index>(kinds_.size());
    Eigen::Index rows = 0;
    for (const Eigen::Index size : sizes_) rows += size;
    known_ = Eigen::MatrixXcd::Zero(rows, numbers + states * static_cast<Eigen::Index>(stretches.size()));
    forces_.resize(rows, forces);
    target_.resize(rows);
    Eigen::Index row = 0;
    for (std::size_t s = 0; s < stretches.size(); ++s) {
      const std::size_t shot = stretches[s].shot;
      const LineBand band = stretches[s].band;  // no structured binding: the closure below captures it
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
      Eigen::MatrixXcd columns(known_.rows(), known_.cols() + 1);
      columns << known_, forces_.col(static_cast<Eigen::Index>(j));
      const auto found = regress_lines(columns, target_, sizes_);
      if (const auto ratio = ratio_of(found, kinds_[j]))
        forces.push_back({kinds_[j], *ratio, stiffness_beside(*found)});
    }
    return forces;
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

  [[nodiscard]] double stiffness_beside(const LineRegression& found) const {
    Eigen::VectorXd x = fitted_.fitted.fit.x;
    for (std::size_t j = 0; j < varied_.size(); ++j) {
      const Eigen::Index i = varied_[j];
      x(i) += found.values(static_cast<Eigen::Index>(j));
      if (fitted_.model.is_bounded(i)) x(i) = std::max(0.0, x(i));
    }
    return stiffness_of(fitted_.model.parameters_at(x));
  }

  const FittedDevice& fitted_;
  std::vector<Kind> kinds_;
  std::vector<Eigen::Index> varied_;  ///< elements of x
  std::vector<Eigen::Index> sizes_;   ///< rows of each stretch
  Eigen::MatrixXcd known_;            ///< numbers and states
  Eigen::MatrixXcd forces_;           ///< a column each
  Eigen::VectorXcd target_;
};

std::optional<Nonlinearity> doubt_of(const WeakForceEvidence& force, const Analysis& analysis, Motion motion,
                                     const std::string& source) {
  // Without friction: of 70 linear records 1.8 at most. With friction, fitted in time: drag of 98 right fits of linear records
  // 4.4 at most, above 3 in four; friction as the motion turns 3.2 at most of 28. Of drag that made an answer 6 to 19 % too high 3.4 and
  // more; of friction that bends before it slips, 23 to 580 % too high, 10 and more.
  constexpr double possible = 3.0;
  if (force.ratio < possible) return std::nullopt;
  const bool is_drag = force.kind == Kind::drag;
  const char* what = is_drag ? force_not_in_proportion_to_the_speed : friction_not_coulombs;
  const char* remedy = is_drag ? slow_motion_remedy : strong_motion_remedy;
  const double beside = force.stiffness_beside;
  const double value = analysis.critical.stiffness;
  const double lower = analysis.interval ? analysis.interval->lower : value;
  const double upper = analysis.interval ? analysis.interval->upper : value;
  const std::string about =
      fmt::format("beside it the critical stiffness is about {}", quantity(beside, units_of(motion).stiffness));
  if (force.ratio < significant_friction) {
    if (!(beside < lower)) return std::nullopt;
    return Nonlinearity{fmt::format("{} hardly tells damping from {}: {}", source, what, about), remedy, {}};
  }
  // Of friction of another kind one step does not tell how far away the device is.
  if (is_drag && lower <= beside && beside <= upper) return std::nullopt;
  return Nonlinearity{fmt::format("{} shows {}{}", source, what, beside < value ? " (" + about + ")" : ""), remedy, {}};
}

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
  for (std::size_t r = 0; r < found.size(); ++r) {
    found[r] = RecordLines(fitted, *slopes, kinds, r, lowest, highest).find();
  }
  return found;
}

std::optional<Nonlinearity> doubt_of_weak_forces(std::span<const WeakForceEvidence> forces, const Analysis& analysis,
                                                 Motion motion, const std::string& source) {
  std::vector<WeakForceEvidence> clearest(forces.begin(), forces.end());
  std::ranges::sort(clearest, std::ranges::greater{}, &WeakForceEvidence::ratio);
  for (const WeakForceEvidence& each : clearest) {  // one that does not matter hides no other
    if (auto doubt = doubt_of(each, analysis, motion, source)) return doubt;
  }
  return std::nullopt;
}

}  // namespace zwidth::internal
