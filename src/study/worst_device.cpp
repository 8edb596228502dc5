#include <Eigen/Core>
#include <algorithm>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "stability/users/any_user_limit.hpp"
#include "staged_progress.hpp"
#include "study/philox.hpp"
#include "study/study_parts.hpp"
#include "zwidth/design/sensitivity.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/device_trust.hpp"
#include "zwidth/model/parameter.hpp"
#include "zwidth/stability/absolute_stability.hpp"

namespace zwidth::internal {
namespace {

constexpr double outside = 1e-6;  // share of units beyond the ball
constexpr std::size_t most_starts = 16;
constexpr int most_steps = 60;       // of one descent
constexpr int most_halvings = 14;    // of one step
constexpr double near_limit = 3.0;   // crossovers up to so many times the limit may take over
constexpr double least_gain = 1e-9;  // relative, of a step worth taking
constexpr double same_limit = 1e-4;  // relative, of two descents that ended alike
constexpr std::uint32_t extremes_stream = 0x30000;
constexpr double difference = 1e-5;  // of a normal score, for the slope of a quantile function

/// Units at the ends of everything, tried beside the lowest samples.
constexpr std::size_t extremes_of(SearchedLimit searched) { return searched == SearchedLimit::any_user ? 128 : 1024; }

/// Where units may be: by parameter a coordinate in its own ends, or an independent normal number; these together within
/// a ball. Coordinates with ends run over 0..1.
class Domain {
 public:
  explicit Domain(const StudyRun& run) : run_(run), size_(run.inputs().size()) {
    std::size_t free = 0;
    for (std::size_t j = 0; j < size_; ++j) {
      has_ends_.push_back(run.inputs().quantile(j).bounded() && !run.inputs().is_correlated(j));
      free += has_ends_[j] ? 0U : 1U;
    }
    // P(|z| > R) = Q(k/2, R^2/2) = outside
    if (free > 0) radius_ = std::sqrt(2.0 * boost::math::gamma_q_inv(0.5 * static_cast<double>(free), outside));
  }

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool has_ends(std::size_t j) const { return has_ends_[j]; }

  [[nodiscard]] std::vector<double> values(const Eigen::VectorXd& at) const {
    std::vector<double> numbers(size_);
    for (std::size_t j = 0; j < size_; ++j) numbers[j] = has_ends_[j] ? 0.0 : at(index(j));
    run_.inputs().from_normal(numbers);
    for (std::size_t j = 0; j < size_; ++j) {
      if (has_ends_[j]) numbers[j] = value_between(j, at(index(j)));
    }
    return numbers;
  }

  /// Of a sample, brought into the ball.
  [[nodiscard]] Eigen::VectorXd place_of(std::uint64_t sample) const {
    std::vector<double> values(size_);
    run_.values(sample, values);
    const std::vector<double> scores = run_.independent_scores(sample);
    Eigen::VectorXd at(static_cast<Eigen::Index>(size_));
    for (std::size_t j = 0; j < size_; ++j) {
      const QuantileFunction& quantile = run_.inputs().quantile(j);
      const double width = quantile.largest() - quantile.least();
      at(index(j)) = !has_ends_[j] ? scores[j] : width > 0.0 ? (values[j] - quantile.least()) / width : 0.0;
    }
    return brought_inside(at);
  }

  [[nodiscard]] Eigen::VectorXd brought_inside(Eigen::VectorXd at) const {
    const double length = ball_length(at);
    for (std::size_t j = 0; j < size_; ++j) {
      if (has_ends_[j]) {
        at(index(j)) = std::clamp(at(index(j)), 0.0, 1.0);
      } else if (length > radius_) {
        at(index(j)) *= radius_ / length;
      }
    }
    return at;
  }

  /// The place where a linear function of this slope is least.
  [[nodiscard]] Eigen::VectorXd least_along(const Eigen::VectorXd& slope, const Eigen::VectorXd& from) const {
    Eigen::VectorXd to = from;
    const double length = ball_length(slope);
    for (std::size_t j = 0; j < size_; ++j) {
      const double of = slope(index(j));
      if (has_ends_[j]) {
        if (of != 0.0) to(index(j)) = of > 0.0 ? 0.0 : 1.0;
      } else if (length > 0.0) {
        to(index(j)) = -radius_ * of / length;
      }
    }
    return to;
  }

  /// The k-th place where everything is at an end: corners, and directions of the ball.
  [[nodiscard]] Eigen::VectorXd extreme(std::uint64_t seed, std::uint64_t k) const {
    Eigen::VectorXd at(static_cast<Eigen::Index>(size_));
    for (std::size_t j = 0; j < size_; ++j) {
      const double u = uniform_of(random_bits(seed, extremes_stream + static_cast<std::uint32_t>(j), k));
      at(index(j)) = has_ends_[j] ? (u < 0.5 ? 0.0 : 1.0) : standard_normal_score(u);
    }
    const double length = ball_length(at);
    for (std::size_t j = 0; j < size_; ++j) {
      if (!has_ends_[j] && length > 0.0) at(index(j)) *= radius_ / length;
    }
    return at;
  }

  /// d x / d coordinate, one column per coordinate, at a place.
  [[nodiscard]] Eigen::MatrixXd gradients(const Eigen::VectorXd& at) const {
    Eigen::MatrixXd gradients(at.size(), at.size());
    for (Eigen::Index k = 0; k < at.size(); ++k) {
      const auto moved = static_cast<std::size_t>(k);
      if (has_ends_[moved]) {
        const QuantileFunction& quantile = run_.inputs().quantile(moved);
        gradients.col(k).setZero();
        gradients(k, k) = quantile.largest() - quantile.least();
        continue;
      }
      Eigen::VectorXd low = at;
      Eigen::VectorXd high = at;
      low(k) -= difference;
      high(k) += difference;
      const std::vector<double> below = values(low);
      const std::vector<double> above = values(high);
      for (Eigen::Index i = 0; i < at.size(); ++i) {
        const auto j = static_cast<std::size_t>(i);
        gradients(i, k) = (above[j] - below[j]) / (2.0 * difference);
      }
    }
    return gradients;
  }

 private:
  static Eigen::Index index(std::size_t j) { return static_cast<Eigen::Index>(j); }

  [[nodiscard]] double value_between(std::size_t j, double share) const {
    const QuantileFunction& quantile = run_.inputs().quantile(j);
    const double value = quantile.least() + share * (quantile.largest() - quantile.least());
    const std::vector<double>& values = quantile.distribution().values;
    if (values.empty()) return value;
    const auto next = std::ranges::lower_bound(values, value);
    if (next == values.end()) return values.back();
    if (next == values.begin() || *next - value <= value - *(next - 1)) return *next;
    return *(next - 1);
  }

  [[nodiscard]] double ball_length(const Eigen::VectorXd& at) const {
    double square = 0.0;
    for (std::size_t j = 0; j < size_; ++j) square += has_ends_[j] ? 0.0 : at(index(j)) * at(index(j));
    return std::sqrt(square);
  }

  const StudyRun& run_;
  std::size_t size_;
  std::vector<bool> has_ends_;
  double radius_ = 0.0;
};

struct Place {
  Eigen::VectorXd at;
  double limit = std::numeric_limits<double>::quiet_NaN();  // that is searched; where there is no device it stays so
  CriticalStiffness critical = {};                          // where its stiffness is the limit
  AbsoluteStabilityLimit any_user = {};                     // where it is that
};

class Search {
 public:
  Search(const StudyRun& run, SearchedLimit searched, const Progress& progress)
      : run_(run), searched_(searched), progress_(progress), domain_(run) {}

  [[nodiscard]] DeviceParameters device_at(const Eigen::VectorXd& at) const {
    DeviceParameters parameters = run_.device().parameters();
    parameters.uncertainty.reset();
    const std::vector<double> values = domain_.values(at);
    for (std::size_t j = 0; j < values.size(); ++j) {
      set_parameter(parameters, run_.distributions().parameters[j].key, values[j]);
    }
    return parameters;
  }

  [[nodiscard]] Place solved(Eigen::VectorXd at) {
    tell(progress_, 0.0);
    ++evaluations_;
    Place place{std::move(at)};
    DeviceParameters parameters = device_at(place.at);
    if (find_problem(parameters)) return place;
    try {
      const Device device(std::move(parameters));
      if (searched_ == SearchedLimit::any_user) {
        place.any_user = known_any_user_limit(device, progress_);
        place.limit = place.any_user.stiffness;
      } else {
        place.critical = critical_stiffness(device);
        if (place.critical.status != StiffnessStatus::refused) place.limit = place.critical.stiffness;
      }
    } catch (const Error&) {  // no answer there: not a place to go
    }
    return place;
  }

  /// From place to place as long as one is lower: along the slope of the limit, and of each crossover that may take over.
  [[nodiscard]] Place descend(Place from) {
    for (int step = 0; step < most_steps && from.limit > 0.0; ++step) {
      std::optional<Place> lower;
      for (const Eigen::VectorXd& slope : gradients(from)) {
        lower = step_along(from, slope);
        if (lower) break;
      }
      if (!lower) lower = step_beside(from);
      if (!lower) break;
      from = *std::move(lower);
    }
    return from;
  }

  [[nodiscard]] const Domain& domain() const { return domain_; }
  [[nodiscard]] std::uint64_t evaluations() const { return evaluations_; }

 private:
  /// By coordinate: of the limiting crossover first, then of the others by rising stiffness.
  [[nodiscard]] std::vector<Eigen::VectorXd> gradients(const Place& from) {
    std::vector<Eigen::VectorXd> gradients;
    if (!std::isfinite(from.limit) || !(from.limit > 0.0)) return gradients;
    const Device device(device_at(from.at));
    const Eigen::MatrixXd of_values = domain_.gradients(from.at);
    const auto add = [&](const std::vector<Sensitivity>& sensitivities) {
      Eigen::VectorXd slope = Eigen::VectorXd::Zero(from.at.size());
      for (const Sensitivity& each : sensitivities) {
        const std::size_t j = index_of(each.key);
        if (j < domain_.size()) slope += each.slope * of_values.row(static_cast<Eigen::Index>(j)).transpose();
      }
      if (slope.allFinite() && slope.squaredNorm() > 0.0) gradients.push_back(std::move(slope));
    };
    if (searched_ == SearchedLimit::any_user) {
      try {
        add(absolute_stability_sensitivities(device, from.any_user));
      } catch (const Error&) {  // steps beside it remain
      }
      return gradients;
    }
    std::vector<Crossover> crossovers = from.critical.crossovers;
    std::ranges::sort(crossovers, {}, &Crossover::stiffness);
    std::stable_partition(crossovers.begin(), crossovers.end(),
                          [&](const Crossover& each) { return each.frequency == from.critical.limit->frequency; });
    for (const Crossover& crossover : crossovers) {
      if (crossover.stiffness > near_limit * from.critical.stiffness) continue;
      CriticalStiffness other = from.critical;
      other.limit = crossover;
      other.stiffness = crossover.stiffness;
      try {
        add(stiffness_sensitivities(device, other));
      } catch (const Error&) {
        continue;
      }
    }
    return gradients;
  }

  [[nodiscard]] std::size_t index_of(const std::string& key) const {
    const auto& parameters = run_.distributions().parameters;
    for (std::size_t j = 0; j < parameters.size(); ++j) {
      if (full_parameter_key(run_.device().parameters(), parameters[j].key) == key) return j;
    }
    return parameters.size();
  }

  [[nodiscard]] std::optional<Place> step_along(const Place& from, const Eigen::VectorXd& slope) {
    const Eigen::VectorXd direction = domain_.least_along(slope, from.at) - from.at;
    double share = 1.0;
    for (int halving = 0; halving < most_halvings; ++halving, share *= 0.5) {
      Place to = solved(from.at + share * direction);
      if (is_lower(to, from)) return to;
    }
    return std::nullopt;
  }

  /// One coordinate after the other to both its sides: where the slopes say nothing, as of values that are counted.
  [[nodiscard]] std::optional<Place> step_beside(const Place& from) {
    for (Eigen::Index k = 0; k < from.at.size(); ++k) {
      const bool has_ends = domain_.has_ends(static_cast<std::size_t>(k));
      for (const double to :
           has_ends ? std::vector<double>{0.0, 1.0} : std::vector<double>{from.at(k) - 0.3, from.at(k) + 0.3}) {
        Eigen::VectorXd at = from.at;
        at(k) = to;
        Place place = solved(domain_.brought_inside(std::move(at)));
        if (is_lower(place, from)) return place;
      }
    }
    return std::nullopt;
  }

  static bool is_lower(const Place& place, const Place& than) { return place.limit < than.limit * (1.0 - least_gain); }

  const StudyRun& run_;
  SearchedLimit searched_;
  const Progress& progress_;
  Domain domain_;
  std::uint64_t evaluations_ = 0;
};

/// The lowest of the units at the ends of everything.
std::vector<Eigen::VectorXd> low_extremes(const StudyRun& run, const Domain& domain, SearchedLimit searched,
                                          const Progress& progress) {
  const bool any_user = searched == SearchedLimit::any_user;
  std::vector<Eigen::VectorXd> places;
  std::vector<ParameterValues> columns;
  for (const StudyParameter& each : run.distributions().parameters) columns.push_back({each.key, {}});
  for (std::uint64_t k = 0; k < extremes_of(searched); ++k) {
    places.push_back(domain.extreme(run.options().seed, k));
    const std::vector<double> values = domain.values(places.back());
    for (std::size_t j = 0; j < values.size(); ++j) columns[j].values.push_back(values[j]);
  }
  const BatchStiffness answers = run.answers(columns, any_user, progress);
  const std::vector<double>& limits = any_user ? answers.any_user : answers.stiffness;
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < limits.size(); ++k) {
    if (!std::isnan(limits[k])) order.push_back(k);
  }
  std::ranges::stable_sort(order, {}, [&](std::size_t k) { return limits[k]; });
  std::vector<Eigen::VectorXd> lowest;
  for (std::size_t i = 0; i < std::min(order.size(), most_starts / 4); ++i) lowest.push_back(places[order[i]]);
  return lowest;
}

}  // namespace

std::optional<WorstDevice> find_worst(const StudyRun& run, const std::vector<LowSample>& lows, SearchedLimit searched,
                                      const Progress& progress) {
  if (lows.empty()) return std::nullopt;
  Search search(run, searched, progress);
  std::vector<Eigen::VectorXd> starts = low_extremes(run, search.domain(), searched, progress);
  for (const LowSample& low : lows) starts.push_back(search.domain().place_of(low.sample));
  std::optional<Place> worst;
  std::vector<double> ends;
  for (Eigen::VectorXd& start : starts) {
    Place place = search.solved(std::move(start));
    if (std::isnan(place.limit)) continue;
    place = search.descend(std::move(place));
    ends.push_back(place.limit);
    if (!worst || place.limit < worst->limit) worst = std::move(place);
    if (worst->limit == 0.0) break;
  }
  if (!worst) return std::nullopt;
  WorstDevice found;
  found.values = search.domain().values(worst->at);
  found.device = search.device_at(worst->at);
  found.descents = ends.size();
  found.agreeing = static_cast<std::size_t>(
      std::ranges::count_if(ends, [&](double end) { return end <= worst->limit * (1.0 + same_limit); }));
  // A sample beyond the ball may be lower still: then it is the worst that is known.
  if (lows.front().limit < worst->limit) {
    run.values(lows.front().sample, found.values);
    for (std::size_t j = 0; j < found.values.size(); ++j) {
      set_parameter(found.device, run.distributions().parameters[j].key, found.values[j]);
    }
  }
  found.trust = trust_of(run.device());
  if (found.agreeing < 2 && worst->limit > 0.0) {
    found.trust.doubt({.code = FindingCode::one_descent_alone,
                       .evidence = {{"descents", static_cast<double>(found.descents)}},
                       .effect = {{"critical_stiffness", worst->limit}}});
  }
  const Device device(found.device);
  found.critical = critical_stiffness(device);
  found.trust.inherit(found.critical.trust);
  if (run.options().any_user) {
    const AbsoluteStabilityLimit limit = known_any_user_limit(device, progress);
    found.any_user = limit.stiffness;
    found.trust.inherit(limit.trust);
  }
  found.sampled = lows.front().limit;
  found.outside = outside;
  found.evaluations = search.evaluations() + extremes_of(searched);
  return found;
}

}  // namespace zwidth::internal
