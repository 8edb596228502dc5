#include "identification/missing_mode.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <utility>

#include "linear_systems.hpp"
#include "zwidth/error.hpp"
#include "zwidth/sampling/discrete_state_space.hpp"
#include "zwidth/sampling/sampled_plant.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth::internal {
namespace {

struct ModeGuess {
  double frequency = 0.0;
  double damping_ratio = 0.0;
};

/// w^2 / D(s) and w s / D(s) of a force: the two motions of a mode, of similar size.
class ModeMotion {
 public:
  ModeMotion(const ModeQuestion& question, ModeGuess mode) {
    const double w = mode.frequency;
    ContinuousStateSpace system{Eigen::Matrix2d{{0.0, 1.0}, {-w * w, -2.0 * mode.damping_ratio * w}},
                                Eigen::Vector2d{0.0, 1.0}, Eigen::RowVector2d{1.0, 0.0}};
    const DiscreteStateSpace sampled = sample(system, {question.sampling_period, question.delay});
    const Eigen::Matrix2d Phi = sampled.Phi;
    const Eigen::Vector2d now = sampled.Gamma1;
    const Eigen::Vector2d before = sampled.Gamma2;
    const auto late = static_cast<std::ptrdiff_t>(sampled.delay_samples);
    const auto size = static_cast<std::ptrdiff_t>(question.force.size());
    const auto force = [&](std::ptrdiff_t k) { return k < 0 ? 0.0 : question.force[static_cast<std::size_t>(k)]; };
    position.reserve(question.force.size());
    velocity.reserve(question.force.size());
    Eigen::Vector2d state = Eigen::Vector2d::Zero();
    for (std::ptrdiff_t k = 0; k < size; ++k) {
      position.push_back(w * w * state(0));
      velocity.push_back(w * state(1));
      state += (Phi * state + now * force(k - late) + before * force(k - late - 1)).eval();
    }
  }

  std::vector<double> position;
  std::vector<double> velocity;
};

/// The rest of a fit beside the known columns, each line by the rest around it; and what a mode takes of its squares.
class Scan {
 public:
  Scan(const RestLines& rest, const ModeQuestion& question, const Eigen::VectorXcd& left)
      : rest_(rest), force_(rest.lines(question.force)), weights_(line_weights(left, rest.stretches)) {
    const Eigen::Index rows = rest.target.size();
    Eigen::MatrixXd known(2 * rows, rest.known.cols());
    known << (weights_.asDiagonal() * rest.known.real()), (weights_.asDiagonal() * rest.known.imag());
    for (Eigen::Index j = 0; j < known.cols(); ++j) known.col(j) /= std::max(known.col(j).norm(), 1e-300);
    constexpr double rank_tolerance = 1e-10;
    basis_ = orthonormal_basis(known, rank_tolerance);
    left_ = outside(left);
  }

  [[nodiscard]] double gain(ModeGuess mode) const {
    const double w = mode.frequency;
    const Eigen::ArrayXd share = rest_.frequencies.array() / w;
    Eigen::VectorXcd position(share.size());  // of a force that a window leaves as it is: near enough to look
    for (Eigen::Index k = 0; k < share.size(); ++k) {
      position(k) = force_(k) / std::complex<double>(1.0 - share(k) * share(k), 2.0 * mode.damping_ratio * share(k));
    }
    const Eigen::VectorXcd velocity = std::complex<double>(0.0, 1.0) * position.cwiseProduct(share.matrix());
    Eigen::MatrixXd columns(left_.size(), 2);
    columns << outside(position), outside(velocity);
    const Eigen::Matrix2d squares = columns.transpose() * columns;
    const Eigen::Vector2d product = columns.transpose() * left_;
    const double determinant = squares.determinant();
    if (!(determinant > 1e-9 * squares(0, 0) * squares(1, 1))) return 0.0;
    return product.dot(squares.inverse() * product);
  }

 private:
  [[nodiscard]] Eigen::VectorXd outside(const Eigen::VectorXcd& lines) const {
    Eigen::VectorXd stacked(2 * lines.size());
    stacked << weights_.cwiseProduct(lines.real()), weights_.cwiseProduct(lines.imag());
    return stacked - basis_ * (basis_.transpose() * stacked);
  }

  const RestLines& rest_;
  Eigen::VectorXcd force_;
  Eigen::VectorXd weights_;
  Eigen::MatrixXd basis_;
  Eigen::VectorXd left_;
};

/// Of light and of usual dampings, so close that one of them is near any mode; then nearer to the best.
ModeGuess best_of(const Scan& scan, const ModeQuestion& question) {
  ModeGuess best;
  double most = 0.0;
  const auto look_at = [&](ModeGuess mode) {
    if (!(mode.frequency >= question.lowest && mode.frequency <= question.highest)) return;
    const double gain = scan.gain(mode);
    if (!(gain > most)) return;
    most = gain;
    best = mode;
  };
  for (const double damping : {0.015, 0.08}) {
    const double step = 1.0 + 2.0 * damping;
    for (double w = question.lowest; w <= question.highest; w *= step) look_at({w, damping});
  }
  if (most == 0.0) return best;
  for (double share = 1.0; share > 0.1; share /= 2.0) {
    const ModeGuess from = best;
    for (const double width : {1.0 - 0.5 * share, 1.0, 1.0 + share}) {
      for (const double shift : {-share, -0.5 * share, 0.0, 0.5 * share, share}) {
        look_at({from.frequency * (1.0 + shift * from.damping_ratio), from.damping_ratio * width});
      }
    }
  }
  return best;
}

}  // namespace

std::optional<ModeBeside> find_missing_mode(const RestLines& rest, const ModeQuestion& question) {
  const auto without = regress_lines(rest.known, rest.target, rest.stretches);
  if (!without) return std::nullopt;
  const Scan scan(rest, question, rest.target - rest.known * without->values);
  const ModeGuess best = best_of(scan, question);
  if (!(best.frequency > 0.0)) return std::nullopt;
  const ModeMotion motion(question, best);
  const Eigen::Index known = rest.known.cols();
  Eigen::MatrixXcd columns(rest.known.rows(), known + 2);
  columns << rest.known, rest.lines(motion.position), rest.lines(motion.velocity);
  auto found = regress_lines(columns, rest.target, rest.stretches);
  if (!found || !(found->deviations(known) > 0.0) || !(found->deviations(known + 1) > 0.0)) return std::nullopt;
  const double w = best.frequency;
  const double a = found->values(known);
  const double b = found->values(known + 1);
  ModeBeside mode;
  mode.frequency = w;
  mode.damping_ratio = best.damping_ratio;
  mode.term.degree = 2;
  mode.term.numerator[0] = a * w * w;
  mode.term.numerator[1] = b * w;
  mode.term.denominator[0] = w * w;
  mode.term.denominator[1] = 2.0 * best.damping_ratio * w;
  mode.ratio = std::hypot(a / found->deviations(known), b / found->deviations(known + 1));
  mode.found = *std::move(found);
  return mode;
}

double share_of(const Device& device, const ModeBeside& mode) {
  return std::abs(response(mode.term, mode.frequency)) / std::abs(response(modal_form(device), mode.frequency));
}

double stiffness_with(const Device& device, const ModeBeside& mode) try {
  ModalForm form = modal_form(device);
  form.terms.push_back(mode.term);
  form.terms.back().mode = static_cast<int>(form.modes.size()) + 1;
  form.modes.push_back({mode.frequency, mode.damping_ratio});
  const SampledPlant plant = sample(form, {device.loop().sampling_period, device.loop().delay});
  return critical_stiffness(filtered_plant(plant, device.parameters().wall.filters)).stiffness;
} catch (const Error&) {
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace zwidth::internal
