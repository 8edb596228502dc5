#include "stability/users/dissipation_zeros.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "stability/roots/polynomial_roots.hpp"
#include "stability/users/sharp_zero_taylor.hpp"

namespace zwidth::internal {
namespace {

constexpr double sharp_depth = 0.02;       // of the zero's frequency or of Nyquist
constexpr double maybe_sharp = 0.06;       // the same, of roots in long double
constexpr double same_place = 0.03;        // relative: roots that may be one of higher multiplicity
constexpr double much_less_damped = 1e-4;  // a body, of the most damped one per mass

void add_scaled(DigitPolynomial& sum, const DigitPolynomial& p, double factor) {
  sum.resize(std::max(sum.size(), p.size()), ManyDigits(0.0));
  for (std::size_t k = 0; k < p.size(); ++k) sum[k] += factor * p[k];
}

void drop_leading_zeros(DigitPolynomial& p) {
  while (p.size() > 1 && p.back().is_zero()) p.pop_back();
}

bool is_zero(const DigitPolynomial& p) {
  return std::all_of(p.begin(), p.end(), [](const ManyDigits& each) { return each.is_zero(); });
}

/// The motion of a point or along a length. A rigid body moves as one: what is left of its motion is rounding.
DigitPolynomial motion_of(const Weights& weights, const MotionPolynomials& motions) {
  DigitPolynomial sum{ManyDigits(0.0)};
  std::vector<ManyDigits> sizes;
  for (const auto& [of, weight] : weights) {
    const DigitPolynomial& motion = motions.numerators[of];
    add_scaled(sum, motion, weight);
    sizes.resize(sum.size(), ManyDigits(0.0));
    for (std::size_t k = 0; k < motion.size(); ++k) sizes[k] += std::abs(weight) * abs(motion[k]);
  }
  for (std::size_t k = 0; k < sum.size(); ++k) {
    if (abs(sum[k]) <= zero_in_digits * sizes[k]) sum[k] = 0.0;
  }
  drop_leading_zeros(sum);
  return sum;
}

/// q^H Dmp q |det|² as a polynomial in X = w².
DigitPolynomial dissipation_of(const Device& device, const MotionPolynomials& motions) {
  DigitPolynomial sum{ManyDigits(0.0)};
  for (const DeviceLength& each : lengths_of(device)) {
    if (each.damping > 0.0) add_scaled(sum, squared_size(motion_of(each.weights, motions)), each.damping);
  }
  drop_leading_zeros(sum);
  return sum;
}

/// Beyond a hundred digits: without dips where all bodies are damped alike to within a factor.
bool is_damped_alike(const Device& device) {
  if (!device.has_bodies()) return false;
  double least = std::numeric_limits<double>::infinity();
  double most = 0.0;
  for (const Body& body : device.bodies()) {
    least = std::min(least, body.damping / body.mass);
    most = std::max(most, body.damping / body.mass);
  }
  for (const Link& link : device.links()) {
    const double mass = std::min(device.bodies()[link.first].mass, device.bodies()[link.second].mass);
    most = std::max(most, link.damping / mass);
  }
  return least > much_less_damped * most;
}

/// Of two bodies by a quadratic in X = w², where no zero is near the axis; nothing where one may be. With Z_oo of the
/// body that is not held and the link's k + jwb,
///
///     q^H Dmp q |det|² = d_h |Z_oo|² + d_o |k + jwb|² + b |Z_oo - k - jwb|²
std::optional<std::vector<DissipationZeros::Zero>> zeros_of_two_bodies(const Device& device, double nyquist) {
  const Body& held = device.bodies()[device.loop().held];
  const Body& other = device.bodies()[1 - device.loop().held];
  double stiffness = 0.0;
  double damping = 0.0;
  for (const Link& link : device.links()) {
    stiffness += link.stiffness;
    damping += link.damping;
  }
  const double whole_stiffness = stiffness + other.stiffness;
  const double whole_damping = damping + other.damping;
  const double quadratic = other.mass * other.mass * (held.damping + damping);
  const double half = 0.5 * (held.damping * (whole_damping * whole_damping - 2.0 * whole_stiffness * other.mass) +
                             other.damping * damping * damping +
                             damping * (other.damping * other.damping - 2.0 * other.stiffness * other.mass));
  const double constant = held.damping * whole_stiffness * whole_stiffness + other.damping * stiffness * stiffness +
                          damping * other.stiffness * other.stiffness;
  if (!(quadratic > 0.0)) return std::nullopt;
  const std::complex<double> root = std::sqrt(std::complex<double>(half * half - quadratic * constant));
  std::vector<DissipationZeros::Zero> zeros;
  for (const double side : {1.0, -1.0}) {
    const std::complex<double> w = std::sqrt((-half + side * root) / quadratic);
    if (w.real() == 0.0 && w.imag() == 0.0) continue;
    if (!(std::abs(w.imag()) > maybe_sharp * std::min(w.real(), nyquist))) return std::nullopt;
    zeros.push_back({w.real(), std::abs(w.imag())});
  }
  return zeros;
}

/// Sorts the roots of the dissipation in X = w² into sharp zeros and others.
class ZeroSearch {
 public:
  ZeroSearch(DissipationZeros& zeros, const MotionsInDigits& of, double nyquist, const DrivePath& drive)
      : zeros_(zeros), of_(of), nyquist_(nyquist), drive_(drive) {}

  void run() {
    // In units of the geometric mean of the roots.
    p_ = of_.dissipation;
    p_.erase(p_.begin(), std::find_if(p_.begin(), p_.end(), [](const ManyDigits& each) { return !each.is_zero(); }));
    if (p_.size() < 2) return;
    const auto degree = static_cast<long double>(p_.size() - 1);
    unit_ = std::pow(ManyDigits(abs(p_.front() / p_.back())).convert_to<long double>(), 1.0L / degree);
    ManyDigits power = ManyDigits(1.0) / abs(p_.front());
    std::vector<long double> coefficients;
    for (ManyDigits& each : p_) {
      each *= power;
      power *= unit_;
      coefficients.push_back(each.convert_to<long double>());
    }
    roots_ = polynomial_roots(coefficients);
    // Their product is that of the coefficients, unless one was not found or another twice.
    Root product = coefficients.back();
    for (const Root& each : roots_) product *= -each;
    zeros_.is_unknown = !(std::abs(product - coefficients.front()) <= same_place * std::abs(coefficients.front()));
    is_used_.assign(roots_.size(), false);
    for (std::size_t i = 0; i < roots_.size(); ++i) {
      if (!is_used_[i]) take(i);
    }
  }

 private:
  using Root = std::complex<long double>;

  void take(std::size_t i) {
    const Root w = std::sqrt(roots_[i] * unit_);
    const auto position = static_cast<double>(w.real());
    const auto depth = static_cast<double>(std::abs(w.imag()));
    if (!(depth <= maybe_sharp * std::min(position, nyquist_))) {
      if (roots_[i].imag() >= 0.0L) zeros_.others.push_back({position, depth});
    } else if (!take_multiple(i)) {
      take_pair(i);
    }
  }

  /// More than two roots so near each other that they may be one.
  bool take_multiple(std::size_t i) {
    std::vector<std::size_t> near;
    Root sum = 0.0L;
    for (std::size_t j = 0; j < roots_.size(); ++j) {
      if (is_used_[j] || !(std::abs(roots_[j] - roots_[i]) <= same_place * std::abs(roots_[i]))) continue;
      near.push_back(j);
      sum += roots_[j];
    }
    if (near.size() <= 2) return false;
    const ManyDigits middle = sum.real() / static_cast<long double>(near.size());
    const auto root = multiple_root(p_, near.size(), middle);
    if (!root || !add(-2.0 * *root, *root * *root)) return false;
    for (const std::size_t j : near) is_used_[j] = true;
    return true;
  }

  void take_pair(std::size_t i) {
    std::size_t partner = i;
    const auto distance = [&](std::size_t j) { return std::abs(roots_[j] - std::conj(roots_[i])); };
    for (std::size_t j = 0; j < roots_.size(); ++j) {
      if (j != i && !is_used_[j] && (partner == i || distance(j) < distance(partner))) partner = j;
    }
    const ManyDigits sum = (roots_[i] + roots_[partner]).real();
    const auto factor = quadratic_factor(p_, {ManyDigits(-sum), ManyDigits((roots_[i] * roots_[partner]).real())});
    is_used_[i] = is_used_[partner] = true;
    const bool is_there = factor && abs(factor->u + sum) <= same_place * abs(factor->u);
    if (partner == i || !is_there || !add(factor->u, factor->v)) zeros_.is_unknown = true;
  }

  /// The roots of X² + u X + v, middle + j height: sqrt(middle + j height) = w0 (1 + j depth).
  bool add(const ManyDigits& u, const ManyDigits& v) {
    const ManyDigits middle = -0.5 * u;
    if (!(middle > 0.0)) return false;
    const ManyDigits height_squared = std::max<ManyDigits>(v - middle * middle, ManyDigits(0.0));
    const bool is_exact = height_squared <= zero_in_digits * v;
    const ManyDigits size = is_exact ? middle : ManyDigits(sqrt(v));
    const ManyDigits w0 = sqrt(ManyDigits(unit_ * 0.5 * (size + middle)));
    const ManyDigits depth = is_exact ? ManyDigits(0.0) : ManyDigits(0.5 * unit_ * sqrt(height_squared) / (w0 * w0));
    const auto frequency = w0.convert_to<double>();
    const double away = depth.convert_to<double>() * frequency;
    if (away > sharp_depth * std::min(frequency, nyquist_)) {
      zeros_.others.push_back({frequency, away});
    } else {
      zeros_.sharp.push_back(sharp_zero(of_, w0, depth, drive_));
    }
    return true;
  }

  DissipationZeros& zeros_;
  const MotionsInDigits& of_;
  double nyquist_;
  DrivePath drive_;
  DigitPolynomial p_;
  long double unit_ = 1.0L;
  std::vector<Root> roots_;
  std::vector<bool> is_used_;
};

}  // namespace

DissipationZeros::DissipationZeros(const Device& device, double nyquist) {
  const std::size_t bodies = device.degrees_of_freedom();
  if (bodies > most_bodies_for_polynomials) {
    is_unknown = !is_damped_alike(device);
    return;
  }
  are_complete = true;
  if (device.has_bodies() && bodies == 2) {
    if (auto zeros = zeros_of_two_bodies(device, nyquist)) {
      others = *std::move(zeros);
      return;
    }
  }
  const Loop& loop = device.loop();
  const MotionPolynomials motions = motion_polynomials(device, weights_of(device, loop.held));
  const MotionsInDigits of{motion_of(weights_of(device, loop.sensed), motions),
                           motion_of(weights_of(device, loop.actuated), motions), motions.determinant,
                           dissipation_of(device, motions)};
  if (is_zero(of.dissipation) || is_zero(of.sensed) || is_zero(of.actuated)) return;
  const DrivePath drive = drive_path_of(device.parameters());
  const int falls = (drive.lag > 0.0 ? 1 : 0) + (drive.tracking > 0.0 ? 1 : 0);  // as 1/w each
  const auto degree = [](const DigitPolynomial& p) { return static_cast<int>(p.size()) - 1; };
  discs_diverge = degree(of.sensed) + degree(of.actuated) - 2 - 2 * degree(of.dissipation) - falls >= -1;
  ZeroSearch(*this, of, nyquist, drive).run();
  std::sort(sharp.begin(), sharp.end(),
            [](const SharpZero& a, const SharpZero& b) { return a.frequency < b.frequency; });
  const auto same = std::adjacent_find(
      sharp.begin(), sharp.end(), [](const SharpZero& a, const SharpZero& b) { return a.frequency == b.frequency; });
  is_unknown = is_unknown || same != sharp.end();  // one pair found twice
  are_complete = !is_unknown;
}

}  // namespace zwidth::internal
