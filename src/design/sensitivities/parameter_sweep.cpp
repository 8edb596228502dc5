#include "zwidth/design/parameter_sweep.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "counted.hpp"
#include "model/key_members.hpp"
#include "model/known_structure.hpp"
#include "stability/users/any_user_limit.hpp"
#include "staged_progress.hpp"
#include "zwidth/batch/batch_stiffness.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/device_trust.hpp"
#include "zwidth/model/parameter.hpp"

namespace zwidth {
using namespace internal;
namespace {

constexpr std::size_t worth_threads = 64;  // points

std::optional<DeviceProblem> find_axis_problem(const DeviceParameters& parameters, const SweepAxis& axis) {
  const std::string key = full_parameter_key(parameters, axis.key);
  const std::vector<std::string> keys = parameter_keys(parameters);
  if (std::ranges::find(keys, key) == keys.end()) {
    return device_problem(axis.key, {.code = ProblemCode::no_number_of_device,
                                     .subjects = {{"numbers", fmt::format("{}", fmt::join(keys, ", "))}}});
  }
  if (row_of(key)->reach == KeyReach::nothing) {
    return device_problem(key, {.code = ProblemCode::not_of_the_limit});
  }
  if (!std::isfinite(axis.first) || !std::isfinite(axis.last)) {
    return device_problem(
        key, {.code = ProblemCode::range_not_finite, .evidence = {{"first", axis.first}, {"last", axis.last}}});
  }
  if (axis.first == axis.last) {
    return device_problem(
        key, {.code = ProblemCode::range_without_width, .evidence = {{"first", axis.first}, {"last", axis.last}}});
  }
  if (axis.spacing == SweepAxis::Spacing::logarithmic && !(axis.first > 0.0 && axis.last > 0.0)) {
    return device_problem(
        key, {.code = ProblemCode::range_without_factor, .evidence = {{"first", axis.first}, {"last", axis.last}}});
  }
  if (axis.count < 2 || axis.count > most_sweep_points) {
    return device_problem(
        key, {.code = ProblemCode::values_out_of_range,
              .evidence = {counted("count", axis.count), counted("least", 2), counted("most", most_sweep_points)}});
  }
  return std::nullopt;
}

class Points {
 public:
  Points(const Device& device, const std::vector<SweepAxis>& axes) : parameters_(device.parameters()), axes_(axes) {
    parameters_.uncertainty.reset();
    for (const SweepAxis& axis : axes) values_.push_back(values_of(axis));
  }

  [[nodiscard]] const std::vector<std::vector<double>>& values() const { return values_; }

  [[nodiscard]] std::size_t count() const {
    std::size_t product = 1;
    for (const auto& each : values_) product *= each.size();
    return product;
  }

  [[nodiscard]] DeviceParameters at(std::size_t index) const {
    DeviceParameters moved = parameters_;
    for (std::size_t axis = axes_.size(); axis-- > 0;) {
      set_parameter(moved, axes_[axis].key, values_[axis][index % values_[axis].size()]);
      index /= values_[axis].size();
    }
    return moved;
  }

  /// The values of every point, by axis.
  [[nodiscard]] std::vector<ParameterValues> columns() const {
    std::vector<ParameterValues> columns;
    std::size_t repeated = count();
    for (std::size_t axis = 0; axis < axes_.size(); ++axis) {
      repeated /= values_[axis].size();
      columns.push_back({axes_[axis].key, std::vector<double>(count())});
      for (std::size_t i = 0; i < count(); ++i) {
        columns.back().values[i] = values_[axis][i / repeated % values_[axis].size()];
      }
    }
    return columns;
  }

 private:
  DeviceParameters parameters_;
  const std::vector<SweepAxis>& axes_;
  std::vector<std::vector<double>> values_;
};

/// `trust`: of the device that is swept.
SweepPoint point_of(const Device& device, const SweepOptions& options, const Trust& trust) {
  if (trust.refused()) {
    return {StiffnessStatus::refused, std::numeric_limits<double>::quiet_NaN(), std::nullopt, std::nullopt, {}, trust};
  }
  CriticalStiffness critical = critical_stiffness(device);
  critical.trust.inherit(trust);
  SweepPoint point{critical.status, critical.stiffness, critical.limit, std::nullopt, {}, std::move(critical.trust)};
  if (point.trust.refused()) return point;
  if (options.any_user) {
    point.any_user = known_any_user_limit(device);
    point.trust.inherit(point.any_user->trust);
  }
  if (options.crossovers) point.crossovers = std::move(critical.crossovers);
  return point;
}

/// The limits alone, by the kernel of many devices.
void find_limits(const Device& device, const Points& points, std::vector<SweepPoint>& found, const Progress& progress) {
  const BatchStiffness answers = batch_stiffness(device, points.columns(), {}, progress);
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (!answers.failure_of(i).empty()) (void)critical_stiffness(Device(points.at(i)));  // throws as it did there
    SweepPoint& point = found[i];
    point = {answers.status[i], answers.stiffness[i], std::nullopt, std::nullopt, {}, answers.trust_of(i)};
    if (const auto mechanism = answers.limited_by(i)) {
      point.limit = Crossover{answers.frequency[i], answers.stiffness[i], *mechanism, answers.poles_leaving[i]};
    }
  }
}

/// The points' reasons stand with them.
Trust trust_of(const Device& device, const std::vector<SweepPoint>& points) {
  Trust trust = trust_of(device);
  if (!trust.sound()) return trust;
  const auto count = [&points](auto is) { return std::count_if(points.begin(), points.end(), is); };
  const auto refused = count([](const SweepPoint& each) { return each.trust.refused(); });
  const auto unsound = count([](const SweepPoint& each) { return !each.trust.sound(); });
  if (unsound == 0) return trust;
  const SweepPoint& first =
      *std::find_if(points.begin(), points.end(), [](const SweepPoint& each) { return !each.trust.sound(); });
  Finding finding{.code = FindingCode::points_not_sound,
                  .evidence = {{"points", static_cast<double>(points.size())},
                               {"refused", static_cast<double>(refused)},
                               {"doubtful", static_cast<double>(unsound - refused)}},
                  .subjects = {{"reason", first.trust.reasons.front()}}};
  refused == static_cast<std::ptrdiff_t>(points.size()) ? trust.refuse(std::move(finding))
                                                        : trust.doubt(std::move(finding));
  return trust;
}

}  // namespace

std::vector<double> values_of(const SweepAxis& axis) {
  std::vector<double> values(axis.count);
  const bool logarithmic = axis.spacing == SweepAxis::Spacing::logarithmic;
  for (std::size_t i = 0; i < axis.count; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(axis.count - 1);
    values[i] = logarithmic ? axis.first * std::pow(axis.last / axis.first, share)
                            : axis.first + share * (axis.last - axis.first);
  }
  values.back() = axis.last;
  return values;
}

std::optional<DeviceProblem> find_sweep_problem(const Device& device, const std::vector<SweepAxis>& axes) {
  if (axes.empty() || axes.size() > 2) {
    return device_problem(
        "sweep", {.code = ProblemCode::too_many_numbers_swept, .evidence = {counted("parameters", axes.size())}});
  }
  for (const SweepAxis& axis : axes) {
    if (auto problem = find_axis_problem(device.parameters(), axis)) return problem;
  }
  if (axes.size() == 2) {
    const std::string first = full_parameter_key(device.parameters(), axes[0].key);
    if (first == full_parameter_key(device.parameters(), axes[1].key)) {
      return device_problem(first, {.code = ProblemCode::swept_twice});
    }
    if (axes[0].count > most_sweep_points / axes[1].count) {
      return device_problem("sweep", {.code = ProblemCode::too_many_points,
                                      .evidence = {counted("count", axes[0].count), counted("other", axes[1].count),
                                                   counted("most", most_sweep_points)}});
    }
  }
  const Points points(device, axes);
  for (std::size_t i = 0; i < points.count(); ++i) {
    if (auto problem = find_problem(points.at(i))) return problem;
  }
  return std::nullopt;
}

std::optional<OptionProblem> find_problem(const SweepOptions& options, const Device& device) {
  if (!options.any_user || device.is_mechanical()) return std::nullopt;
  return option_problem("any_user", {.code = ProblemCode::asked_of_transfer_function});
}

ParameterSweep parameter_sweep(const Device& device, const std::vector<SweepAxis>& axes, SweepOptions options,
                               const Progress& progress) {
  require_known_structure(device);
  if (const auto problem = find_sweep_problem(device, axes)) {
    throw Error(ErrorCode::invalid_argument, fmt::format("{}: {}; {}", problem->key, problem->what, problem->allowed));
  }
  if (const auto problem = find_problem(options, device)) {
    throw Error(ErrorCode::needs_bodies, fmt::format("{} {}; {}", problem->member, problem->what, problem->allowed));
  }
  const Points points(device, axes);
  ParameterSweep sweep{axes, points.values(), std::vector<SweepPoint>(points.count()), options.any_user, {}};
  for (SweepAxis& axis : sweep.axes) axis.key = without_alias(axis.key);
  const Trust trust = trust_of(device);
  SharedProgress shared(progress, sweep.points.size());
  const auto compute = [&](std::size_t i) {
    sweep.points[i] = point_of(Device(points.at(i)), options, trust);
    shared.add();
  };
  if (!options.any_user && !options.crossovers && !trust.refused()) {
    find_limits(device, points, sweep.points, progress);
  } else if (sweep.points.size() > worth_threads) {
    tbb::parallel_for(std::size_t{0}, sweep.points.size(), compute);
  } else {
    for (std::size_t i = 0; i < sweep.points.size(); ++i) compute(i);
  }
  sweep.trust = trust_of(device, sweep.points);
  return sweep;
}

}  // namespace zwidth
