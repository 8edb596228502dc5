#include "zwidth/study/region_contours.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "counted.hpp"
#include "staged_progress.hpp"
#include "study/study_parts.hpp"
#include "zwidth/design/region.hpp"
#include "zwidth/model/device_trust.hpp"
#include "zwidth/model/parameter.hpp"
#include "zwidth/require_valid.hpp"
#include "zwidth/study/sample_statistics.hpp"

namespace zwidth {
using namespace internal;
namespace {

/// Of a contour: the share of the units that reach it, and that of those that may not.
struct Share {
  double reaching;
  double below;
};
constexpr Share shares[] = {{0.99, 0.01}, {0.5, 0.5}, {0.01, 0.99}};
constexpr std::size_t steps = region_grid_points - 1;
constexpr double widening = 1.25;        // of the search for the grid's end
constexpr int most_widenings = 40;       // a factor of 7500 to either side
constexpr double share_of_search = 0.2;  // of the progress

/// The limits of all units at one damping after another.
class Units {
 public:
  Units(const StudyRun& run, std::uint64_t units)
      : run_(run), columns_(run.columns(0, static_cast<std::size_t>(units))) {
    columns_.push_back({"wall.damping", std::vector<double>(static_cast<std::size_t>(units))});
  }

  /// Rising K_CR.
  [[nodiscard]] const std::vector<double>& limits(double damping, const Progress& progress) {
    std::ranges::fill(columns_.back().values, damping);
    BatchStiffness answers = run_.answers(columns_, false, progress);
    for (std::size_t i = 0; i < answers.size(); ++i) {
      if (!std::isnan(answers.stiffness[i])) continue;
      if (first_reason_.empty()) first_reason_ = reason_of(answers, i);
      ++without_;
      answers.stiffness[i] = 0.0;
    }
    if (answers.trust.sound()) doubtful_ += std::ranges::count(answers.verdict, Trust::Verdict::doubtful);
    asked_ += answers.size();
    limits_ = std::move(answers.stiffness);
    std::ranges::sort(limits_);
    return limits_;
  }

  void judge(Trust& trust) const {
    if (without_ > 0) {
      trust.doubt({.code = FindingCode::walls_without_answer,
                   .evidence = {{"without", static_cast<double>(without_)}, {"asked", static_cast<double>(asked_)}},
                   .subjects = {{"reason", first_reason_}}});
    }
    if (doubtful_ > 0) {
      trust.doubt({.code = FindingCode::wall_limits_doubtful,
                   .evidence = {{"doubtful", static_cast<double>(doubtful_)}, {"asked", static_cast<double>(asked_)}}});
    }
  }

 private:
  const StudyRun& run_;
  std::vector<ParameterValues> columns_;
  std::vector<double> limits_;
  std::uint64_t asked_ = 0;
  std::uint64_t without_ = 0;
  std::ptrdiff_t doubtful_ = 0;
  std::string first_reason_;
};

/// From 1: the unit that a share of all reach or exceed.
std::uint64_t rank_of(const Share& share, std::uint64_t units) {
  return static_cast<std::uint64_t>(std::ceil(share.below * static_cast<double>(units)));
}

/// The least of B0 1.25^k at which the last contour has ended.
double end_of(Units& units, std::uint64_t rank, double start, const Progress& progress) {
  StagedProgress stages(progress);
  double left = 1.0;
  const auto has_ended = [&](double damping) {
    left *= 0.8;
    stages.next(1.0 - left);
    return units.limits(damping, stages.stage())[static_cast<std::size_t>(rank - 1)] == 0.0;
  };
  double end = start;
  int widenings = 0;
  if (has_ended(end)) {
    while (widenings++ < most_widenings && has_ended(end / widening)) end /= widening;
  } else {
    do end *= widening;
    while (widenings++ < most_widenings && !has_ended(end));
  }
  stages.done();
  return end;
}

void add_point(const std::vector<double>& limits, const Share& share, RegionContour& contour) {
  const auto units = static_cast<std::uint64_t>(limits.size());
  const auto at = [&](std::uint64_t rank) { return limits[static_cast<std::size_t>(rank - 1)]; };
  const QuantileRanks between = quantile_ranks(share.below, units);  // both, from least_region_units on
  contour.stiffness.push_back(at(rank_of(share, units)));
  contour.lower.push_back(at(between.lower.value_or(1)));
  contour.upper.push_back(at(between.upper.value_or(units)));
}

}  // namespace

std::optional<OptionProblem> internal::find_region_problem(std::uint64_t units, std::uint64_t samples,
                                                           const Device& device,
                                                           const StudyDistributions& distributions) {
  if (units < least_region_units || units > most_region_units || units > samples) {
    return option_problem("region_units",
                          {.code = ProblemCode::count_out_of_range_or_zero,
                           .evidence = {counted("value", units), counted("least", least_region_units),
                                        counted("most", most_region_units), counted("samples", samples)}});
  }
  for (const StudyParameter& each : distributions.parameters) {
    if (full_parameter_key(device.parameters(), each.key) == "wall.damping") {
      return option_problem("region_units", {.code = ProblemCode::damping_varies});
    }
  }
  return std::nullopt;
}

RegionContours region_contours(const StudyRun& run, std::uint64_t units, const Progress& progress) {
  require_valid(find_region_problem(units, run.options().samples, run.device(), run.distributions()));
  RegionContours result;
  result.units = units;
  const WallRegion paper = region(run.device(), {.any_user = false, .approximations = false});
  result.trust = trust_of(run.device());
  if (paper.status != WallRegion::Status::bounded || !(paper.region.most_damped->damping > 0.0)) {
    result.trust.inherit(paper.trust);
    if (!result.trust.refused()) {
      result.trust.refuse({.code = FindingCode::no_scale_of_dampings});
    }
    return result;
  }
  StagedProgress stages(progress);
  stages.next(share_of_search);
  Units all(run, units);
  const double end =
      end_of(all, rank_of(shares[std::size(shares) - 1], units), paper.region.most_damped->damping, stages.stage());
  result.damping_step = end / static_cast<double>(steps);
  for (const Share& share : shares) result.contours.push_back({share.reaching, {}, {}, {}});
  for (std::size_t i = 0; i <= steps; ++i) {
    stages.next(share_of_search +
                (1.0 - share_of_search) * static_cast<double>(i + 1) / static_cast<double>(steps + 1));
    result.dampings.push_back(i == steps ? end : result.damping_step * static_cast<double>(i));
    const std::vector<double>& limits = all.limits(result.dampings.back(), stages.stage());
    for (std::size_t k = 0; k < std::size(shares); ++k) add_point(limits, shares[k], result.contours[k]);
  }
  all.judge(result.trust);
  if (const RegionContour& last = result.contours.back(); last.stiffness.back() > 0.0) {
    result.trust.doubt({.code = FindingCode::contours_go_on, .evidence = {{"damping", end}}});
  }
  stages.done();
  return result;
}

}  // namespace zwidth
