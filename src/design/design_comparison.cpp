#include "zwidth/design/design_comparison.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "zwidth/error.hpp"
#include "zwidth/stability/analysis.hpp"

namespace zwidth {
namespace {

constexpr double as_good = 1e-3;  // relative difference that is none

bool is_present(const Operator& user) { return user.mass > 0.0 || user.damping > 0.0 || user.stiffness > 0.0; }

Device with_user(const Device& device, const Operator& user) {
  DeviceParameters parameters = device.parameters();
  parameters.user = user;
  return Device(std::move(parameters));
}

ComparedDesign judged(const DesignVariant& variant, const Operator& user, Trust& trust) {
  const Device free = with_user(variant.device, {});
  Analysis analysis = analyze(free, {.any_user = true, .draws = 0});
  trust.inherit(analysis.trust);
  ComparedDesign design{variant.value, free, std::move(analysis.critical), std::move(analysis.any_user), std::nullopt};
  if (is_present(user)) {
    design.held = critical_stiffness(with_user(variant.device, user));
    trust.inherit(design.held->trust);
  }
  return design;
}

// The two stiffest of those that have a number.
template <typename Stiffness>
std::optional<BestDesigns> best_of(const std::vector<ComparedDesign>& designs, const Stiffness& stiffness_of) {
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < designs.size(); ++i) {
    if (const std::optional<double> stiffness = stiffness_of(designs[i])) order.emplace_back(*stiffness, i);
  }
  if (order.size() < 2) return std::nullopt;
  std::ranges::stable_sort(order, [](const auto& a, const auto& b) { return a.first > b.first; });
  const auto [best, first] = order[0];
  const auto [next, second] = order[1];
  return BestDesigns{first, second, best == next || std::abs(best - next) <= as_good * next};
}

std::optional<double> stiffness_of(const CriticalStiffness& critical) {
  return critical.trust.refused() ? std::nullopt : std::optional(critical.stiffness);
}

}  // namespace

DesignComparison compare_designs(std::string key, const std::vector<DesignVariant>& variants, const Operator& user) {
  if (variants.empty()) throw Error(ErrorCode::invalid_argument, "there is no design to compare");
  DesignComparison comparison{std::move(key), user, {}, {}, {}, {}, {}};
  for (const DesignVariant& variant : variants) {
    comparison.designs.push_back(judged(variant, user, comparison.trust));
  }
  comparison.best_free = best_of(comparison.designs, [](const auto& each) { return stiffness_of(each.free); });
  comparison.best_any_user = best_of(comparison.designs, [](const auto& each) {
    return each.any_user ? std::optional(each.any_user->stiffness) : std::nullopt;
  });
  comparison.best_held =
      best_of(comparison.designs, [](const auto& each) { return each.held ? stiffness_of(*each.held) : std::nullopt; });
  return comparison;
}

}  // namespace zwidth
