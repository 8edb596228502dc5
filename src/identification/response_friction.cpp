#include "identification/response_friction.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

#include "signal/fourier.hpp"
#include "signal/window_function.hpp"
#include "zwidth/signal/window.hpp"

namespace zwidth::internal {
namespace {

constexpr std::size_t least_examined_samples = 512;
constexpr std::size_t most_examined_samples = std::size_t{1} << 17U;
constexpr std::size_t fewest_points = 8;
constexpr std::size_t reach = 12;  // lines to either side
// A Hann window makes neighbouring lines share: 1.94 times the variance of independent ones.
constexpr double shared_variance = 1.94;

using Signal = std::vector<double>;
using Lines = RecordedSliding::Lines;

Lines windowed_spectrum(std::span<const double> signal) {
  const Signal window = window_function(Window::hann, signal.size());
  Signal product(signal.begin(), signal.end());
  for (std::size_t i = 0; i < product.size(); ++i) product[i] *= window[i];
  return spectrum(product);
}

/// The response on the lines of a record, between its points; 0 outside.
Lines interpolated(const FrequencyResponse& response, std::size_t count, double step) {
  Lines lines(count, 0.0);
  const std::vector<ResponsePoint>& points = response.points;
  std::size_t above = 1;
  for (std::size_t k = 1; k < count; ++k) {
    const double frequency = step * static_cast<double>(k);
    while (above + 1 < points.size() && points[above].frequency < frequency) ++above;
    const ResponsePoint& low = points[above - 1];
    const ResponsePoint& high = points[above];
    if (frequency < low.frequency || frequency > high.frequency) continue;
    const double share = (frequency - low.frequency) / (high.frequency - low.frequency);
    lines[k] = low.value + share * (high.value - low.value);
  }
  return lines;
}

/// Less what is proportional to the force on the lines around each.
Lines beside_force(const Lines& lines, const Lines& force) {
  Lines left = lines;
  for (std::size_t k = 0; k < lines.size(); ++k) {
    const std::size_t begin = k - std::min(k, reach);
    const std::size_t end = std::min(lines.size(), k + reach + 1);
    std::complex<double> shared = 0.0;
    double power = 0.0;
    for (std::size_t i = begin; i < end; ++i) {
      shared += lines[i] * std::conj(force[i]);
      power += std::norm(force[i]);
    }
    if (power > 0.0) left[k] -= shared / power * force[k];
  }
  return left;
}

/// Mean squares of the lines around each.
Signal powers_around(const Lines& lines) {
  Signal sums(lines.size() + 1, 0.0);
  for (std::size_t k = 0; k < lines.size(); ++k) sums[k + 1] = sums[k] + std::norm(lines[k]);
  const double least = 1e-12 * sums.back() / static_cast<double>(lines.size());
  Signal powers(lines.size());
  for (std::size_t k = 0; k < lines.size(); ++k) {
    const std::size_t begin = k - std::min(k, reach);
    const std::size_t end = std::min(lines.size(), k + reach + 1);
    powers[k] = (sums[end] - sums[begin]) / static_cast<double>(end - begin) + least;
  }
  return powers;
}

/// The recorded velocity, over as many samples as keep the phase of the highest line; without its drift's beginning.
Signal velocity_of(std::span<const double> output, OutputQuantity quantity, double period, double highest) {
  const std::size_t n = output.size();
  Signal velocity(n, 0.0);
  if (quantity == OutputQuantity::velocity) return {output.begin(), output.end()};
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

/// The velocity of a hidden body.
Signal passed(const Signal& signal, const HiddenBody& body, double period) {
  const std::size_t n = signal.size();
  const Lines half = spectrum(signal);
  const double step = 2.0 * std::numbers::pi / (period * static_cast<double>(n));
  Lines all(n, 0.0);
  for (std::size_t k = 0; 2 * k < n; ++k) {
    all[k] = half[k] * body.passage(step * static_cast<double>(k));
    if (k > 0) all[n - k] = std::conj(all[k]);
  }
  Lines moved(n);
  FourierTransform(n).inverse(all, moved);
  Signal left(n);
  std::ranges::transform(moved, left.begin(), [](const std::complex<double>& value) { return value.real(); });
  return left;
}

std::complex<double> passage_of(const std::optional<HiddenBody>& body, double at) {
  return body ? body->passage(at) : 1.0;
}

/// Less its mean and the line through its ends: neither leaks through the window.
Signal levelled(std::span<const double> signal) {
  Signal level(signal.begin(), signal.end());
  const double slope = (level.back() - level.front()) / static_cast<double>(level.size() - 1);
  for (std::size_t k = 0; k < level.size(); ++k) level[k] -= slope * static_cast<double>(k);
  double mean = 0.0;
  for (const double each : level) mean += each / static_cast<double>(level.size());
  for (double& each : level) each -= mean;
  return level;
}

/// Re sum S conj(V) / sum |V|^2 over the lines around each, or S/V on each.
Lines gains(const Lines& sign, const Lines& velocity, bool of_lines) {
  const Signal powers = powers_around(velocity);
  Signal products(sign.size() + 1, 0.0);
  for (std::size_t k = 0; k < sign.size(); ++k)
    products[k + 1] = products[k] + std::real(sign[k] * std::conj(velocity[k]));
  Lines found(sign.size());
  for (std::size_t k = 0; k < sign.size(); ++k) {
    const std::size_t begin = k - std::min(k, reach);
    const std::size_t end = std::min(sign.size(), k + reach + 1);
    found[k] = of_lines && velocity[k] != 0.0
                   ? sign[k] / velocity[k]
                   : (products[end] - products[begin]) / (static_cast<double>(end - begin) * powers[k]);
  }
  return found;
}

/// What the coefficient of a real force is at least, whose phase a delay has turned forwards by no more than this.
double turned_back(std::complex<double> c) {
  constexpr double most_turned = std::numbers::pi / 3.0;
  const double angle = std::arg(c);
  const double beyond = angle > most_turned ? angle - most_turned : std::min(angle, 0.0);
  return std::max(0.0, std::abs(c) * std::cos(beyond));
}

template <typename Values>
auto on_line(const RecordedSliding& sliding, const Values& values, double frequency) {
  const auto line = static_cast<std::size_t>(std::lround(frequency / sliding.line_spacing));
  return values[std::min(line, values.size() - 1)];
}

/// jw / D of a held force.
std::complex<double> rate_without_hold(double frequency, double period) {
  return std::polar(frequency, 0.5 * (std::numbers::pi + frequency * period));
}

/// The coefficient of the effect in the target, each line weighted by the rest around it.
std::optional<FrictionEstimate> regressed(const Lines& target, const Lines& effect, const Lines& plant) {
  std::complex<double> c = 0.0;
  double weight = 0.0;
  Lines left = target;
  constexpr int rounds = 3;
  for (int round = 0; round < rounds; ++round) {
    const Signal powers = powers_around(left);
    std::complex<double> sum = 0.0;
    weight = 0.0;
    for (std::size_t k = 0; k < target.size(); ++k) {
      if (plant[k] == 0.0) continue;
      sum += target[k] * std::conj(effect[k]) / powers[k];
      weight += std::norm(effect[k]) / powers[k];
    }
    if (!(weight > 0.0)) return std::nullopt;
    c = sum / weight;
    for (std::size_t k = 0; k < target.size(); ++k) left[k] = target[k] - c * effect[k];
  }
  return FrictionEstimate{turned_back(-c), std::sqrt(shared_variance / (2.0 * weight))};
}

}  // namespace

std::complex<double> HiddenBody::passage(double at) const {
  const double ratio = at / frequency;
  return 1.0 / std::complex<double>(1.0 - ratio * ratio, 2.0 * damping_ratio * ratio);
}

std::vector<HiddenBody> hidden_bodies(const FrequencyResponse& response) {
  constexpr std::size_t most = 3;
  constexpr double least_damping = 0.003;
  constexpr double most_damping = 0.3;
  constexpr double farthest = 2.0;                   // lines
  std::vector<std::pair<double, HiddenBody>> found;  // by how deep they are
  const std::vector<ResponsePoint>& points = response.points;
  for (std::size_t i = 2; i + 2 < points.size(); ++i) {
    const auto size = [&](std::size_t line) {
      return std::abs(points[line].value) * std::pow(points[line].frequency, 2);
    };
    if (size(i) > std::min({size(i - 1), size(i + 1), size(i - 2), size(i + 2)})) continue;
    // The zero of the line through three complex values.
    const double spacing = 0.5 * (points[i + 1].frequency - points[i - 1].frequency);
    const std::complex<double> slope = (points[i + 1].value - points[i - 1].value) / (2.0 * spacing);
    const std::complex<double> mean = (points[i - 1].value + points[i].value + points[i + 1].value) / 3.0;
    if (slope == 0.0) continue;
    const std::complex<double> off = -mean / slope;
    const double frequency = points[i].frequency + off.real();
    if (std::abs(off.real()) > farthest * spacing || !(frequency > 0.0)) continue;
    const double damping = std::abs(off.imag()) / frequency;
    if (damping > most_damping) continue;
    // Near the zero G is (w_a^2 - w^2) m/k^2, of which 2 w_a m/k^2 = 2/(w_a k) is the slope.
    found.emplace_back(size(i) / std::max(size(i - 2), size(i + 2)),
                       HiddenBody{frequency, std::max(damping, least_damping), 0.5 * std::abs(slope) * frequency});
  }
  std::ranges::sort(found, {}, [](const auto& each) { return each.first; });
  std::vector<HiddenBody> bodies;
  for (const auto& [depth, body] : found) {
    if (bodies.size() < most) bodies.push_back(body);
  }
  return bodies;
}

std::complex<double> RecordedSliding::gain_at(double at) const { return on_line(*this, gain, at); }
double RecordedSliding::force_power_at(double at) const { return on_line(*this, force_power, at); }

std::optional<RecordedSliding> recorded_sliding(const FrequencyResponse& response, const Recording& recording,
                                                const SlidingQuestion& question) {
  const std::size_t n = std::min(recording.channels[0].samples.size(), most_examined_samples);
  if (n < least_examined_samples || response.points.size() < fewest_points || !response.sampling_period)
    return std::nullopt;
  const auto force = std::span(recording.channels[0].samples).first(n);
  const auto output = std::span(recording.channels[1].samples).first(n);
  const double period = *response.sampling_period;
  RecordedSliding found;
  found.line_spacing = 2.0 * std::numbers::pi / (period * static_cast<double>(n));
  const Signal velocity = velocity_of(output, question.output, period, response.points.back().frequency);
  const Signal moved_body = question.body ? passed(velocity, *question.body, period) : velocity;
  Signal sign(n);
  std::ranges::transform(moved_body, sign.begin(), [](double v) { return v > 0.0 ? 1.0 : v < 0.0 ? -1.0 : 0.0; });

  const Lines force_lines = windowed_spectrum(force);
  const Lines velocity_lines = windowed_spectrum(moved_body);
  Lines effect = windowed_spectrum(sign);
  found.gain = gains(effect, velocity_lines, question.of_lines);
  found.force_power = powers_around(force_lines);
  if (question.output != OutputQuantity::position) return found;

  const Lines plant = interpolated(response, n / 2 + 1, found.line_spacing);
  Lines target = windowed_spectrum(levelled(output));
  double moved = 0.0;
  double rest = 0.0;
  for (std::size_t k = 0; k < target.size(); ++k) {
    target[k] -= plant[k] * force_lines[k];
    effect[k] -= found.gain[k] * velocity_lines[k];
    if (plant[k] == 0.0) continue;
    const double square = std::pow(static_cast<double>(k), 2);
    moved += square * std::norm(target[k] + plant[k] * force_lines[k]);
    rest += square * std::norm(target[k]);
  }
  if (!(moved > 0.0)) return std::nullopt;
  constexpr double most_unexplained = 0.03;  // of the velocity's power in the band
  found.is_followed = rest < most_unexplained * moved;
  if (question.of_lines) return found;
  target = beside_force(target, force_lines);
  effect = beside_force(effect, force_lines);
  for (std::size_t k = 0; k < effect.size(); ++k) {
    const double frequency = found.line_spacing * static_cast<double>(k);
    effect[k] *= plant[k] * passage_of(question.body, frequency) * std::polar(1.0, 0.5 * frequency * period);
  }
  found.friction = regressed(target, effect, plant);
  return found;
}

std::optional<FrictionEstimate> friction_between(std::span<const FrequencyResponse> responses,
                                                 std::span<const RecordedSliding> slidings,
                                                 const std::optional<HiddenBody>& body) {
  struct Difference {
    std::complex<double> value;
    std::complex<double> of_unit_friction;
    double variance = 0.0;
  };
  constexpr double clear = 10.0;  // |H|^2 over its variance
  constexpr double rounding = 1e-9;
  std::vector<Difference> lines;
  double correlation = 1.0;
  for (std::size_t r = 0; r < responses.size(); ++r) {
    correlation = std::max(correlation, responses[r].line_correlation);
    for (std::size_t s = r + 1; s < responses.size(); ++s) {
      auto other = responses[s].points.begin();
      for (const ResponsePoint& point : responses[r].points) {
        while (other != responses[s].points.end() && other->frequency < (1.0 - rounding) * point.frequency) ++other;
        if (other == responses[s].points.end()) break;
        if (other->frequency > (1.0 + rounding) * point.frequency) continue;
        const double variance = point.variance + other->variance;
        const double weaker = std::min(std::norm(point.value), std::norm(other->value));
        if (!(variance > 0.0) || weaker < clear * variance) continue;
        const std::complex<double> gain = slidings[r].gain_at(point.frequency) - slidings[s].gain_at(point.frequency);
        const std::complex<double> passage = passage_of(body, point.frequency);
        lines.push_back({other->value - point.value,
                         gain * rate_without_hold(point.frequency, *responses[r].sampling_period) * point.value *
                             other->value * passage * passage,
                         variance});
      }
    }
  }
  std::complex<double> sum = 0.0;
  double weight = 0.0;
  for (const Difference& each : lines) {
    sum += each.value * std::conj(each.of_unit_friction) / each.variance;
    weight += std::norm(each.of_unit_friction) / each.variance;
  }
  if (!(weight > 0.0)) return std::nullopt;
  const std::complex<double> c = sum / weight;
  double rest = 0.0;
  for (const Difference& each : lines) rest += std::norm(each.value - c * each.of_unit_friction) / each.variance;
  const double scatter = rest / std::max(1.0, static_cast<double>(lines.size()) - 1.0);
  return FrictionEstimate{turned_back(c), std::sqrt(correlation * std::max(1.0, scatter) / (2.0 * weight))};
}

FrequencyResponse without_friction(const FrequencyResponse& response, std::span<const RecordedSliding> slidings,
                                   double force, const std::optional<HiddenBody>& body) {
  FrequencyResponse without = response;
  for (ResponsePoint& point : without.points) {
    double weights = 0.0;
    std::complex<double> gain = 0.0;
    for (const RecordedSliding& each : slidings) {
      weights += each.force_power_at(point.frequency);
      gain += each.force_power_at(point.frequency) * each.gain_at(point.frequency);
    }
    if (!(weights > 0.0)) continue;
    const std::complex<double> damping =
        force * gain / weights * rate_without_hold(point.frequency, *response.sampling_period);
    const std::complex<double> passage = passage_of(body, point.frequency);
    const std::complex<double> own = point.value * passage * passage + passage * (body ? body->compliance : 0.0);
    const std::complex<double> factor = 1.0 + damping * point.value * passage * passage / (1.0 - damping * own);
    point.value *= factor;
    point.variance *= std::norm(factor * factor);
  }
  return without;
}

}  // namespace zwidth::internal
