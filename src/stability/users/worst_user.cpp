#include "zwidth/stability/worst_user.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <string>
#include <vector>

#include "stability/loop/damper_response.hpp"
#include "stability/second_route/pole_count.hpp"
#include "stability/users/termination_discs.hpp"
#include "staged_progress.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/state_space.hpp"
#include "zwidth/sampling/discrete_state_space.hpp"
#include "zwidth/stability/closed_loop.hpp"

namespace zwidth {
using namespace internal;
namespace {

using Alias = TerminationDiscs::Alias;
constexpr double low_angle = 3e-3;     // rad per sample; absolute_stability_limit() extrapolates to w = 0 from here
constexpr double lowest_angle = 1e-4;  // where a limit that falls towards w = 0 is followed to
constexpr double near_enough = 5e-5;   // of the limit: no more absorbers than that takes
// Of the limit: frequencies whose discs come so close are tried as well, the highest each.
constexpr double near_limit[] = {1e-5, 1e-3, 1e-2};
constexpr std::size_t few_absorbers[] = {0, 2, 4};
constexpr double step_up = 1.2;
constexpr int searched_aliases = 100;    // on either side
constexpr double most_mass_share = 4.0;  // of an absorber, see network()
constexpr double least_mass_share = 1e-5;
constexpr int max_sweeps = 100;
constexpr double settled = 1e-14;       // relative change of the absorbers' springs in a sweep
constexpr double well_settled = 1e-10;  // what rounding may make of it
constexpr double beyond = 1e-4;         // of the critical stiffness: there eigenvalues must show the loop unstable
constexpr std::size_t most_delay_samples = 100;  // for eigenvalues
constexpr int max_corrections = 4;
constexpr double real_enough = 1e-9;  // of 1/P + B v, relative: the loop's pole is on the circle at a real K

double reactance(const UserNetwork::Absorber& absorber, double frequency) {
  return frequency * absorber.mass * absorber.stiffness / (absorber.stiffness - frequency * frequency * absorber.mass);
}

/// Reactance of the network without one absorber (or with all, for an index past the end).
double reactance_without(const UserNetwork& user, std::size_t index, double frequency) {
  double sum = frequency * user.mass - user.stiffness / frequency;
  for (std::size_t i = 0; i < user.absorbers.size(); ++i) {
    if (i != index && user.absorbers[i].stiffness > 0.0) sum += reactance(user.absorbers[i], frequency);
  }
  return sum;
}

/// The network with those reactances, the first by a mass or spring to ground and each other by an absorber of a mass
/// in proportion to the reactance; heavier absorbers resonate less sharply. Solved in turn until all are met; nothing
/// where the absorbers disturb each other too much for that.
std::optional<UserNetwork> network(const std::vector<Alias>& aliases, double mass_share) {
  UserNetwork user;
  const Alias& base = aliases.front();
  std::vector<Alias> served(aliases.begin() + 1, aliases.end());
  for (const Alias& each : served) {
    user.absorbers.push_back({mass_share * std::abs(each.reactance) / each.frequency, 0.0});
  }
  // A mass would weigh on the aliases; half of it on a spring reacts alike at w and is a soft spring to them.
  const bool is_hung = base.reactance > 0.0 && !served.empty();
  if (is_hung) {
    served.insert(served.begin(), base);
    user.absorbers.insert(user.absorbers.begin(), {0.5 * base.reactance / base.frequency, 0.0});
  }
  double change = 1.0;
  for (int sweep = 0; sweep < max_sweeps && change > settled; ++sweep) {
    change = 0.0;
    if (!is_hung) {
      user.mass = user.stiffness = 0.0;
      const double at_base = base.reactance - reactance_without(user, user.absorbers.size(), base.frequency);
      if (at_base > 0.0) user.mass = at_base / base.frequency;
      if (at_base < 0.0) user.stiffness = -at_base * base.frequency;
    }
    for (std::size_t i = 0; i < user.absorbers.size(); ++i) {
      const double frequency = served[i].frequency;
      UserNetwork::Absorber& absorber = user.absorbers[i];
      // X = w m / (1 - w² m/k)
      const double own = served[i].reactance - reactance_without(user, i, frequency);
      const double rest = 1.0 - frequency * absorber.mass / own;
      if (!(rest > 0.0) || !std::isfinite(rest)) return std::nullopt;
      const double stiffness = frequency * frequency * absorber.mass / rest;
      change = std::max(change, std::abs(absorber.stiffness / stiffness - 1.0));
      absorber.stiffness = stiffness;
    }
  }
  if (change > well_settled) return std::nullopt;
  return user;
}

std::optional<UserNetwork> heaviest_network(const std::vector<Alias>& aliases) {
  if (aliases.size() == 1) return network(aliases, 0.0);
  for (double share = most_mass_share; share > least_mass_share; share *= 0.5) {
    if (auto user = network(aliases, share)) return user;
  }
  return std::nullopt;
}

class Search {
 public:
  Search(const Device& device, const TerminationDiscs& discs, const AbsoluteStabilityLimit& limit, VirtualDamper damper,
         double frequency, const Progress& progress)
      : device_(device),
        discs_(discs),
        virtual_damper_(damper),
        damper_(damper_response(damper, device.loop().sampling_period, frequency)),
        frequency_(frequency),
        is_nyquist_(frequency >= std::numbers::pi / device.loop().sampling_period),
        direction_(std::arg(-1.0 / (limit.stiffness + damper_) - discs.at(frequency).centre)),
        progress_(progress) {}

  /// The user that serves the base frequency and the `count` aliases of largest radius.
  [[nodiscard]] std::optional<WorstUser> with_absorbers(std::size_t count) {
    if (count > 0 && others_.empty()) find_others();
    if (count > others_.size()) return std::nullopt;
    std::vector<Alias> aliases(others_.begin(), others_.begin() + static_cast<std::ptrdiff_t>(count));
    std::sort(aliases.begin(), aliases.end(), [](const Alias& a, const Alias& b) { return a.frequency < b.frequency; });
    aliases.insert(aliases.begin(), Alias{});
    // The aliases left out move the plant off the real stiffnesses a little: the base frequency's term turns back.
    double turn = 0.0;
    for (int i = 0; i < max_corrections; ++i) {
      tell(progress_, 0.0);
      aliases.front() = discs_.alias(frequency_, 0, direction_ + turn);
      auto user = heaviest_network(aliases);
      if (!user) return std::nullopt;
      const Device held = held_by(device_, *user);
      const std::complex<double> plant = response(filtered_plant(held), frequency_);
      // 1 + (K + B v) P = 0
      const std::complex<double> critical = -1.0 / plant - damper_;
      if (std::abs(critical.imag()) <= real_enough * std::abs(critical) || is_nyquist_) {
        if (!(critical.real() > 0.0) || (count > 0 && !is_unstable(held, critical.real() * (1.0 + beyond)))) {
          return std::nullopt;
        }
        const PoleOnCircle pole = polished(held, {frequency_ * device_.loop().sampling_period, critical.real()});
        return WorstUser{*std::move(user), pole.stiffness, pole.angle / device_.loop().sampling_period};
      }
      const std::complex<double> slope =
          std::polar(aliases.front().radius, direction_ + turn) * std::complex<double>(0.0, 1.0) / (plant * plant);
      turn -= std::clamp(critical.imag() / slope.imag(), -0.5, 0.5);
    }
    return std::nullopt;
  }

 private:
  /// With a hundred digits: at low frequencies a heavy user's springs and masses cancel in the response, and K keeps six.
  [[nodiscard]] PoleOnCircle polished(const Device& held, PoleOnCircle found) const {
    if (is_nyquist_) return found;
    DeviceParameters parameters = held.parameters();
    parameters.wall.damping = virtual_damper_.damping;
    parameters.wall.velocity_filter_hz = virtual_damper_.velocity_filter_hz;
    const Device walled(std::move(parameters));
    std::vector<PoleOnCircle> poles{found};
    PoleCount(walled).polish_in_digits(poles);
    return poles.front();
  }

  /// By closed-loop eigenvalues. Absorbers may resonate so sharply that rounding hides what they do: those are no
  /// proof.
  [[nodiscard]] bool is_unstable(const Device& held, double stiffness) const {
    const Sampling sampling{held.loop().sampling_period, held.loop().delay};
    if (sampling.delay > static_cast<double>(most_delay_samples) * sampling.period) return false;
    Wall wall = held.parameters().wall;
    wall.stiffness = stiffness;
    wall.damping = virtual_damper_.damping;
    wall.velocity_filter_hz = virtual_damper_.velocity_filter_hz;
    return stability_excess(sample(state_space(held), sampling), wall) > 0.0;
  }

  void find_others() {
    for (int k = 1; k <= searched_aliases; ++k) {
      // At Nyquist k and -1 - k are one frequency.
      if (!is_nyquist_) others_.push_back(discs_.alias(frequency_, -k, direction_));
      others_.push_back(discs_.alias(frequency_, k, direction_));
    }
    std::sort(others_.begin(), others_.end(), [](const Alias& a, const Alias& b) { return a.radius > b.radius; });
  }

  const Device& device_;
  const TerminationDiscs& discs_;
  VirtualDamper virtual_damper_;
  std::complex<double> damper_;  // B v
  double frequency_;
  bool is_nyquist_;
  double direction_;
  const Progress& progress_;
  std::vector<Alias> others_;  // than the base frequency, by falling radius
};

/// Where to look for the worst user: where the limit was found, and where the disc reaches it or almost does. Aliases
/// matter less at low frequencies, but users for very low ones are extreme.
std::vector<double> frequencies_to_try(const Device& device, const TerminationDiscs& discs,
                                       const AbsoluteStabilityLimit& limit, VirtualDamper damper) {
  const double period = device.loop().sampling_period;
  const auto reaches = [&](double frequency, double off) {
    const TerminationDiscs::Disc disc = discs.at(frequency);
    const std::complex<double> controller = limit.stiffness * (1.0 + off) + damper_response(damper, period, frequency);
    return 1.0 + 2.0 * (controller * disc.centre).real() + std::norm(controller) * disc.power <= 0.0;
  };
  double lowest = low_angle / period;
  while (limit.frequency <= lowest && lowest * period > lowest_angle && !reaches(lowest, near_limit[0])) {
    lowest /= step_up;
  }
  std::vector<double> frequencies;
  if (limit.frequency <= lowest || reaches(lowest, near_limit[0])) frequencies.push_back(lowest);
  if (limit.frequency > lowest) frequencies.push_back(limit.frequency);
  double highest = frequencies.front();
  for (const double off : near_limit) {
    while (highest * step_up * period < std::numbers::pi && reaches(highest * step_up, off)) highest *= step_up;
    if (std::find(frequencies.begin(), frequencies.end(), highest) == frequencies.end()) frequencies.push_back(highest);
  }
  return frequencies;
}

/// The mass or spring that resonates with the device at a zero of Re Y or beside it, where it is hardly damped, of the
/// least critical stiffness above the limit; poles counted with a hundred digits must agree.
std::optional<WorstUser> tuned_user(const Device& device, const TerminationDiscs& discs,
                                    const AbsoluteStabilityLimit& limit, VirtualDamper damper) {
  constexpr double detunings[] = {0.0, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3};  // relative
  std::optional<WorstUser> worst;
  for (const SharpZero& zero : discs.zeros().sharp) {
    for (const double detuning : detunings) {
      for (const double side : {1.0, -1.0}) {
        const double frequency = zero.frequency * (1.0 + side * detuning);
        // Y + 1/(jX) = 0
        const double reactance = 1.0 / (frequency * response(discs.held_form(), frequency).real());
        if (!std::isfinite(reactance) || reactance == 0.0) continue;
        UserNetwork user;
        (reactance > 0.0 ? user.mass : user.stiffness) =
            reactance > 0.0 ? reactance / frequency : -reactance * frequency;
        DeviceParameters held = held_by(device, user).parameters();
        const CriticalStiffness critical = critical_stiffness(filtered_plant(Device(held)), damper);
        if (!critical.limit || !(critical.stiffness >= limit.stiffness)) continue;
        if (worst && critical.stiffness >= worst->critical_stiffness) continue;
        held.wall.damping = damper.damping;
        held.wall.velocity_filter_hz = damper.velocity_filter_hz;
        const Device walled(std::move(held));
        if (PoleCount(walled).in_digits(critical.stiffness * (1.0 + beyond)).value_or(0) <= 0) continue;
        worst = WorstUser{std::move(user), critical.stiffness, critical.limit->frequency};
      }
    }
  }
  return worst;
}

}  // namespace

Device held_by(const Device& device, const UserNetwork& user) {
  if (!device.has_bodies()) throw Error(ErrorCode::needs_bodies, {.code = ProblemCode::no_body_for_user});
  DeviceParameters parameters = device.parameters();
  parameters.uncertainty.reset();  // it may be of the user who is replaced
  parameters.user = {user.mass, 0.0, user.stiffness};
  const auto is_taken = [&](const std::string& name) {
    return std::any_of(parameters.bodies.begin(), parameters.bodies.end(),
                       [&](const Body& body) { return body.name == name; });
  };
  for (std::size_t i = 0; i < user.absorbers.size(); ++i) {
    std::string name = "user_" + std::to_string(i + 1);
    while (is_taken(name)) name += "_";
    parameters.links.push_back({parameters.loop.held, parameters.bodies.size(), user.absorbers[i].stiffness, 0.0});
    parameters.bodies.push_back({std::move(name), user.absorbers[i].mass, 0.0, 0.0, 0.0});
  }
  return Device(std::move(parameters));
}

std::optional<WorstUser> worst_user(const Device& device, const AbsoluteStabilityLimit& limit, VirtualDamper damper,
                                    const Progress& progress) {
  if (limit.stiffness == 0.0 || !std::isfinite(limit.stiffness)) return std::nullopt;
  if (limit.needs_no_user) return WorstUser{{}, limit.stiffness, limit.frequency};
  const TerminationDiscs discs(device, progress);
  std::vector<Search> searches;
  for (const double frequency : frequencies_to_try(device, discs, limit, damper)) {
    searches.emplace_back(device, discs, limit, damper, frequency, progress);
  }
  std::optional<WorstUser> worst;
  Search* best = nullptr;
  const auto try_absorbers = [&](Search& search, std::size_t count) {
    auto user = search.with_absorbers(count);
    if (!user || (worst && worst->critical_stiffness <= user->critical_stiffness)) return;
    worst = std::move(user);
    best = &search;
  };
  const auto is_reached = [&] { return worst && worst->critical_stiffness <= limit.stiffness * (1.0 + near_enough); };
  for (const std::size_t count : few_absorbers) {
    for (Search& search : searches) {
      if (!is_reached()) try_absorbers(search, count);
    }
  }
  if (best != nullptr && !is_reached()) try_absorbers(*best, most_absorbers);
  if (!is_reached()) {
    auto tuned = tuned_user(device, discs, limit, damper);
    if (tuned && !(worst && worst->critical_stiffness <= tuned->critical_stiffness)) worst = std::move(tuned);
  }
  tell(progress, 1.0);
  return worst;
}

}  // namespace zwidth
