#include "identification/missing_mode.hpp"

#include <tbb/parallel_for.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <utility>

#include "linear_systems.hpp"
#include "sampling/sampling_instants.hpp"
#include "signal/fourier.hpp"
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

/// The force of a record and a mode that it moves from rest: x[k + 1] = Phi x[k] + now F[k - d] + before F[k - d - 1], of
/// which w^2 x_1 and w x_2 are two motions of similar size.
class ModeMotion {
 public:
  ModeMotion(const ModeQuestion& question, ModeGuess mode) : force_(question.force), scale_(mode.frequency) {
    const double w = mode.frequency;
    const ContinuousStateSpace system{Eigen::Matrix2d{{0.0, 1.0}, {-w * w, -2.0 * mode.damping_ratio * w}},
                                      Eigen::Vector2d{0.0, 1.0}, Eigen::RowVector2d{1.0, 0.0}};
    const DiscreteStateSpace sampled = sample(system, {question.sampling_period, question.delay});
    phi_ = Eigen::Matrix2d::Identity() + sampled.Phi;
    now_ = sampled.Gamma1;
    before_ = sampled.Gamma2;
    late_ = sampled.delay_samples;
  }

  /// `visit(k, x[k])` of every sample, and of the one after the last.
  void play(const auto& visit) const {
    Eigen::Vector2d state = Eigen::Vector2d::Zero();
    for (std::size_t k = 0; k <= force_.size(); ++k) {
      visit(k, state);
      state = (phi_ * state + now_ * delayed(k, late_) + before_ * delayed(k, late_ + 1)).eval();
    }
  }

  /// Line of w^2 x_1 and w x_2 over a part of n samples, at z = e^{j w T}, z^n = 1, of the force's lines there, d and d + 1
  /// samples late, and of the states in the part's first sample less after its last:
  /// (z I - Phi) X = now F_d + before F_{d + 1} + z (x[0] - x[n]).
  [[nodiscard]] Eigen::Vector2cd line(std::complex<double> z, std::complex<double> force, std::complex<double> earlier,
                                      const Eigen::Vector2d& lost) const {
    const Eigen::Vector2cd right = now_ * force + before_ * earlier + lost * z;
    const std::complex<double> a = z - phi_(0, 0);
    const std::complex<double> d = z - phi_(1, 1);
    const std::complex<double> determinant = a * d - phi_(0, 1) * phi_(1, 0);
    return {scale_ * scale_ * (d * right(0) + phi_(0, 1) * right(1)) / determinant,
            scale_ * (phi_(1, 0) * right(0) + a * right(1)) / determinant};
  }

 private:
  [[nodiscard]] double delayed(std::size_t sample, std::size_t by) const {
    return sample < by || sample >= force_.size() ? 0.0 : force_[sample - by];
  }

  std::span<const double> force_;
  double scale_;
  Eigen::Matrix2d phi_;
  Eigen::Vector2d now_;
  Eigen::Vector2d before_;
  std::size_t late_ = 0;
};

/// One part of a record: its force at the lines that count and at their neighbours, which a Hann window mixes with them.
struct PartOfForce {
  std::size_t first = 0;
  std::size_t last = 0;
  std::vector<std::complex<double>> z;
  std::vector<std::complex<double>> force;    ///< by the whole samples of the delay late
  std::vector<std::complex<double>> earlier;  ///< one sample later than that
};

PartOfForce force_in(const RestPart& part, const ModeQuestion& question) {
  const std::size_t late = sampling_instants({question.sampling_period, question.delay}).whole_samples;
  const auto lines = [&](std::size_t by) {
    std::vector<double> samples(part.count, 0.0);
    for (std::size_t k = 0; k < part.count; ++k) {
      if (part.first + k >= by) samples[k] = question.force[part.first + k - by];
    }
    const auto all = spectrum(samples);
    const auto at = [&](std::size_t k) { return k < all.size() ? all[k] : std::conj(all[part.count - k]); };
    std::vector<std::complex<double>> found;
    for (std::size_t k = part.band.first - 1; k <= part.band.last; ++k) found.push_back(at(k));
    return found;
  };
  PartOfForce own{part.first, part.first + part.count, {}, lines(late), lines(late + 1)};
  const double turn = 2.0 * std::numbers::pi / static_cast<double>(part.count);
  for (std::size_t k = part.band.first - 1; k <= part.band.last; ++k) {
    own.z.push_back(std::polar(1.0, turn * static_cast<double>(k)));
  }
  return own;
}

/// 1 / rms of the rest around each line, by the median within a quarter of its frequency, which is wider than a mode: what
/// stands out of it is what is looked for.
Eigen::VectorXd broad_weights(const Eigen::VectorXcd& rest, const std::vector<RestPart>& parts) {
  constexpr double share = 0.25;
  constexpr std::size_t least_reach = 12;
  constexpr double median_of_squares = 0.6931471805599453;  // ln 2: of squares that are distributed exponentially
  const double smallest = 1e-30 * std::max(rest.cwiseAbs2().maxCoeff(), 1e-300);
  Eigen::VectorXd weights(rest.size());
  std::vector<double> squares;
  Eigen::Index row = 0;
  for (const RestPart& part : parts) {
    const std::size_t size = part.band.size();
    for (std::size_t k = 0; k < size;) {
      const auto reach =
          std::max(least_reach, static_cast<std::size_t>(share * static_cast<double>(part.band.first + k)));
      const std::size_t begin = k > reach ? k - reach : 0;
      const std::size_t end = std::min(size, k + reach + 1);
      squares.clear();
      for (std::size_t i = begin; i < end; ++i) squares.push_back(std::norm(rest(row + static_cast<Eigen::Index>(i))));
      const auto middle = squares.begin() + static_cast<std::ptrdiff_t>(squares.size() / 2);
      std::ranges::nth_element(squares, middle);
      const double weight = 1.0 / std::sqrt(std::max(*middle / median_of_squares, smallest));
      constexpr std::size_t steps = 4;  // in a reach
      for (const std::size_t next = std::min(size, k + reach / steps + 1); k < next; ++k) {
        weights(row + static_cast<Eigen::Index>(k)) = weight;
      }
    }
    row += static_cast<Eigen::Index>(size);
  }
  return weights;
}

/// The rest of a fit beside the known columns, each line by the rest around it; and what a mode takes of its squares.
class Scan {
 public:
  Scan(const RestLines& rest, const ModeQuestion& question, const Eigen::VectorXcd& left)
      : rest_(rest), question_(question), weights_(broad_weights(left, rest.parts)) {
    for (const RestPart& part : rest.parts) parts_.push_back(force_in(part, question));
    const Eigen::Index rows = rest.target.size();
    Eigen::MatrixXd known(2 * rows, rest.known.cols());
    known << (weights_.asDiagonal() * rest.known.real()), (weights_.asDiagonal() * rest.known.imag());
    for (Eigen::Index j = 0; j < known.cols(); ++j) known.col(j) /= std::max(known.col(j).norm(), 1e-300);
    constexpr double rank_tolerance = 1e-10;
    basis_ = orthonormal_basis(known, rank_tolerance);
    left_ = outside(left);
  }

  [[nodiscard]] double gain(ModeGuess mode) const {
    const Eigen::MatrixX2cd motion = lines_of_mode(mode);
    Eigen::MatrixXd columns(left_.size(), 2);
    columns << outside(motion.col(0)), outside(motion.col(1));
    const Eigen::Matrix2d squares = columns.transpose() * columns;
    const Eigen::Vector2d product = columns.transpose() * left_;
    const double determinant = squares.determinant();
    if (!(determinant > 1e-9 * squares(0, 0) * squares(1, 1))) return 0.0;
    return product.dot(squares.inverse() * product);
  }

 private:
  /// Under a Hann window, and as if that came before what whitens the motion: near enough to look.
  [[nodiscard]] Eigen::MatrixX2cd lines_of_mode(ModeGuess mode) const {
    const ModeMotion motion(question_, mode);
    std::vector<Eigen::Vector2d> lost(parts_.size(), Eigen::Vector2d::Zero());
    std::size_t begun = 0;
    std::size_t ended = 0;
    motion.play([&](std::size_t k, const Eigen::Vector2d& state) {
      if (begun < parts_.size() && parts_[begun].first == k) lost[begun++] += state;
      if (ended < parts_.size() && parts_[ended].last == k) lost[ended++] -= state;
    });
    Eigen::MatrixX2cd lines(rest_.target.size(), 2);
    Eigen::Index row = 0;
    for (std::size_t p = 0; p < parts_.size(); ++p) {
      const PartOfForce& part = parts_[p];
      const auto at = [&](std::size_t k) { return motion.line(part.z[k], part.force[k], part.earlier[k], lost[p]); };
      Eigen::Vector2cd below = at(0);
      Eigen::Vector2cd here = at(1);
      for (std::size_t k = 2; k < part.z.size(); ++k) {
        const Eigen::Vector2cd above = at(k);
        lines.row(row) = (0.5 * here - 0.25 * (below + above)).transpose() * rest_.filter(row);
        below = here;
        here = above;
        ++row;
      }
    }
    return lines;
  }

  [[nodiscard]] Eigen::VectorXd outside(const Eigen::VectorXcd& lines) const {
    Eigen::VectorXd stacked(2 * lines.size());
    stacked << weights_.cwiseProduct(lines.real()), weights_.cwiseProduct(lines.imag());
    return stacked - basis_ * (basis_.transpose() * stacked);
  }

  const RestLines& rest_;
  const ModeQuestion& question_;
  std::vector<PartOfForce> parts_;
  Eigen::VectorXd weights_;
  Eigen::MatrixXd basis_;
  Eigen::VectorXd left_;
};

/// Of light and of usual dampings, so close that one of them is near any mode; then nearer to the best.
ModeGuess best_of(const Scan& scan, const ModeQuestion& question) {
  ModeGuess best;
  double most = 0.0;
  const auto look_at = [&](const std::vector<ModeGuess>& modes) {
    std::vector<double> gains(modes.size(), 0.0);
    tbb::parallel_for(std::size_t{0}, modes.size(), [&](std::size_t i) {
      const double w = modes[i].frequency;
      if (w >= question.lowest && w <= question.highest) gains[i] = scan.gain(modes[i]);
    });
    for (std::size_t i = 0; i < modes.size(); ++i) {
      if (!(gains[i] > most)) continue;
      most = gains[i];
      best = modes[i];
    }
  };
  std::vector<ModeGuess> modes;
  for (const double damping : {0.015, 0.08}) {
    const double step = 1.0 + 2.0 * damping;
    for (double w = question.lowest; w <= question.highest; w *= step) modes.push_back({w, damping});
  }
  look_at(modes);
  if (most == 0.0) return best;
  for (double share = 1.0; share > 0.1; share /= 2.0) {
    modes.clear();
    for (const double width : {1.0 - 0.5 * share, 1.0, 1.0 + share}) {
      for (const double shift : {-share, -0.5 * share, 0.0, 0.5 * share, share}) {
        modes.push_back({best.frequency * (1.0 + shift * best.damping_ratio), best.damping_ratio * width});
      }
    }
    look_at(modes);
  }
  return best;
}

/// Lines of accelerations: each of positions by the square of its number.
Eigen::VectorXd rise_of(const std::vector<RestPart>& parts, Eigen::Index rows) {
  Eigen::VectorXd rise(rows);
  Eigen::Index row = 0;
  for (const RestPart& part : parts) {
    for (std::size_t k = part.band.first; k < part.band.last; ++k) {
      const double share = static_cast<double>(k) / static_cast<double>(part.band.last);
      rise(row++) = share * share;
    }
  }
  return rise;
}

/// The size of the last two columns, in deviations.
double ratio_of_last_two(const LineRegression& found) {
  const Eigen::Index last = found.values.size() - 1;
  return std::hypot(found.values(last - 1) / found.deviations(last - 1), found.values(last) / found.deviations(last));
}

}  // namespace

std::optional<ModeBeside> find_missing_mode(const RestLines& rest, const ModeQuestion& question) {
  const auto without = regress_lines(rest.known, rest.target, rest.stretches);
  if (!without) return std::nullopt;
  const Scan scan(rest, question, rest.target - rest.known * without->values);
  const ModeGuess best = best_of(scan, question);
  if (!(best.frequency > 0.0)) return std::nullopt;
  const double w = best.frequency;
  std::vector<double> position(question.force.size());
  std::vector<double> velocity(question.force.size());
  ModeMotion(question, best).play([&](std::size_t k, const Eigen::Vector2d& state) {
    if (k == position.size()) return;
    position[k] = w * w * state(0);
    velocity[k] = w * state(1);
  });
  const Eigen::Index known = rest.known.cols();
  Eigen::MatrixXcd motions(rest.known.rows(), 2);
  motions << rest.lines(position), rest.lines(velocity);
  auto found = regress_lines(rest.known, motions, rest.target, rest.stretches);
  if (!found || !(found->deviations(known) > 0.0) || !(found->deviations(known + 1) > 0.0)) return std::nullopt;
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
  mode.ratio = ratio_of_last_two(*found);
  for (std::size_t k = 0; k < position.size(); ++k) {
    mode.peak = std::max(mode.peak, std::abs(a * position[k] + b * velocity[k]));
  }
  // What pushes a body moves it less at each line than at the one below: of positions the lowest lines stand out of what lies
  // around them. A mode does of accelerations too.
  const Eigen::VectorXd rise = rise_of(rest.parts, rest.target.size());
  const auto also = regress_lines(rise.asDiagonal() * rest.known, rise.asDiagonal() * motions,
                                  rise.cwiseProduct(rest.target), rest.stretches);
  if (also) mode.ratio = std::fmin(mode.ratio, ratio_of_last_two(*also));
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
