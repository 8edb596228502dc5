#include "identification/initial_fit/initial_values.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <utility>

#include "identification/initial_fit/link_mode.hpp"
#include "model/loop_keys.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/parameter.hpp"

namespace zwidth::internal {
namespace {

constexpr std::size_t most_candidates = 1200;
constexpr std::size_t most_starts = 5;

/// One thing that a candidate chooses, with the choices.
using Choices = std::vector<double>;

/// The free parameters by what they are, and the choices for each kind.
class Candidates {
 public:
  Candidates(const FitModel& model, const std::vector<ResponsePoint>& points, const ResponseFeatures& features)
      : model_(model), features_(features) {
    lowest_ = points.front().frequency;
    highest_ = points.back().frequency;
    const Device& structure = model.structure();
    is_locked_.assign(structure.bodies().size(), false);
    for (const std::size_t body : model.locked()) is_locked_[body] = true;
    for (const Coordinate& coordinate : model.coordinates()) {
      is_free_.push_back(coordinate.key);
    }
    add_mass_choices();
    add_link_choices();
    add_delay_choices();
  }

  /// Number of combinations of all choices; huge ones are only sampled.
  [[nodiscard]] double count() const {
    double product = 1.0;
    for (const Choices& choices : choices_) product *= static_cast<double>(choices.size());
    return product;
  }

  [[nodiscard]] std::vector<std::size_t> combination(std::size_t number) const {
    std::vector<std::size_t> picked;
    for (const Choices& choices : choices_) {
      picked.push_back(number % choices.size());
      number /= choices.size();
    }
    return picked;
  }

  [[nodiscard]] std::vector<std::size_t> random_combination(std::mt19937_64& random) const {
    std::vector<std::size_t> picked;
    for (const Choices& choices : choices_) picked.push_back(random() % choices.size());
    return picked;
  }

  /// Of a combination, where it puts each link's resonance, and whether the bodies are alike.
  [[nodiscard]] std::vector<std::size_t> kind_of(const std::vector<std::size_t>& picked) const {
    std::vector<std::size_t> kind;
    for (const Chosen& each : link_choices_) kind.push_back(picked[each.choice]);
    const auto is_even = [&](std::size_t choice) { return choices_[choice][picked[choice]] == 1.0; };
    kind.push_back(std::ranges::all_of(share_choices_, is_even) ? 1 : 0);
    return kind;
  }

  /// The structure with the free parameters as the combination says.
  [[nodiscard]] DeviceParameters parameters(const std::vector<std::size_t>& picked) const {
    DeviceParameters device = model_.structure().parameters();
    set_masses(device, picked);
    set_springs(device, picked);
    set_dampings(device);
    const double total = choices_[delay_choice_][picked[delay_choice_]];
    if (is_free(key_of_delay) && is_free(key_of_lag)) {
      const double share = choices_[split_choice_][picked[split_choice_]];
      device.loop.delay = share * total;
      device.actuator.time_constant = (1.0 - share) * total;
    } else if (is_free(key_of_delay)) {
      device.loop.delay = total;
    } else if (is_free(key_of_lag)) {
      device.actuator.time_constant = total;
    }
    return device;
  }

 private:
  [[nodiscard]] bool is_free(const std::string& key) const { return std::ranges::count(is_free_, key) > 0; }
  [[nodiscard]] bool moves(std::size_t body) const { return !is_locked_[body]; }

  [[nodiscard]] std::string body_key(std::size_t body, const char* member) const {
    return "body." + model_.structure().bodies()[body].name + "." + member;
  }

  void add_mass_choices() {
    const std::size_t actuated = model_.structure().loop().actuated;
    std::vector<std::size_t> free;
    for (std::size_t i = 0; i < is_locked_.size(); ++i) {
      if (is_free(body_key(i, "mass")) && moves(i)) free.push_back(i);
    }
    free_masses_ = free;
    if (free.empty()) return;
    // The scale of the masses.
    Choices scales = {features_.inertia_below, features_.inertia_above};
    for (const double resonance : features_.has_all_modes ? std::vector<double>{} : features_.resonances) {
      scales.push_back(features_.stiffness_below / (resonance * resonance));
    }
    scale_choice_ = choices_.size();
    choices_.push_back(std::move(scales));
    // How they share it: each body's part before all are made to add up to 1; the actuated body's may follow from the
    // line at high frequencies.
    const double seen_above = features_.inertia_above / std::max(features_.inertia_below, features_.inertia_above);
    for (const std::size_t body : free) {
      share_choices_.push_back(choices_.size());
      Choices shares = {0.15, 1.0, 6.0};
      if (free.size() == 1) shares = {1.0};
      if (body == actuated && free.size() > 1) {
        shares.push_back(std::clamp(seen_above, 0.01, 0.99) * static_cast<double>(free.size()));
      }
      choices_.push_back(std::move(shares));
    }
  }

  [[nodiscard]] Choices frequencies() const {
    if (features_.has_all_modes) {
      Choices near;
      for (const double mode : features_.resonances) {
        for (const double factor : {1.0, 1.4, 0.7}) near.push_back(factor * mode);  // bodies beyond a link shift it
      }
      return near;
    }
    Choices frequencies = features_.resonances;
    frequencies.insert(frequencies.end(), features_.antiresonances.begin(), features_.antiresonances.end());
    // Far above the band bodies move as one there, but for a spring's share.
    for (const double above : {4.0, 12.0}) frequencies.push_back(above * highest_);
    // Where little stands out the modes may be anywhere, outside the measured band too.
    const std::size_t wanted = frequencies.size() < 2 ? 6 : 3;
    for (std::size_t i = 0; i < wanted; ++i) {
      const double part = static_cast<double>(i) / static_cast<double>(wanted - 1);
      frequencies.push_back(1.5 * highest_ * std::pow(lowest_ / (1.5 * highest_), part));
    }
    return frequencies;
  }

  void add_link_choices() {
    for (std::size_t i = 0; i < model_.structure().links().size(); ++i) {
      if (!is_free("link." + std::to_string(i) + ".stiffness")) continue;
      link_choices_.push_back({i, choices_.size()});
      choices_.push_back(frequencies());
    }
    for (std::size_t i = 0; i < is_locked_.size(); ++i) {
      if (!is_free(body_key(i, "stiffness")) || !moves(i)) continue;
      ground_choices_.push_back({i, choices_.size()});
      choices_.push_back({0.0, features_.stiffness_below, 0.1 * features_.stiffness_below});
    }
  }

  void add_delay_choices() {
    delay_choice_ = choices_.size();
    double known = model_.sampling_period().value_or(0.0) / 2.0;
    const DeviceParameters& structure = model_.structure().parameters();
    if (!is_free(key_of_delay)) known += structure.loop.delay;
    if (!is_free(key_of_lag)) known += structure.actuator.time_constant;
    const bool any = is_free(key_of_delay) || is_free(key_of_lag);
    choices_.push_back(any ? Choices{std::max(0.0, features_.delay - known), 0.0} : Choices{0.0});
    split_choice_ = choices_.size();
    const bool both = is_free(key_of_delay) && is_free(key_of_lag);
    choices_.push_back(both ? Choices{0.1, 0.5, 0.9} : Choices{1.0});
  }

  void set_masses(DeviceParameters& device, const std::vector<std::size_t>& picked) const {
    double sum = 0.0;
    for (const std::size_t choice : share_choices_) sum += choices_[choice][picked[choice]];
    for (std::size_t i = 0; i < free_masses_.size(); ++i) {
      const double share = choices_[share_choices_[i]][picked[share_choices_[i]]] / sum;
      device.bodies[free_masses_[i]].mass = share * choices_[scale_choice_][picked[scale_choice_]];
    }
  }

  [[nodiscard]] double moving_mass(const DeviceParameters& device, const Link& link) const {
    if (!moves(link.first)) return device.bodies[link.second].mass;
    if (!moves(link.second)) return device.bodies[link.first].mass;
    return reduced_mass(device, link);
  }

  void set_springs(DeviceParameters& device, const std::vector<std::size_t>& picked) const {
    for (const auto& [index, choice] : link_choices_) {
      Link& link = device.links[index];
      const double frequency = choices_[choice][picked[choice]];
      link.stiffness = frequency * frequency * moving_mass(device, link);
    }
    for (const auto& [index, choice] : ground_choices_) {
      device.bodies[index].stiffness = choices_[choice][picked[choice]];
    }
  }

  void set_dampings(DeviceParameters& device) const {
    for (std::size_t i = 0; i < device.links.size(); ++i) {
      if (!is_free("link." + std::to_string(i) + ".damping")) continue;
      Link& link = device.links[i];
      link.damping = 2.0 * typical_damping_ratio * std::sqrt(link.stiffness * moving_mass(device, link));
    }
    for (std::size_t i = 0; i < device.bodies.size(); ++i) {
      if (!is_free(body_key(i, "damping")) || !moves(i)) continue;
      device.bodies[i].damping = typical_damping_ratio * lowest_ * device.bodies[i].mass;
    }
  }

  struct Chosen {
    std::size_t index = 0;   ///< of the link or body
    std::size_t choice = 0;  ///< which of choices_
  };

  const FitModel& model_;
  const ResponseFeatures& features_;
  double lowest_ = 0.0;
  double highest_ = 0.0;
  std::vector<bool> is_locked_;
  std::vector<std::string> is_free_;
  std::vector<Choices> choices_;
  std::vector<std::size_t> free_masses_;
  std::vector<std::size_t> share_choices_;
  std::size_t scale_choice_ = 0;
  std::vector<Chosen> link_choices_;
  std::vector<Chosen> ground_choices_;
  std::size_t delay_choice_ = 0;
  std::size_t split_choice_ = 0;
};

/// Mean of the logarithmic misfit, each point's share bounded so that one missed resonance does not decide.
double logarithmic_misfit(const FitModel& model, const Eigen::VectorXd& x, const std::vector<ResponsePoint>& points,
                          const std::vector<double>& frequencies) {
  const Eigen::VectorXcd values = model.response_at(x, frequencies);
  double sum = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    sum += std::log1p(std::norm(std::log(values(static_cast<Eigen::Index>(i)) / points[i].value)) / 0.25);
  }
  return std::isfinite(sum) ? sum : std::numeric_limits<double>::infinity();
}

struct Judged {
  double misfit = 0.0;
  Eigen::VectorXd x;
  std::vector<std::size_t> kind;  ///< see Candidates::kind_of()
};

/// The structure's own position and all candidates, or a sample of them, the best first.
std::vector<Judged> judged_candidates(const FitModel& model, const std::vector<ResponsePoint>& points,
                                      const ResponseFeatures& features) {
  const Candidates candidates(model, points, features);
  std::vector<double> frequencies(points.size());
  std::ranges::transform(points, frequencies.begin(), &ResponsePoint::frequency);
  std::vector<Judged> judged;
  const auto judge_position = [&](const Eigen::VectorXd& x, std::vector<std::size_t> kind) {
    try {
      judged.push_back({logarithmic_misfit(model, x, points, frequencies), x, std::move(kind)});
    } catch (const Error&) {  // a candidate whose poles are not found is no candidate
    }
  };
  const auto judge = [&](const std::vector<std::size_t>& picked) {
    judge_position(model.position_of(candidates.parameters(picked)), candidates.kind_of(picked));
  };
  judge_position(model.position_of(model.structure().parameters()), {});
  if (candidates.count() <= static_cast<double>(most_candidates)) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(candidates.count()); ++i) judge(candidates.combination(i));
  } else {
    std::mt19937_64 random(1);
    for (std::size_t i = 0; i < most_candidates; ++i) judge(candidates.random_combination(random));
  }
  std::ranges::stable_sort(judged, {}, &Judged::misfit);
  return judged;
}

}  // namespace

std::vector<Eigen::VectorXd> initial_positions(const FitModel& model, const std::vector<ResponsePoint>& points,
                                               const ResponseFeatures& features) {
  std::vector<Eigen::VectorXd> starts;
  constexpr double apart = 0.1;
  for (const Judged& each : judged_candidates(model, points, features)) {
    const bool is_new = std::ranges::none_of(
        starts, [&](const Eigen::VectorXd& other) { return (each.x - other).lpNorm<Eigen::Infinity>() < apart; });
    if (is_new) starts.push_back(each.x);
    if (starts.size() == most_starts) break;
  }
  if (starts.empty()) starts.push_back(model.position_of(model.structure().parameters()));
  return starts;
}

std::vector<Eigen::VectorXd> different_positions(const FitModel& model, const std::vector<ResponsePoint>& points,
                                                 const ResponseFeatures& features, std::size_t most) {
  std::vector<Eigen::VectorXd> starts;
  std::set<std::vector<std::size_t>> seen;
  for (const Judged& each : judged_candidates(model, points, features)) {
    if (starts.size() == most) break;
    if (seen.insert(each.kind).second) starts.push_back(each.x);
  }
  return starts;
}

}  // namespace zwidth::internal
