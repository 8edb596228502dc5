#include "zwidth/study/rare_failures.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "study/philox.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/device_trust.hpp"
#include "zwidth/study/sample_statistics.hpp"
#include "zwidth/study/study_run.hpp"

namespace zwidth {
using namespace internal;
namespace {

constexpr std::uint64_t least_samples = 100;
constexpr std::uint64_t most_samples = std::uint64_t{1} << 24U;
constexpr std::uint32_t explore_stream = 0x40000;
constexpr std::uint32_t draw_stream = 0x50000;
constexpr std::uint32_t choice_stream = 0x60000;
constexpr std::size_t explored = 2048;  // units of each spread
constexpr double spreads[] = {1.0, 2.0, 3.0};
constexpr std::size_t most_points = 8;
constexpr std::size_t starts = 12;
constexpr int most_iterations = 25;
constexpr double farthest = 8.0;      // standard deviations: beyond, nothing is drawn
constexpr double apart = 1.0;         // two design points
constexpr double much_farther = 2.5;  // than the nearest: its failures do not count
constexpr double on_border = 1e-3;    // relative to the specified stiffness
constexpr double difference = 1e-4;   // of a score, for the slope
constexpr double defensive = 0.1;     // share of the units that are drawn as they are
constexpr double normal_95 = 1.959963984540054;

using Points = std::vector<Eigen::VectorXd>;

/// Of many points.
struct Margins {
  std::vector<double> above;       ///< how far the answers are above what is specified, relative; below 0 a failure
  std::size_t without_answer = 0;  ///< of those that fail
  std::size_t doubtful = 0;        ///< with an answer that is
};

class RareSearch {
 public:
  RareSearch(const StudyRun& run, const Progress& progress)
      : run_(run), progress_(progress), size_(static_cast<Eigen::Index>(run.inputs().size())) {}

  [[nodiscard]] Margins margins(const Points& points) {
    std::vector<ParameterValues> columns;
    for (const StudyParameter& each : run_.distributions().parameters) columns.push_back({each.key, {}});
    std::vector<double> row(columns.size());
    for (const Eigen::VectorXd& point : points) {
      std::copy(point.begin(), point.end(), row.begin());
      run_.inputs().from_normal(row);
      for (std::size_t j = 0; j < row.size(); ++j) columns[j].values.push_back(row[j]);
    }
    const Specification& wanted = run_.options().specification;
    const BatchStiffness answers = run_.answers(columns, wanted.any_user.has_value(), progress_);
    evaluations_ += points.size();
    Margins margins{std::vector<double>(points.size())};
    for (std::size_t i = 0; i < points.size(); ++i) {
      double margin = std::numeric_limits<double>::max();
      if (wanted.critical_stiffness) margin = std::min(margin, answers.stiffness[i] / *wanted.critical_stiffness - 1.0);
      if (wanted.any_user) margin = std::min(margin, answers.any_user[i] / *wanted.any_user - 1.0);
      const bool has_answer =
          !std::isnan(answers.stiffness[i]) && (!wanted.any_user || !std::isnan(answers.any_user[i]));
      margins.above[i] = run_.meets(answers, i) ? margin : has_answer ? std::min(margin, -1e-15) : -1.0;
      margins.without_answer += has_answer ? 0U : 1U;
      margins.doubtful += has_answer && answers.verdict[i] != answers.trust.verdict ? 1U : 0U;
    }
    return margins;
  }

  [[nodiscard]] Eigen::VectorXd drawn(std::uint32_t stream, std::uint64_t i) const {
    Eigen::VectorXd point(size_);
    for (Eigen::Index j = 0; j < size_; ++j) {
      const std::uint64_t bits = random_bits(run_.options().seed, stream + static_cast<std::uint32_t>(j), i);
      point(j) = standard_normal_score(uniform_of(bits));
    }
    return point;
  }

  /// Failures, nearest first, of units with more spread than there is; the least margins where none fails.
  [[nodiscard]] Points first_places() {
    Points places;
    for (const double spread : spreads) {
      for (std::size_t i = 0; i < explored; ++i) places.push_back(spread * drawn(explore_stream, places.size()));
    }
    const std::vector<double> above = margins(places).above;
    failing_ = static_cast<std::uint64_t>(
        std::count_if(above.begin(), above.begin() + explored, [](double margin) { return margin < 0.0; }));
    std::vector<std::size_t> order(places.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::ranges::stable_sort(order, {}, [&](std::size_t i) {
      return above[i] < 0.0 ? std::pair(0.0, places[i].norm()) : std::pair(1.0, above[i]);
    });
    Points chosen{Eigen::VectorXd::Zero(size_)};
    for (const std::size_t i : order) {
      const bool is_new =
          std::ranges::all_of(chosen, [&](const auto& each) { return (each - places[i]).norm() > apart; });
      if (is_new) chosen.push_back(places[i]);
      if (chosen.size() == starts) break;
    }
    return chosen;
  }

  /// The nearest place of the border; nothing where the iteration does not come to it.
  [[nodiscard]] std::optional<Eigen::VectorXd> border_from(Eigen::VectorXd at) {
    for (int iteration = 0; iteration < most_iterations; ++iteration) {
      Points around{at};
      for (Eigen::Index j = 0; j < size_; ++j) {
        for (const double side : {-difference, difference}) {
          around.push_back(at);
          around.back()(j) += side;
        }
      }
      const std::vector<double> above = margins(around).above;
      Eigen::VectorXd slope(size_);
      for (Eigen::Index j = 0; j < size_; ++j) {
        const auto low = static_cast<std::size_t>(1 + 2 * j);
        slope(j) = (above[low + 1] - above[low]) / (2.0 * difference);
      }
      const double steepness = slope.squaredNorm();
      if (!std::isfinite(steepness) || !(steepness > 0.0)) return std::nullopt;
      Eigen::VectorXd next = (slope.dot(at) - above[0]) / steepness * slope;
      if (next.norm() > farthest) next *= farthest / next.norm();
      const bool has_come = std::abs(above[0]) < on_border && (next - at).norm() < 0.1;
      at = std::move(next);
      if (has_come) return at;
    }
    return std::nullopt;
  }

  [[nodiscard]] std::uint64_t evaluations() const { return evaluations_; }
  /// Share of the units as they are that fail, as far as the first look tells.
  [[nodiscard]] Proportion first_share() const { return proportion(failing_, explored); }

 private:
  const StudyRun& run_;
  const Progress& progress_;
  Eigen::Index size_;
  std::uint64_t failing_ = 0;
  std::uint64_t evaluations_ = 0;
};

/// Distinct borders, nearest first; where an iteration lost itself, the failure from which it began.
Points design_points(RareSearch& search) {
  Points found;
  const Points places = search.first_places();
  const std::vector<double> above = search.margins(places).above;
  for (std::size_t i = 0; i < places.size(); ++i) {
    auto border = search.border_from(places[i]);
    if (!border && above[i] < 0.0) border = places[i];
    if (border && border->norm() < farthest) found.push_back(*std::move(border));
  }
  std::ranges::stable_sort(found, {}, [](const Eigen::VectorXd& each) { return each.norm(); });
  Points distinct;
  for (const Eigen::VectorXd& each : found) {
    const bool is_new = std::ranges::all_of(distinct, [&](const auto& other) { return (other - each).norm() > apart; });
    if (is_new && each.norm() < found.front().norm() + much_farther && distinct.size() < most_points) {
      distinct.push_back(each);
    }
  }
  return distinct;
}

void require(const StudyRun& run, const RareFailureOptions& options) {
  const Specification& wanted = run.options().specification;
  if (!wanted.critical_stiffness && !wanted.any_user) {
    throw Error(ErrorCode::invalid_argument, "specification: is missing; rare failures need one");
  }
  if (options.samples < least_samples || options.samples > most_samples) {
    throw Error(ErrorCode::invalid_argument,
                fmt::format("samples is {}; must be {} to {}", options.samples, least_samples, most_samples));
  }
}

}  // namespace

RareFailures rare_failures(const StudyRun& run, const RareFailureOptions& options, const Progress& progress) {
  require(run, options);
  RareFailures result;
  result.trust = trust_of(run.device());
  if (result.trust.refused()) return result;
  RareSearch search(run, progress);
  const Points points = design_points(search);
  if (points.empty()) {
    result.evaluations = search.evaluations();
    result.trust.doubt(fmt::format(
        "no failure to sample around was found within {:g} standard deviations: only the interval is known", farthest));
    const Proportion known = search.first_share();
    result.share = known.value, result.lower = known.lower, result.upper = known.upper;
    result.error = std::sqrt(known.value * (1.0 - known.value) / explored);
    return result;
  }
  std::vector<double> weights;  // of the points: half by what lies beyond them, half the same for each
  double sum = 0.0;
  for (const Eigen::VectorXd& each : points) {
    result.points.push_back({{each.begin(), each.end()}, each.norm()});
    weights.push_back(standard_normal_probability(-each.norm()));
    sum += weights.back();
  }
  for (double& weight : weights) weight = 0.5 * weight / sum + 0.5 / static_cast<double>(points.size());
  Points units;
  std::vector<double> ratios;  // phi(y) / q(y)
  for (std::uint64_t i = 0; i < options.samples; ++i) {
    Eigen::VectorXd unit = search.drawn(draw_stream, i);
    double choice = uniform_of(random_bits(run.options().seed, choice_stream, i));
    if (choice >= defensive) {
      choice = (choice - defensive) / (1.0 - defensive);
      std::size_t k = 0;
      while (k + 1 < points.size() && choice >= weights[k]) choice -= weights[k++];
      unit += points[k];
    }
    double density = defensive;  // relative to phi: exp(y y_k - |y_k|²/2)
    for (std::size_t k = 0; k < points.size(); ++k) {
      density += (1.0 - defensive) * weights[k] * std::exp(unit.dot(points[k]) - 0.5 * points[k].squaredNorm());
    }
    units.push_back(std::move(unit));
    ratios.push_back(1.0 / density);
  }
  const Margins margins = search.margins(units);
  const std::vector<double>& above = margins.above;
  double mean = 0.0;
  double square = 0.0;
  double largest = 0.0;
  for (std::size_t i = 0; i < units.size(); ++i) {
    if (!(above[i] < 0.0)) continue;
    mean += ratios[i];
    square += ratios[i] * ratios[i];
    largest = std::max(largest, ratios[i]);
  }
  const auto n = static_cast<double>(options.samples);
  const double effective = square > 0.0 ? mean * mean / square : 0.0;
  const double heaviest = mean > 0.0 ? largest / mean : 1.0;
  result.share = mean / n;
  result.error = std::sqrt(std::max(0.0, square / n - result.share * result.share) / n);
  result.lower = std::max(0.0, result.share - normal_95 * result.error);
  result.upper = std::min(1.0, result.share + normal_95 * result.error);
  result.evaluations = search.evaluations();
  constexpr double few = 100.0;
  constexpr double heavy = 0.1;
  if (effective < few || heaviest > heavy) {
    result.trust.doubt(
        fmt::format("the share of failures rests on {:.0f} effective units, of which one weighs {:.0f} %: "
                    "failures elsewhere may have been missed; take more samples",
                    effective, 100.0 * heaviest));
  }
  if (margins.without_answer > 0) {
    result.trust.doubt(
        fmt::format("{} of the {} units drawn have no answer and count as failures; "
                    "keep the distributions away from such devices",
                    margins.without_answer, units.size()));
  }
  if (margins.doubtful > 0) {
    result.trust.doubt(
        fmt::format("the limits of {} of the {} units drawn are doubtful", margins.doubtful, units.size()));
  }
  return result;
}

}  // namespace zwidth
