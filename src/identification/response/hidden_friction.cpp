#include "identification/response/hidden_friction.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>
#include <numbers>
#include <vector>

#include "identification/response/period_detection.hpp"
#include "signal/fourier.hpp"

namespace zwidth::internal {
namespace {

using Signal = std::vector<double>;
using Lines = std::vector<std::complex<double>>;

constexpr std::size_t most_examined_samples = std::size_t{1} << 17U;
constexpr std::size_t block = 20;  // lines, for 6 numbers of a smooth response and a transient
constexpr std::size_t fewest_lines = 2 * block;
constexpr std::size_t period_block = 16;  // lines, for 10 real numbers
constexpr std::size_t reach = 12;         // lines to either side

/// The recorded velocity, over as many samples as keep the phase of the highest line.
Signal velocity_of(std::span<const double> output, OutputQuantity quantity, double period, double highest) {
  const std::size_t n = output.size();
  if (quantity == OutputQuantity::velocity) return {output.begin(), output.end()};
  Signal velocity(n, 0.0);
  if (quantity == OutputQuantity::acceleration) {
    double mean = 0.0;
    for (const double each : output) mean += each / static_cast<double>(n);
    for (std::size_t k = 1; k < n; ++k) velocity[k] = velocity[k - 1] + period * (output[k - 1] - mean);
    return velocity;
  }
  constexpr double least_turn = 0.6;  // rad, to either side
  const auto span = static_cast<std::size_t>(std::max(1.0, std::floor(least_turn / (highest * period))));
  for (std::size_t k = span; k + span < n; ++k) {
    velocity[k] = (output[k + span] - output[k - span]) / (2.0 * static_cast<double>(span) * period);
  }
  return velocity;
}

/// Less the line through its ends, which leaks into all lines.
Signal levelled(Signal signal) {
  const double slope = (signal.back() - signal.front()) / static_cast<double>(signal.size() - 1);
  for (std::size_t k = 0; k < signal.size(); ++k) signal[k] -= slope * static_cast<double>(k);
  return signal;
}

/// Whole periods averaged, the first left out where there are more; the signal where the force does not repeat.
Signal averaged(const Signal& signal, std::size_t period) {
  if (period == 0) return signal;
  const std::size_t periods = signal.size() / period;
  const std::size_t first = periods > 1 ? 1 : 0;
  Signal mean(period, 0.0);
  for (std::size_t k = first * period; k < periods * period; ++k) {
    mean[k % period] += signal[k] / static_cast<double>(periods - first);
  }
  return mean;
}

/// The lines of a recording.
struct Examined {
  double spacing = 0.0;  ///< rad/s
  bool repeats = false;
  Lines force;
  Lines output;
  Lines velocity;
  Lines sign;
  Lines square;  ///< of v|v|
};

std::optional<Examined> examined(const Recording& recording, double highest, const FrequencyResponseOptions& options) {
  const std::size_t n = std::min(recording.channels[0].samples.size(), most_examined_samples);
  if (n < fewest_lines) return std::nullopt;
  const Signal force(recording.channels[0].samples.begin(),
                     recording.channels[0].samples.begin() + static_cast<std::ptrdiff_t>(n));
  const Signal output = levelled(
      {recording.channels[1].samples.begin(), recording.channels[1].samples.begin() + static_cast<std::ptrdiff_t>(n)});
  const bool repeats = options.lines.empty() && options.excitation != FrequencyResponseOptions::Excitation::aperiodic;
  const std::size_t period = !repeats ? 0 : options.period ? *options.period : detect_period(force).value_or(0);
  const Signal velocity = velocity_of(output, options.output, recording.sampling_period, highest);
  // Means over each period of a velocity that is straight between its samples: held, as the force is.
  Signal sign(n, 0.0);
  Signal square(n, 0.0);
  for (std::size_t k = 0; k + 1 < n; ++k) {
    const double size = std::abs(velocity[k]) + std::abs(velocity[k + 1]);
    if (size > 0.0) sign[k] = (velocity[k] + velocity[k + 1]) / size;
    square[k] = 0.5 * (velocity[k] * std::abs(velocity[k]) + velocity[k + 1] * std::abs(velocity[k + 1]));
  }
  const std::size_t length = period == 0 ? n : period;
  return Examined{2.0 * std::numbers::pi / (recording.sampling_period * static_cast<double>(length)),
                  period != 0 && n / period > 1,
                  spectrum(averaged(force, period)),
                  spectrum(averaged(output, period)),
                  spectrum(averaged(velocity, period)),
                  spectrum(averaged(sign, period)),
                  spectrum(averaged(square, period))};
}

/// Of friction, as it opposes and a quarter of a turn on, and of drag: a delay turns them.
using Effects = Eigen::MatrixX4d;

/// The noise leaves the line's value known.
bool is_known(const ResponsePoint& point) {
  constexpr double most_noise = 0.05;
  return point.variance < most_noise * std::norm(point.value);
}

/// What a block of lines says of the two: motion = effects c + rest, both beside the smooth response; real parts of all lines,
/// then imaginary ones.
struct Block {
  Eigen::VectorXd motion;
  Effects effects;
  double freedom = 0.0;
};

Eigen::VectorXd parts_of(const Eigen::VectorXcd& lines) {
  Eigen::VectorXd parts(2 * lines.size());
  parts << lines.real(), lines.imag();
  return parts;
}

/// Smooth beside a force F, with what acts like it.
struct Equation {
  Eigen::MatrixXd basis;
  Eigen::VectorXd left;
  Eigen::VectorXcd friction;
  Eigen::VectorXcd drag;
};

/// Of a force that repeats, in which nothing leaks: F = (a(w^2) + j w b(w^2)) X + F_c S + D Q.
Equation of_period(const Examined& lines, std::span<const std::size_t> ks) {
  constexpr Eigen::Index smooth = 10;
  const auto count = static_cast<Eigen::Index>(ks.size());
  Equation equation{Eigen::MatrixXd(2 * count, smooth), {}, Eigen::VectorXcd(count), Eigen::VectorXcd(count)};
  Eigen::VectorXcd force(count);
  Eigen::MatrixXcd columns(count, smooth);
  const auto square_of = [](std::size_t k) { return std::pow(static_cast<double>(k), 2); };
  const double low = square_of(ks.front());
  const double high = square_of(ks.back());
  for (Eigen::Index i = 0; i < count; ++i) {
    const std::size_t k = ks[static_cast<std::size_t>(i)];
    const double t = (2.0 * square_of(k) - low - high) / (high - low);
    const std::complex<double> even = lines.output[k];
    const std::complex<double> rate(0.0, static_cast<double>(k) / static_cast<double>(ks.back()));
    columns.row(i) << even, t * even, t * t * even, rate * even, t * rate * even, t * t * rate * even, 1.0, t, rate,
        t * rate;
    force(i) = lines.force[k];
    equation.friction(i) = lines.sign[k];
    equation.drag(i) = lines.square[k];
  }
  for (Eigen::Index i = 0; i < smooth; ++i) equation.basis.col(i) = parts_of(columns.col(i));
  equation.left = parts_of(force);
  return equation;
}

/// Of any other: X = (p F + t) / w^2 - p (F_c S + D Q) / w^2, p and t parabolas of complex numbers. Nothing near a resonance,
/// which no parabola follows.
std::optional<Equation> of_record(const Examined& lines, std::span<const std::size_t> ks) {
  constexpr Eigen::Index smooth = 6;
  constexpr double resonant = 4.0;
  const auto count = static_cast<Eigen::Index>(ks.size());
  const auto middle = static_cast<double>(ks[ks.size() / 2]);
  const auto square_of = [&](std::size_t k) { return std::pow(static_cast<double>(k) / middle, 2); };
  const auto place_of = [&](Eigen::Index i) {
    return 2.0 * static_cast<double>(i) / static_cast<double>(count - 1) - 1.0;
  };
  double largest = 0.0;
  for (const std::size_t k : ks) largest = std::max(largest, std::abs(lines.force[k]));
  Eigen::MatrixXcd columns(count, smooth);
  Eigen::VectorXcd motion(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const std::size_t k = ks[static_cast<std::size_t>(i)];
    const double t = place_of(i);
    const std::complex<double> f = lines.force[k] / (largest * square_of(k));
    columns.row(i) << f, t * f, t * t * f, 1.0, t, t * t;
    motion(i) = lines.output[k];
  }
  const Eigen::VectorXcd numbers = columns.colPivHouseholderQr().solve(motion);
  Equation equation{Eigen::MatrixXd(2 * count, 2 * smooth), parts_of(motion), Eigen::VectorXcd(count),
                    Eigen::VectorXcd(count)};
  for (Eigen::Index i = 0; i < smooth; ++i) {
    equation.basis.col(2 * i) = parts_of(columns.col(i));
    equation.basis.col(2 * i + 1) = parts_of(std::complex<double>(0.0, 1.0) * columns.col(i));
  }
  double least = std::numeric_limits<double>::infinity();
  double most = 0.0;
  for (Eigen::Index i = 0; i < count; ++i) {
    const std::size_t k = ks[static_cast<std::size_t>(i)];
    const double t = place_of(i);
    const std::complex<double> rigid = (numbers(0) + t * numbers(1) + t * t * numbers(2)) / largest;
    least = std::min(least, std::abs(rigid));
    most = std::max(most, std::abs(rigid));
    equation.friction(i) = -rigid / square_of(k) * lines.sign[k];
    equation.drag(i) = -rigid / square_of(k) * lines.square[k];
  }
  if (most > resonant * least) return std::nullopt;
  return equation;
}

void add_blocks(std::vector<Block>& blocks, const Examined& lines, const FrequencyResponse& response) {
  // Beyond the lines that are known, what the force makes is not told from what leaks.
  const auto lowest = std::ranges::find_if(response.points, is_known);
  const auto highest = std::find_if(response.points.rbegin(), response.points.rend(), is_known);
  if (lowest == response.points.end()) return;
  const auto first = static_cast<std::size_t>(std::ceil(lowest->frequency / lines.spacing - 1e-6));
  const auto last = static_cast<std::size_t>(std::floor(highest->frequency / lines.spacing + 1e-6));
  std::vector<std::size_t> excited;
  double largest = 0.0;
  const std::size_t end = std::min(last + 1, lines.force.size());
  for (std::size_t k = std::max<std::size_t>(first, 1); k < end; ++k)
    largest = std::max(largest, std::abs(lines.force[k]));
  constexpr double notable = 1e-3;
  for (std::size_t k = std::max<std::size_t>(first, 1); k < end; ++k) {
    if (std::abs(lines.force[k]) > notable * largest) excited.push_back(k);
  }
  const std::size_t size = lines.repeats ? period_block : block;
  for (std::size_t begin = 0; begin + size <= excited.size(); begin += size) {
    const std::span ks(excited.begin() + static_cast<std::ptrdiff_t>(begin), size);
    const auto equation = lines.repeats ? of_period(lines, ks) : of_record(lines, ks);
    if (!equation) continue;
    const std::complex<double> quarter(0.0, 1.0);
    Effects effects(equation->left.size(), 4);
    effects << parts_of(equation->friction), parts_of(quarter * equation->friction), parts_of(equation->drag),
        parts_of(quarter * equation->drag);
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> smooth(equation->basis);
    blocks.push_back({equation->left - equation->basis * smooth.solve(equation->left),
                      effects - equation->basis * smooth.solve(effects),
                      static_cast<double>(equation->left.size() - smooth.rank())});
  }
}

/// What the coefficient of a real force is at least, whose phase a delay has turned forwards by no more than this.
double turned_back(std::complex<double> c) {
  constexpr double most_turned = std::numbers::pi / 3.0;
  const double angle = std::arg(c);
  const double beyond = angle > most_turned ? angle - most_turned : std::min(angle, 0.0);
  return std::max(0.0, std::abs(c) * std::cos(beyond));
}

/// Both at once, by least squares.
std::optional<HiddenForces> solved(std::span<const Block> blocks) {
  // In units of what they make of the motion, so that neither is small.
  Eigen::Vector4d scale = Eigen::Vector4d::Zero();
  for (const Block& each : blocks) scale += each.effects.colwise().squaredNorm().transpose();
  scale = scale.cwiseSqrt();
  if (!(scale.minCoeff() > 0.0)) return std::nullopt;
  Eigen::Vector4d c = Eigen::Vector4d::Zero();
  Eigen::Matrix4d known = Eigen::Matrix4d::Zero();
  constexpr int rounds = 3;
  for (int round = 0; round < rounds; ++round) {
    Eigen::Vector4d sum = Eigen::Vector4d::Zero();
    known.setZero();
    for (const Block& each : blocks) {
      const Effects effects = each.effects * scale.cwiseInverse().asDiagonal();
      const double variance = (each.motion - effects * c).squaredNorm() / each.freedom;
      if (!(variance > 0.0) || !std::isfinite(variance)) continue;
      sum += effects.transpose() * each.motion / variance;
      known += effects.transpose() * effects / variance;
    }
    const Eigen::LDLT<Eigen::Matrix4d> solver(known);
    if (solver.info() != Eigen::Success || !(solver.vectorD().minCoeff() > 0.0)) return std::nullopt;
    c = solver.solve(sum);
  }
  const Eigen::Matrix4d covariance = known.inverse();
  const auto force = [&](Eigen::Index i) {
    return HiddenForce{turned_back({c(i) / scale(i), c(i + 1) / scale(i + 1)}), std::sqrt(covariance(i, i)) / scale(i)};
  };
  return HiddenForces{force(0), force(2)};
}

/// Re sum S conj(V) / sum |V|^2 of the opposing force S and the force's mean power over the lines around this frequency.
struct Gain {
  double value = 0.0;
  double power = 0.0;
};
Gain gain_at(const Examined& lines, double frequency, const HiddenForces& forces) {
  const auto k = static_cast<std::size_t>(std::lround(frequency / lines.spacing));
  const std::size_t begin = std::max<std::size_t>(k, reach + 1) - reach;
  const std::size_t end = std::min(lines.sign.size(), k + reach + 1);
  double product = 0.0;
  double square = 0.0;
  double power = 0.0;
  for (std::size_t i = begin; i < end; ++i) {
    const std::complex<double> opposing = forces.friction.size * lines.sign[i] + forces.drag.size * lines.square[i];
    product += std::real(opposing * std::conj(lines.velocity[i]));
    square += std::norm(lines.velocity[i]);
    power += std::norm(lines.force[i]);
  }
  return square > 0.0 ? Gain{product / square, power} : Gain{};
}

}  // namespace

std::optional<HiddenForces> hidden_forces(std::span<const Recording> recordings,
                                          std::span<const FrequencyResponse> responses,
                                          const FrequencyResponseOptions& options) {
  std::vector<Block> blocks;
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    if (responses[r].points.size() < 2) continue;
    const auto lines = examined(recordings[r], responses[r].points.back().frequency, options);
    if (lines) add_blocks(blocks, *lines, responses[r]);
  }
  if (blocks.size() < fewest_lines / block) return std::nullopt;
  return solved(blocks);
}

FrequencyResponse without_forces(const FrequencyResponse& response, const HiddenForces& forces,
                                 std::span<const Recording> recordings, const FrequencyResponseOptions& options) {
  FrequencyResponse without = response;
  std::vector<Examined> all;
  for (const Recording& each : recordings) {
    if (auto lines = examined(each, response.points.back().frequency, options)) all.push_back(*std::move(lines));
  }
  for (ResponsePoint& point : without.points) {
    double sum = 0.0;
    double power = 0.0;
    for (const Examined& each : all) {
      const Gain gain = gain_at(each, point.frequency, forces);
      sum += gain.power * gain.value;
      power += gain.power;
    }
    if (!(power > 0.0) || !is_known(point)) continue;
    const std::complex<double> rate =
        std::polar(point.frequency, 0.5 * (std::numbers::pi + point.frequency * *response.sampling_period));
    const std::complex<double> factor = 1.0 / (1.0 - sum / power * rate * point.value);
    point.value *= factor;
    point.variance *= std::norm(factor * factor);
  }
  return without;
}

}  // namespace zwidth::internal
