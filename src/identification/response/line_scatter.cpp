#include "identification/response/line_scatter.hpp"

#include <algorithm>
#include <cstddef>

namespace zwidth::internal {
namespace {

/// Variance of one repetition's value about the mean over `count` of them (the last, of distance 0, included).
double scatter(double sum_of_squares, std::complex<double> sum, double count) {
  return std::max(0.0, sum_of_squares - std::norm(sum) / count) / (count - 1.0);
}

}  // namespace

void LineScatter::add(std::complex<double> d, std::complex<double> e) {
  force += d;
  output += e;
  ff += std::norm(d);
  xx += std::norm(e);
  xf += e * std::conj(d);
}

MeanForce mean_force(const LineScatter& line, double count) {
  return {line.last_force + line.force / count, scatter(line.ff, line.force, count)};
}

ResponsePoint response_point(const LineScatter& line, double count, double frequency) {
  const std::complex<double> f = mean_force(line, count).value;
  const std::complex<double> x = line.last_output + line.output / count;
  const std::complex<double> h = x / f;
  // sum |E - H D|^2, of which the mean is taken off as of any other.
  const double squares = line.xx - 2.0 * (std::conj(h) * line.xf).real() + std::norm(h) * line.ff;
  const double noise = scatter(squares, line.output - h * line.force, count);
  ResponsePoint point;
  point.frequency = frequency;
  point.value = h;
  point.variance = noise / (count * std::norm(f));
  point.coherence = x == 0.0 ? 0.0 : std::norm(x) / (std::norm(x) + noise);
  point.force = std::abs(f);
  return point;
}

std::size_t transient_repetitions(const std::vector<double>& distance) {
  constexpr std::size_t fewest = 4;
  constexpr double transient_ratio = 4.0;
  if (distance.size() < fewest) return 0;
  std::vector<double> later(distance.begin() + static_cast<std::ptrdiff_t>(distance.size() / 2), distance.end());
  const auto middle = later.begin() + static_cast<std::ptrdiff_t>(later.size() / 2);
  std::nth_element(later.begin(), middle, later.end());
  std::size_t transient = 0;
  while (transient < distance.size() / 2 && distance[transient] > transient_ratio * *middle) ++transient;
  return transient;
}

}  // namespace zwidth::internal
