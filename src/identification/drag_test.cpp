#include "identification/drag_test.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <utility>

#include "identification/fit_judgement.hpp"
#include "identification/friction_test.hpp"
#include "identification/nonlinear_forces.hpp"
#include "identification/shot_fit.hpp"
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

/// Of the last column; nothing where it has the sign of a motor.
std::optional<double> ratio_of(const std::optional<LineRegression>& found) {
  if (!found) return std::nullopt;
  const Eigen::Index last = found->values.size() - 1;
  if (!(found->values(last) > 0.0 && found->deviations(last) > 0.0)) return std::nullopt;
  return found->values(last) / found->deviations(last);
}

double drag_of_unit_size(double speed) { return speed * speed; }

/// The sensed positions that drag of unit size makes, as far as the device slides.
std::vector<double> drag_effect(const Device& device, const Eigen::VectorXd& positions) {
  const std::span played(positions.data(), static_cast<std::size_t>(positions.size()));
  return motion_of(pushed_at(device, device.loop().sensed),
                   opposing_force(played, device.loop().sampling_period, drag_of_unit_size));
}

}  // namespace

std::optional<DragEvidence> find_drag(const MotionQuestion& question, std::span<const double> force,
                                      std::span<const double> position) try {
  const MotionResiduals residuals(question, force, position);
  if (!residuals.are_enough()) return std::nullopt;
  std::optional<DragEvidence> best;
  std::optional<LineRegression> fitted;
  for (const Opposing& each : residuals.opposing_forces(drag_of_unit_size)) {
    auto found = residuals.beside(each);
    const auto ratio = ratio_of(found);
    if (!ratio || (best && *ratio <= best->ratio)) continue;
    best = DragEvidence{.body = each.body, .ratio = *ratio};
    fitted = std::move(found);
  }
  if (best) best->stiffness_beside = stiffness_of(residuals.parameters_beside(*fitted));
  return best;
} catch (const Error&) {  // a device that cannot be played says nothing
  return std::nullopt;
}

std::optional<DragEvidence> find_drag(const FittedDevice& fitted, const std::vector<std::string>& locked,
                                      std::size_t record, double lowest, double highest) {
  const ShotFit& fit = fitted.fitted.fit;
  const ShotNoise& noise = fitted.fitted.noise[record];
  const auto slopes = shot_slopes(fitted.model, fitted.shots, fitted.fitted.noise, fit.x, fit.states);
  const auto played = fitted.model.play(fit.x, fitted.shots, fit.states, ShotModel::Slopes::none);
  if (!slopes || !played) return std::nullopt;
  DeviceParameters parameters = fitted.model.parameters_at(fit.x);
  for (Body& body : parameters.bodies) body.coulomb = 0.0;
  const double period = fitted.model.records()[record].sampling_period;
  const Device device = device_in_experiment(Device(std::move(parameters)), locked, period);

  std::vector<Eigen::Index> varied;
  for (Eigen::Index i = 0; i < fit.x.size(); ++i) {
    if (!fit.held[static_cast<std::size_t>(i)]) varied.push_back(i);
  }
  struct Stretch {
    std::size_t shot = 0;
    LineBand band;
  };
  std::vector<Stretch> stretches;
  std::vector<Eigen::Index> sizes;
  Eigen::Index rows = 0;
  for (std::size_t i = 0; i < fitted.shots.size(); ++i) {
    if (fitted.shots[i].record != record) continue;
    const auto samples = static_cast<std::size_t>(slopes->residuals[i].size());
    const LineBand band = band_with_harmonics(lowest, highest, samples, period);
    if (band.size() == 0) continue;
    stretches.push_back({i, band});
    sizes.push_back(static_cast<Eigen::Index>(band.size()));
    rows += sizes.back();
  }
  const auto numbers = static_cast<Eigen::Index>(varied.size());
  const Eigen::Index states = fitted.model.states();
  const Eigen::Index count = numbers + states * static_cast<Eigen::Index>(stretches.size()) + 1;
  if (rows < 4 * count) return std::nullopt;

  Eigen::MatrixXcd columns = Eigen::MatrixXcd::Zero(rows, count);
  Eigen::VectorXcd target(rows);
  Eigen::Index row = 0;
  for (std::size_t s = 0; s < stretches.size(); ++s) {
    const auto& [shot, band] = stretches[s];
    const auto put = [&](const Eigen::VectorXd& signal) {
      return lines_of({signal.data(), static_cast<std::size_t>(signal.size())}, band);
    };
    const auto block = [&](Eigen::Index column) { return columns.col(column).segment(row, sizes[s]); };
    target.segment(row, sizes[s]) = -put(slopes->residuals[shot]);
    for (Eigen::Index j = 0; j < numbers; ++j)
      block(j) = put(slopes->of_parameters[shot].col(varied[static_cast<std::size_t>(j)]));
    for (Eigen::Index j = 0; j < states; ++j) {
      block(numbers + states * static_cast<Eigen::Index>(s) + j) = put(slopes->of_states[shot].col(j));
    }
    const std::vector<double> effect = drag_effect(device, (*played)[shot].positions);
    block(count - 1) = put(
        whitened(noise, Eigen::Map<const Eigen::VectorXd>(effect.data(), static_cast<Eigen::Index>(effect.size()))));
    row += sizes[s];
  }
  const auto found = regress_lines(columns, target, sizes);
  const auto ratio = ratio_of(found);
  if (!ratio) return std::nullopt;
  Eigen::VectorXd x = fit.x;
  for (Eigen::Index j = 0; j < numbers; ++j) {
    const Eigen::Index i = varied[static_cast<std::size_t>(j)];
    x(i) += found->values(j);
    if (fitted.model.is_bounded(i)) x(i) = std::max(0.0, x(i));
  }
  return DragEvidence{device.bodies()[device.loop().sensed].name, *ratio, stiffness_of(fitted.model.parameters_at(x))};
}

std::optional<std::string> doubt_of_drag(const std::optional<DragEvidence>& drag, const Analysis& analysis,
                                         Motion motion) {
  // Of 70 linear records 1.8 at most, of 70 with friction, fitted in time, 3.9; drag that moves an answer by 3 % 6 and more.
  if (!drag || drag->ratio < significant_friction) return std::nullopt;
  const double beside = drag->stiffness_beside;
  const auto& interval = analysis.interval;
  if (interval && interval->lower <= beside && beside <= interval->upper) return std::nullopt;
  std::string what = force_not_in_proportion_to_the_speed;
  if (beside < analysis.critical.stiffness) {
    what +=
        fmt::format(" (beside it the critical stiffness is about {})", quantity(beside, units_of(motion).stiffness));
  }
  return what;
}

}  // namespace zwidth::internal
