#include "zwidth/design/design_comparison.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "staged_progress.hpp"
#include "zwidth/model/device_user.hpp"
#include "zwidth/require_valid.hpp"
#include "zwidth/stability/analysis.hpp"

namespace zwidth {
using namespace internal;
namespace {

constexpr double as_good = 1e-3;  // relative difference that is none

bool is_present(const User& user) { return user.mass > 0.0 || user.damping > 0.0 || user.stiffness > 0.0; }

ComparedDesign judged(const DeviceVariant& variant, const User& user, Trust& trust) {
  const Device free = device_without_user(variant.device);
  Analysis analysis = analyze(free, {.any_user = true, .draws = 0});
  trust.inherit(analysis.trust);
  ComparedDesign design{variant.value, free,           std::move(analysis.critical), std::move(analysis.any_user),
                        std::nullopt,  analysis.limits};
  if (is_present(user)) {
    Analysis held = analyze(device_with_user(variant.device, user), {.any_user = false, .draws = 0});
    design.held = std::move(held.critical);
    design.limits.user = held.limits.user;
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
  const bool has_all = order.size() == designs.size();
  return BestDesigns{first, second, best == next || std::abs(best - next) <= as_good * next, has_all && best > 0.0};
}

std::optional<double> stiffness_of(const CriticalStiffness& critical) {
  return critical.trust.refused() ? std::nullopt : std::optional(critical.stiffness);
}

}  // namespace

std::optional<OptionProblem> find_problem(const DeviceVariants& variants, const std::optional<User>& user) {
  if (variants.variants.empty()) return option_problem("variants", {.code = ProblemCode::no_values});
  if (!user) return std::nullopt;
  for (const DeviceVariant& each : variants.variants) {
    if (!each.device.has_bodies() && is_present(*user)) {
      return option_problem("user", {.code = ProblemCode::asked_of_transfer_function});
    }
    DeviceParameters held = each.device.parameters();
    held.user = *user;
    if (const auto problem = find_problem(held)) {
      return option_problem(
          "user", {.code = ProblemCode::of_the_device,
                   .evidence = {{"colon", 1.0}},
                   .subjects = {{"key", problem->key}, {"what", problem->what}, {"allowed", problem->allowed}}});
    }
  }
  return std::nullopt;
}

DesignComparison compare_designs(const DeviceVariants& variants, const std::optional<User>& user,
                                 const Progress& progress) {
  require_valid(find_problem(variants, user));
  const std::vector<DeviceVariant>& all = variants.variants;
  DesignComparison comparison{variants.key, user.value_or(all.front().device.parameters().user), {}, {}, {}, {}, {}};
  for (const DeviceVariant& variant : all) {
    comparison.designs.push_back(judged(variant, comparison.user, comparison.trust));
    internal::tell(progress, static_cast<double>(comparison.designs.size()) / static_cast<double>(all.size()));
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
