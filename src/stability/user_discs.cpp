#include "stability/user_discs.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "zwidth/error.hpp"

namespace zwidth::internal {
namespace {

using std::numbers::pi;
constexpr double clear_of_modes = 2.5;    // aliases beyond this many times the highest mode are summed by the rule
constexpr double clear_of_corners = 4.0;  // beyond this many times the highest corner frequency its tail begins
constexpr std::size_t least_exact_aliases = 12;
constexpr double most_exact_aliases = 20000.0;
constexpr double infinity = std::numeric_limits<double>::infinity();

Device without_operator(const Device& device) {
  DeviceParameters parameters = device.parameters();
  parameters.user = {};
  return Device(std::move(parameters));
}

/// |z| of a density, which is far from where squares overflow or vanish.
double size_of(std::complex<double> z) { return std::sqrt(std::norm(z)); }

}  // namespace

UserDiscs::UserDiscs(const Device& device)
    : sensed_(device.loop().sensed),
      actuated_(device.loop().actuated),
      held_(device.loop().held),
      lag_(device.parameters().actuator.time_constant),
      period_(device.loop().sampling_period),
      delay_(device.loop().delay),
      plant_(filtered_plant(without_operator(device))) {
  if (!device.has_bodies()) throw Error(ErrorCode::needs_bodies, "a transfer function has no body for a user to hold");
  const Device free = without_operator(device);
  for (std::size_t i = 0; i < free.bodies().size(); ++i) {
    positions_.push_back(modal_form(free, {held_, i}, ActuatorLag::left_out));
    if (free.bodies()[i].damping > 0.0) dampers_.push_back({i, i, free.bodies()[i].damping});
  }
  for (const Link& link : free.links()) {
    if (link.damping > 0.0) dampers_.push_back({link.first, link.second, link.damping});
  }
  through_ = modal_form(free, {actuated_, sensed_}, ActuatorLag::left_out);
  matrices_ = device_matrices<double>(free);
  undamped_ = dampers_.empty();
  if (undamped_) return;
  double highest_mode = 0.0;
  double highest_corner = lag_ > 0.0 ? 1.0 / lag_ : 0.0;
  for (const Mode& mode : held_form().modes) {
    highest_mode = std::max(highest_mode, mode.frequency);
    highest_corner = std::max(highest_corner, mode.frequency * (1.0 + 2.0 * mode.damping_ratio));
  }
  for (const Link& link : free.links()) {
    if (link.damping > 0.0) highest_corner = std::max(highest_corner, link.stiffness / link.damping);
  }
  const double spacing = 2.0 * pi / period_;
  exact_aliases_ = least_exact_aliases + static_cast<std::size_t>(std::min(
                                             std::ceil(clear_of_modes * highest_mode / spacing), most_exact_aliases));
  steady_alias_ = clear_of_corners * highest_corner / spacing;
  rule_ = alias_rule(exact_aliases_, steady_alias_, spacing * delay_);
  const AliasRule finer = alias_rule(2 * exact_aliases_, 4.0 * steady_alias_, spacing * delay_);
  for (const double share : {0.03, 0.5, 1.0}) {
    const Disc coarse = summed(rule_, share * pi / period_);
    const Disc fine = summed(finer, share * pi / period_);
    truncation_ =
        std::max(truncation_,
                 std::max(std::abs(coarse.centre - fine.centre), std::abs(coarse.radius - fine.radius)) / fine.radius);
  }
}

std::complex<double> UserDiscs::disc_density(double frequency) const {
  std::array<std::complex<double>, 8> few;
  std::vector<std::complex<double>> many;
  std::complex<double>* q = few.data();
  if (positions_.size() > few.size()) {
    many.resize(positions_.size());
    q = many.data();
  }
  double largest = 0.0;
  for (std::size_t i = 0; i < positions_.size(); ++i) {
    q[i] = response(positions_[i], frequency);
    largest = std::max({largest, std::abs(q[i].real()), std::abs(q[i].imag())});
  }
  // Scaled by the largest, so that squares neither overflow nor vanish.
  const double unit = 1.0 / largest;
  double dissipation = 0.0;
  for (const Damper& each : dampers_) {
    const std::complex<double> motion = each.second == each.first ? q[each.first] : q[each.first] - q[each.second];
    dissipation += each.damping * std::norm(motion * unit);
  }
  const std::complex<double> through = (q[sensed_] * unit) * (q[actuated_] * unit);
  const std::complex<double> density = through / (2.0 * frequency * frequency * dissipation);
  return lag_ > 0.0 ? density / std::complex<double>(1.0, lag_ * frequency) : density;
}

UserDiscs::Disc UserDiscs::at(double frequency) const {
  if (undamped_) return {response(plant_, frequency), infinity, -infinity};
  return frequency * period_ < clear_angle ? near_zero(frequency) : summed(rule_, frequency);
}

/// (G_sa - D)/(jw), lag included: the centre of one alias, over what the hold makes of it.
std::complex<double> UserDiscs::centre_density(double frequency) const {
  const std::complex<double> s(0.0, frequency);
  return response(through_, frequency) / (s * (1.0 + lag_ * s)) - disc_density(frequency);
}

/// |G_sa - D|² - |D|² = |G_sa|²/R Re[jw X], X the response G_hh with the sensed position kept at 0 by a force at the
/// actuated body (0 where either is the held body): no cancellation.
///
///     [-w² M + jw C + K   -e_a] [x]   [e_h]
///     [      e_s^T          0 ] [f] = [ 0 ],    X = e_h^T x
double UserDiscs::own_power(double frequency) const {
  if (held_ == sensed_ || held_ == actuated_) return 0.0;
  const auto n = static_cast<Eigen::Index>(matrices_.mass.size());
  Eigen::MatrixXcd bordered = Eigen::MatrixXcd::Zero(n + 1, n + 1);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      const auto entry = static_cast<std::size_t>(i * n + j);
      bordered(i, j) = {matrices_.stiffness[entry], frequency * matrices_.damping[entry]};
    }
    bordered(i, i) -= frequency * frequency * matrices_.mass[static_cast<std::size_t>(i)];
  }
  const auto held = static_cast<Eigen::Index>(held_);
  // The border as large as the rest.
  const double size = bordered.cwiseAbs().maxCoeff();
  bordered(static_cast<Eigen::Index>(actuated_), n) = -size;
  bordered(n, static_cast<Eigen::Index>(sensed_)) = size;
  Eigen::VectorXcd force = Eigen::VectorXcd::Zero(n + 1);
  force(held) = 1.0;
  const std::complex<double> kept = Eigen::FullPivLU<Eigen::MatrixXcd>(bordered).solve(force)(held);
  const double conductance = -frequency * response(positions_[held_], frequency).imag();  // R = Re[jw G_hh]
  return std::norm(response(through_, frequency)) / std::norm(std::complex<double>(1.0, lag_ * frequency)) *
         (-frequency * kept.imag()) / conductance;
}

/// With c_0 and r_0 of w itself, which grow as 1/w, and dc and dr of all other aliases, which fall as w:
///
///     |c|² - r² = (|c_0|² - r_0²) + 2 Re[c_0 conj dc] - 2 r_0 dr + |dc|² - dr²
UserDiscs::Disc UserDiscs::near_zero(double frequency) const {
  const double spacing = 2.0 * pi / period_;
  const std::complex<double> late = std::polar(1.0, -frequency * delay_);
  std::complex<double> centre = 0.0;
  double radius = 0.0;
  for (const AliasRule::Node& node : rule_.nodes) {
    if (node.number == 0.0) continue;
    const double offset = node.number * spacing;
    centre += node.turning * (centre_density(offset + frequency) * late);
    centre += std::conj(node.turning * (centre_density(offset - frequency) * std::conj(late)));
    radius += node.still * (std::abs(disc_density(offset + frequency)) + std::abs(disc_density(offset - frequency)));
  }
  // F (1 - e^{-jwT})/T
  const std::complex<double> factor = filter_response(plant_, frequency * period_) * 2.0 *
                                      std::sin(0.5 * frequency * period_) / period_ *
                                      std::polar(1.0, 0.5 * (pi - frequency * period_));
  const std::complex<double> own_centre = factor * late * centre_density(frequency);
  const double own_radius = std::abs(factor) * std::abs(disc_density(frequency));
  centre *= factor;
  radius *= std::abs(factor);
  const double own = std::norm(factor / frequency) * own_power(frequency);
  return {own_centre + centre, own_radius + radius,
          own + 2.0 * (own_centre * std::conj(centre)).real() - 2.0 * own_radius * radius + std::norm(centre) -
              radius * radius};
}

UserDiscs::Disc UserDiscs::summed(const AliasRule& rule, double frequency) const {
  const double spacing = 2.0 * pi / period_;
  const std::complex<double> late = std::polar(1.0, -frequency * delay_);
  std::complex<double> shift = 0.0;
  double radius = 0.0;
  for (const AliasRule::Node& node : rule.nodes) {
    const double offset = node.number * spacing;
    const std::complex<double> above = disc_density(offset + frequency);
    shift += node.turning * above * late;
    radius += node.still * size_of(above);
    if (node.number == 0.0) continue;
    const std::complex<double> below = disc_density(offset - frequency);
    shift += std::conj(node.turning * below) * late;
    radius += node.still * size_of(below);
  }
  // (1 - e^{-jwT}) / T
  const std::complex<double> hold =
      2.0 * std::sin(0.5 * frequency * period_) / period_ * std::polar(1.0, 0.5 * (pi - frequency * period_));
  const std::complex<double> filters = filter_response(plant_, frequency * period_);
  const std::complex<double> centre = response(plant_, frequency) - filters * hold * shift;
  const double size = std::abs(filters * hold) * radius;
  return {centre, size, (std::abs(centre) - size) * (std::abs(centre) + size)};
}

AliasRule UserDiscs::rule_slope() const {
  return alias_rule_slope(exact_aliases_, steady_alias_, 2.0 * pi / period_ * delay_);
}

UserDiscs::Alias UserDiscs::alias(double frequency, int k, double direction) const {
  const double at_alias = frequency + k * (2.0 * pi / period_);
  const double positive = std::abs(at_alias);
  const std::complex<double> density = disc_density(positive);
  const std::complex<double> filters = filter_response(plant_, frequency * period_);
  const double hold = 2.0 * std::sin(0.5 * frequency * period_) / period_;
  const std::complex<double> through = response(positions_[sensed_], positive) *
                                       response(positions_[actuated_], positive) /
                                       std::complex<double>(1.0, lag_ * positive);
  // The term is -f q_s q_a/(Y + 1/Z), f = F (1 - e^{-jwT})/T e^{-jw_k t_d}; with Z = jX, towards the direction,
  //     q_s q_a/(Y + 1/Z) = g (1 - e^{j turn}),   1/(1 - e^{j turn}) = (1 + j cot(turn/2))/2,   q_s q_a/g = 2 Re Y.
  // At a negative frequency all of it is conjugate.
  const double factor_angle = std::arg(filters) + 0.5 * (pi - frequency * period_) - at_alias * delay_;
  const double turn = (at_alias < 0.0 ? factor_angle - direction : direction - factor_angle) - std::arg(density);
  const double conductance = std::abs(through) / (2.0 * std::abs(density));
  const double susceptance = positive * response(positions_[held_], positive).real();
  return {positive, std::abs(filters) * hold * std::abs(density),
          1.0 / (susceptance - conductance / std::tan(0.5 * turn))};
}

}  // namespace zwidth::internal
