#include "stability/tip/crossover_scan.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "stability/loop/damper_response.hpp"
#include "stability/tip/scan_angles.hpp"

namespace zwidth::internal {

using std::numbers::pi;

namespace {

constexpr double lowest_crossover = 1e-5;  // rad a sample
constexpr int crossover_angles = 120;
constexpr int most_halvings = 80;

}  // namespace

CrossoverScan::CrossoverScan(const PosedTip& posed)
    : damper_(posed.damper()),
      period_(posed.plant.period),
      response_(posed.plant),
      angles_(scan_angles(lowest_crossover, crossover_angles, angles_around(response_.poles()))) {
  for (const double angle : angles_) samples_.push_back(response_.at(angle));
}

CrossoverScan::Found CrossoverScan::least_along(const Eigen::VectorXd& normal) const {
  std::vector<std::complex<double>> values;
  for (std::size_t i = 0; i < angles_.size(); ++i) values.push_back(stiffness(samples_[i], angles_[i], normal));
  Found least;
  if (values.back().real() > 0.0) least = {values.back().real(), pi};
  for (std::size_t i = 0; i + 2 < values.size(); ++i) {
    if (!(values[i].imag() * values[i + 1].imag() < 0.0)) continue;
    if (values[i].real() < 0.0 && values[i + 1].real() < 0.0) continue;
    const Found found = crossover(normal, angles_[i], values[i], angles_[i + 1], values[i + 1]);
    if (found.stiffness > 0.0 && found.stiffness < least.stiffness) least = found;
  }
  return least;
}

std::complex<double> CrossoverScan::stiffness(const Eigen::MatrixXcd& plant, double angle,
                                              const Eigen::VectorXd& normal) const {
  const std::complex<double> p = (normal.transpose() * plant * normal).value();
  return -1.0 / p - damper_response(damper_, period_, angle / period_);
}

// False position, by which no end stays twice (Illinois).
CrossoverScan::Found CrossoverScan::crossover(const Eigen::VectorXd& normal, double a, std::complex<double> at_a,
                                              double b, std::complex<double> at_b) const {
  double fa = at_a.imag();
  double fb = at_b.imag();
  Found found;
  for (int step = 0; step < most_halvings; ++step) {
    found.angle = std::clamp(b - fb * (b - a) / (fb - fa), std::min(a, b), std::max(a, b));
    const std::complex<double> value = stiffness(response_.at(found.angle), found.angle, normal);
    found.stiffness = value.real();
    const bool is_there =
        value.imag() == 0.0 || std::abs(b - a) <= 4e-15 * b || std::abs(value.imag()) < 1e-15 * std::abs(value.real());
    if (is_there) break;
    if (value.imag() * fb < 0.0) {
      a = b;
      fa = fb;
    } else {
      fa *= 0.5;
    }
    b = found.angle;
    fb = value.imag();
  }
  return found;
}

}  // namespace zwidth::internal
