#include "identification/period_choice.hpp"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "zwidth/error.hpp"

namespace zwidth::internal {
namespace {

constexpr double clear = 0.005;  // of the response that is left unexplained: a linear device explains it

/// The width of the interval, as a share of the critical stiffness.
double openness(const Identification& each) {
  const auto& interval = each.analysis.interval;
  if (each.trust.refused() || !interval || !(interval->lower > 0.0)) return std::numeric_limits<double>::infinity();
  return (interval->upper - interval->lower) / each.analysis.critical.stiffness;
}

bool is_better(const Identification& one, const Identification& other) {
  const bool both_explain = std::max(one.fit.model_error, other.fit.model_error) < clear;
  return both_explain ? openness(one) < openness(other) : one.fit.model_error < other.fit.model_error;
}

}  // namespace

Identification with_periods_chosen(
    const IdentifyOptions& options, const Progress& progress,
    const std::function<Identification(const IdentifyOptions&, const Progress&)>& identified) {
  IdentifyOptions windowed = options;
  windowed.response.excitation = FrequencyResponseOptions::Excitation::aperiodic;
  Identification found = [&] {
    try {
      return identified(options, progress);
    } catch (const Error&) {  // a period that is none, of a loop that rings, has too few lines
      return identified(windowed, {});
    }
  }();
  constexpr double open = 0.2;
  const bool is_open = openness(found) > open;
  if (found.fit.model_error < clear && !is_open) return found;
  const auto better = [&](const IdentifyOptions& chosen) -> std::optional<Identification> {
    constexpr double much = 0.5;
    try {
      Identification other = identified(chosen, {});
      const double error = found.fit.model_error;
      const bool explains_more = error >= clear && other.fit.model_error <= much * error;
      const bool knows_more =
          is_open && other.fit.model_error <= std::max(clear, error) && openness(other) <= much * openness(found);
      if (other.trust.refused() || !(explains_more || knows_more)) return std::nullopt;
      return other;
    } catch (const Error&) {  // then it is no better
      return std::nullopt;
    }
  };
  std::optional<Identification> later;
  std::optional<Identification> other;
  tbb::parallel_invoke(
      [&] {
        if (options.response.skip_periods != 0 || found.fit.model_error < clear) return;
        IdentifyOptions skipping = options;
        skipping.response.skip_periods = 1;
        later = better(skipping);
      },
      [&] { other = better(windowed); });
  if (later && !(other && is_better(*other, *later))) return *std::move(later);
  if (!other) return found;
  other->remarks.push_back(note({.code = FindingCode::periods_not_averaged}));
  return *std::move(other);
}

}  // namespace zwidth::internal
