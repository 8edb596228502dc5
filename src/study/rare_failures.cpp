#include "zwidth/study/rare_failures.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "counted.hpp"
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
constexpr std::uint32_t pilot_stream = 0x70000;
constexpr std::uint32_t pilot_choice_stream = 0x80000;
constexpr std::size_t explored = 2048;  // units of each spread
constexpr double spreads[] = {1.0, 2.0, 3.0};
constexpr std::size_t most_points = 8;
constexpr std::size_t starts = 12;
constexpr int most_iterations = 25;
constexpr double farthest = 8.0;        // standard deviations: beyond, nothing is drawn
constexpr double apart = 1.0;           // two design points
constexpr double much_farther = 2.5;    // than the nearest: its failures do not count
constexpr double on_border = 1e-3;      // relative to the specified stiffness
constexpr double difference = 1e-4;     // of a score, for the slope
constexpr double defensive = 0.1;       // share of the units that are drawn as they are
constexpr std::uint64_t pilots = 2048;  // units of each round that looks for where the failures are
constexpr std::uint64_t pilot_rounds = 2;
constexpr std::size_t pilot_centres = 64;

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

/// Where the units are drawn: unit normal ones about centres, and as they are.
///
///     q(y) = d phi(y) + (1 - d) sum of w_k phi(y - c_k)
class Mixture {
 public:
  /// About design points: half by what lies beyond them, half the same for each.
  explicit Mixture(const Points& design) {
    double sum = 0.0;
    for (const Eigen::VectorXd& each : design) sum += standard_normal_probability(-each.norm());
    for (const Eigen::VectorXd& each : design) {
      add(each, 0.5 * standard_normal_probability(-each.norm()) / sum + 0.5 / static_cast<double>(design.size()));
    }
  }

  /// These as likely, together, as those that there are.
  void add_half(const Points& centres) {
    for (double& weight : weights_) weight *= 0.5;
    for (const Eigen::VectorXd& each : centres) add(each, 0.5 / static_cast<double>(centres.size()));
  }

  /// `choice` is uniform; a unit normal one becomes one of these.
  [[nodiscard]] Eigen::VectorXd moved(Eigen::VectorXd unit, double choice) const {
    if (choice < defensive) return unit;
    choice = (choice - defensive) / (1.0 - defensive);
    std::size_t k = 0;
    while (k + 1 < weights_.size() && choice >= weights_[k]) choice -= weights_[k++];
    return unit + centres_[k];
  }

  /// phi(y) / q(y)
  [[nodiscard]] double ratio(const Eigen::VectorXd& unit) const {
    double density = defensive;  // relative to phi: exp(y c_k - |c_k|²/2)
    for (std::size_t k = 0; k < weights_.size(); ++k) {
      density += (1.0 - defensive) * weights_[k] * std::exp(unit.dot(centres_[k]) - 0.5 * squares_[k]);
    }
    return 1.0 / density;
  }

 private:
  void add(const Eigen::VectorXd& centre, double weight) {
    centres_.push_back(centre);
    squares_.push_back(centre.squaredNorm());
    weights_.push_back(weight);
  }

  Points centres_;
  std::vector<double> squares_;
  std::vector<double> weights_;
};

/// Units of the mixture.
struct Drawn {
  Points units;
  std::vector<double> ratios;
};

Drawn drawn(const RareSearch& search, const Mixture& mixture, std::uint64_t seed, std::uint32_t stream,
            std::uint32_t of_choice, std::uint64_t first, std::uint64_t count) {
  Drawn result;
  for (std::uint64_t i = first; i < first + count; ++i) {
    result.units.push_back(mixture.moved(search.drawn(stream, i), uniform_of(random_bits(seed, of_choice, i))));
    result.ratios.push_back(mixture.ratio(result.units.back()));
  }
  return result;
}

/// Failures as they are distributed, by systematic resampling of what pilot units found: a way to fail that is wider
/// than one design point tells is drawn as wide as it is. None where none failed.
Points failing_centres(RareSearch& search, const Drawn& pilot) {
  const std::vector<double> above = search.margins(pilot.units).above;
  double whole = 0.0;
  for (std::size_t i = 0; i < above.size(); ++i) whole += above[i] < 0.0 ? pilot.ratios[i] : 0.0;
  Points centres;
  double passed = 0.0;
  for (std::size_t i = 0; i < above.size(); ++i) {
    if (!(above[i] < 0.0)) continue;
    passed += pilot.ratios[i];
    while (centres.size() < pilot_centres &&
           passed * static_cast<double>(pilot_centres) >= (static_cast<double>(centres.size()) + 0.5) * whole) {
      centres.push_back(pilot.units[i]);
    }
  }
  return centres;
}

void require(const StudyRun& run, const RareFailureOptions& options) {
  const Specification& wanted = run.options().specification;
  if (!wanted.critical_stiffness && !wanted.any_user) {
    throw Error(ErrorCode::invalid_argument, {.code = ProblemCode::specification_missing});
  }
  if (options.samples < least_samples || options.samples > most_samples) {
    throw Error(ErrorCode::invalid_argument,
                {.code = ProblemCode::count_out_of_range,
                 .evidence = {internal::counted("value", options.samples), internal::counted("least", least_samples),
                              internal::counted("most", most_samples)},
                 .subjects = {{"name", "samples"}}});
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
    result.trust.doubt({.code = FindingCode::no_failure_found, .evidence = {{"farthest", farthest}}});
    const Proportion known = search.first_share();
    result.share = known.value, result.lower = known.lower, result.upper = known.upper;
    result.error = std::sqrt(known.value * (1.0 - known.value) / explored);
    return result;
  }
  for (const Eigen::VectorXd& each : points) result.points.push_back({{each.begin(), each.end()}, each.norm()});
  const std::uint64_t seed = run.options().seed;
  Mixture mixture(points);
  for (std::uint64_t round = 0; round < pilot_rounds; ++round) {
    const Points centres = failing_centres(
        search, drawn(search, mixture, seed, pilot_stream, pilot_choice_stream, round * pilots, pilots));
    mixture = Mixture(points);
    if (!centres.empty()) mixture.add_half(centres);
  }
  const auto [units, ratios] = drawn(search, mixture, seed, draw_stream, choice_stream, 0, options.samples);
  const Margins margins = search.margins(units);
  const std::vector<double>& above = margins.above;
  double sum = 0.0;
  double squares = 0.0;
  double largest = 0.0;
  for (std::size_t i = 0; i < units.size(); ++i) {
    if (!(above[i] < 0.0)) continue;
    sum += ratios[i];
    squares += ratios[i] * ratios[i];
    largest = std::max(largest, ratios[i]);
  }
  const auto n = static_cast<double>(options.samples);
  const double effective = squares > 0.0 ? sum * sum / squares : 0.0;
  const double heaviest = sum > 0.0 ? largest / sum : 1.0;
  result.share = sum / n;
  result.error = std::sqrt(std::max(0.0, squares / n - result.share * result.share) / n);
  if (sum > 0.0) {
    const StatisticInterval interval = weighted_sum_interval(sum, squares, largest);
    result.lower = interval.lower / n;
    result.upper = std::min(1.0, interval.upper / n);
  } else {
    result.upper = search.first_share().upper;
  }
  result.evaluations = search.evaluations();
  constexpr double few = 100.0;
  constexpr double heavy = 0.1;
  if (effective < few || heaviest > heavy) {
    result.trust.doubt(
        {.code = FindingCode::few_effective_units,
         .evidence = {
             {"effective", effective}, {"heaviest", heaviest}, {"least_effective", few}, {"most_heavy", heavy}}});
  }
  if (margins.without_answer > 0) {
    result.trust.doubt({.code = FindingCode::drawn_units_without_answer,
                        .evidence = {{"without", static_cast<double>(margins.without_answer)},
                                     {"drawn", static_cast<double>(units.size())}}});
  }
  if (margins.doubtful > 0) {
    result.trust.doubt({.code = FindingCode::drawn_limits_doubtful,
                        .evidence = {{"doubtful", static_cast<double>(margins.doubtful)},
                                     {"drawn", static_cast<double>(units.size())}}});
  }
  return result;
}

}  // namespace zwidth
