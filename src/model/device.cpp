#include "zwidth/model/device.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <type_traits>
#include <utility>

#include "counted.hpp"
#include "model/coordinates_problem.hpp"
#include "model/key_members.hpp"
#include "model/mechanism_coordinates.hpp"
#include "model/rate_ratio.hpp"
#include "model/uncertainty_problem.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/model/mechanism_key.hpp"
#include "zwidth/require_valid.hpp"

namespace zwidth {
using namespace internal;
namespace {

Problem out_of_range(const NumberRange& range, KeyType type, double value) {
  const bool is_plain = range == positive_numbers || range == not_negative_numbers;
  const bool is_positive = value > 0.0 && std::isfinite(value);
  Problem problem{.code = ProblemCode::no_finite_number, .evidence = {{"value", value}}};
  if (is_plain && !is_positive) {
    if (range.takes_zero) problem.evidence.push_back({"from_zero", 1.0});
    return problem;
  }
  problem = {.code = ProblemCode::not_between,
             .evidence = {{"value", value}, {"least", range.least}, {"most", range.greatest}}};
  if (type == KeyType::whole_number) problem.evidence.push_back({"whole", 1.0});
  if (range.takes_zero) problem.evidence.push_back({"or_zero", 1.0});
  return problem;
}

Problem stands_too_often(std::size_t count, std::size_t most, const char* what) {
  return {.code = ProblemCode::stands_too_often,
          .evidence = {counted("count", count), counted("most", most)},
          .subjects = {{"what", what}}};
}

Problem no_body_number(std::size_t body, std::size_t bodies) {
  return {.code = ProblemCode::no_body_number, .evidence = {counted("body", body), counted("bodies", bodies)}};
}

Problem beside_transfer_function(const char* part) {
  return {.code = ProblemCode::beside_transfer_function, .subjects = {{"part", part}}};
}

std::string body_key(const DeviceParameters& parameters, std::size_t body) {
  const std::string& name = parameters.bodies[body].name;
  return name.empty() ? fmt::format("body.{}", body) : "body." + name;
}

/// Keeps the first problem of every key.
class Checks {
 public:
  [[nodiscard]] std::vector<DeviceProblem> problems() && { return std::move(problems_); }
  [[nodiscard]] bool passed() const { return problems_.empty(); }

  void refuse(std::string key, Problem problem) {
    if (std::ranges::find(problems_, key, &DeviceProblem::key) != problems_.end()) return;
    problems_.push_back(device_problem(std::move(key), std::move(problem)));
  }

  /// Every number that the table's struct has, against the range of its key.
  template <typename Table>
  void numbers(DeviceTable kind, std::string_view path, const Table& table) {
    visit_members(kind, table, [&](const DeviceKey& key, const auto& member) {
      if constexpr (requires { member.value(); }) {
        if (member) number(path, key, *member);
      } else if constexpr (std::is_arithmetic_v<std::remove_cvref_t<decltype(member)>>) {
        number(path, key, member);
      }
    });
  }

  template <typename Number>
  void number(std::string_view path, const DeviceKey& key, Number value) {
    const auto given = static_cast<double>(value);
    const bool is_sign = key.type == KeyType::sign;
    if (is_sign ? std::abs(given) == 1.0 : !key.range || key.range->contains(given)) return;
    refuse(fmt::format("{}.{}", path, key.name), is_sign ? Problem{.code = ProblemCode::not_one_of,
                                                                   .evidence = {{"value", given}},
                                                                   .subjects = {{"choices", "1 or -1"}}}
                                                         : out_of_range(*key.range, key.type, given));
  }

  void name(std::string key, const std::string& value) {
    const bool has_control = std::ranges::any_of(value, [](unsigned char c) { return c < 0x20 || c == 0x7f; });
    if (has_control) {
      refuse(std::move(key), {.code = ProblemCode::control_character});
    } else if (value.size() > max_name_size) {
      refuse(std::move(key), {.code = ProblemCode::too_many_bytes,
                              .evidence = {counted("bytes", value.size()), counted("most", max_name_size)}});
    }
  }

 private:
  std::vector<DeviceProblem> problems_;
};

void check_bodies(const DeviceParameters& parameters, Checks& checks) {
  const auto& bodies = parameters.bodies;
  if (bodies.size() > max_bodies) {
    checks.refuse("body", stands_too_often(bodies.size(), max_bodies, "bodies"));
    return;
  }
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Body& body = bodies[i];
    const std::string name_key = fmt::format("body.{}.name", i);
    if (body.name.empty()) checks.refuse(name_key, {.code = ProblemCode::name_empty});
    checks.name(name_key, body.name);
    const auto same_name = [&](const Body& other) { return other.name == body.name; };
    if (std::any_of(bodies.begin(), bodies.begin() + static_cast<std::ptrdiff_t>(i), same_name)) {
      checks.refuse(name_key, {.code = ProblemCode::names_two_bodies, .subjects = {{"name", body.name}}});
    }
    const std::string key = body_key(parameters, i);
    checks.numbers(DeviceTable::body, key, body);
  }
}

void check_links(const DeviceParameters& parameters, Checks& checks) {
  if (parameters.links.size() > max_links) {
    checks.refuse("link", stands_too_often(parameters.links.size(), max_links, "links"));
    return;
  }
  for (std::size_t i = 0; i < parameters.links.size(); ++i) {
    const Link& link = parameters.links[i];
    const std::string key = fmt::format("link.{}", i);
    if (std::max(link.first, link.second) >= parameters.bodies.size()) {
      Problem problem = no_body_number(std::max(link.first, link.second), parameters.bodies.size());
      problem.evidence.push_back({"of_two", 1.0});
      checks.refuse(key + ".between", std::move(problem));
    } else if (link.first == link.second) {
      checks.refuse(key + ".between",
                    {.code = ProblemCode::tied_to_itself, .subjects = {{"name", parameters.bodies[link.first].name}}});
    }
    checks.numbers(DeviceTable::link, key, link);
    if (link.stiffness == 0.0 && link.damping == 0.0) {
      checks.refuse(key + ".stiffness", {.code = ProblemCode::link_of_nothing});
    }
  }
}

std::optional<DeviceProblem> find_loose_body(const DeviceParameters& parameters) {
  // Spreads from body 0 along the links; each pass reaches at least one further body or is the last.
  std::vector<bool> reached(parameters.bodies.size(), false);
  reached[0] = true;
  for (bool spreading = true; spreading;) {
    spreading = false;
    for (const Link& link : parameters.links) {
      if (reached[link.first] != reached[link.second]) {
        reached[link.first] = reached[link.second] = true;
        spreading = true;
      }
    }
  }
  const auto loose = std::ranges::find(reached, false);
  if (loose == reached.end()) return std::nullopt;
  const auto index = static_cast<std::size_t>(loose - reached.begin());
  const bool has_link = std::ranges::any_of(
      parameters.links, [index](const Link& link) { return link.first == index || link.second == index; });
  Problem problem{.code = ProblemCode::body_not_connected};
  if (has_link) problem.subjects.push_back({"other", parameters.bodies[0].name});
  return device_problem(body_key(parameters, index), std::move(problem));
}

void check_coefficients(const std::string& key, const std::vector<double>& coefficients, Checks& checks) {
  if (coefficients.empty() || coefficients.size() > max_degree + 1) {
    checks.refuse(key, {.code = ProblemCode::number_of_coefficients,
                        .evidence = {counted("count", coefficients.size()), counted("most", max_degree + 1)}});
  }
  for (const double coefficient : coefficients) {
    const double magnitude = std::abs(coefficient);
    if (magnitude == 0.0 || (magnitude >= smallest_coefficient && magnitude <= largest_coefficient)) continue;
    checks.refuse(
        key, {.code = ProblemCode::coefficient_out_of_range,
              .evidence = {{"value", coefficient}, {"least", smallest_coefficient}, {"most", largest_coefficient}}});
  }
}

void check_transfer_function(const DeviceParameters& parameters, Checks& checks) {
  const TransferFunction& transfer = *parameters.transfer_function;
  if (!parameters.bodies.empty() || !parameters.links.empty()) {
    checks.refuse(parameters.bodies.empty() ? "link" : "body", beside_transfer_function("bodies"));
  }
  check_coefficients("transfer_function.numerator", transfer.numerator, checks);
  check_coefficients("transfer_function.denominator", transfer.denominator, checks);
  if (!checks.passed()) return;
  const auto leading = std::ranges::find_if(transfer.numerator, [](double c) { return c != 0.0; });
  if (leading == transfer.numerator.end()) {
    checks.refuse("transfer_function.numerator", {.code = ProblemCode::all_coefficients_zero});
  }
  if (transfer.denominator.front() == 0.0) {
    checks.refuse("transfer_function.denominator", {.code = ProblemCode::begins_with_zero});
  }
  const auto degree = transfer.denominator.size() - 1;
  const auto numerator_degree = transfer.numerator.end() - leading - 1;
  if (std::cmp_greater_equal(numerator_degree, degree)) {
    checks.refuse("transfer_function.numerator",
                  {.code = ProblemCode::degree_not_lower,
                   .evidence = {{"degree", static_cast<double>(numerator_degree)}, counted("denominator", degree)}});
  }
  if (transfer.numerator.size() > transfer.denominator.size()) {
    checks.refuse("transfer_function.numerator", {.code = ProblemCode::longer_than_denominator});
  }
  const Loop& loop = parameters.loop;
  if (loop.actuated != 0 || loop.sensed != 0 || loop.held != 0) {
    checks.refuse("loop", beside_transfer_function("loop"));
  }
  const User& user = parameters.user;
  if (user.mass != 0.0 || user.damping != 0.0 || user.stiffness != 0.0) {
    checks.refuse("operator", beside_transfer_function("operator"));
  }
}

void check_loop(const DeviceParameters& parameters, Checks& checks) {
  const Loop& loop = parameters.loop;
  const auto is_body = [&](std::string_view member, std::size_t body) {
    const std::size_t count = parameters.coordinates ? parameters.coordinates->points.size() : parameters.bodies.size();
    if (body >= count) checks.refuse(fmt::format("loop.{}", member), no_body_number(body, count));
  };
  if (!parameters.transfer_function && !lacks_coordinates(parameters)) {  // it makes the points
    is_body("actuated", loop.actuated);
    is_body("sensed", loop.sensed);
    is_body("held", loop.held);
  }
  checks.numbers(DeviceTable::loop, "loop", loop);
  if (positive_numbers.contains(loop.sampling_period) && loop.delay > max_delay_samples * loop.sampling_period) {
    checks.refuse("loop.delay", {.code = ProblemCode::delay_of_too_many_periods,
                                 .evidence = {{"delay", loop.delay},
                                              {"periods", loop.delay / loop.sampling_period},
                                              {"most", max_delay_samples}}});
  }
}

void check_damper(const DeviceParameters& parameters, Checks& checks) {
  const Loop& loop = parameters.loop;
  if (!loop.damper) return;
  checks.numbers(DeviceTable::loop_damper, "loop.damper", *loop.damper);
  const auto [period, delay] = damper_timing(loop);
  if (!positive_numbers.contains(loop.sampling_period) || !positive_numbers.contains(period)) return;
  constexpr double rounding = 1e-9;
  const double ratio = rate_ratio(loop.sampling_period, period);
  const double nearest = loop.sampling_period / std::clamp(ratio, 1.0 / max_rate_ratio, max_rate_ratio);
  if (!(std::abs(period - nearest) <= rounding * nearest)) {
    checks.refuse(
        "loop.damper.sampling_period",
        {.code = ProblemCode::no_whole_ratio,
         .evidence = {
             {"value", period}, {"period", loop.sampling_period}, {"most", max_rate_ratio}, {"nearest", nearest}}});
  }
  for (const auto& [key, value] : {std::pair{"loop.damper.delay", delay}, std::pair{"loop.delay", loop.delay}}) {
    const double shorter = std::min(period, loop.sampling_period);
    if (!(value > max_delay_samples * shorter)) continue;
    checks.refuse(key, {.code = ProblemCode::delay_of_too_many_periods,
                        .evidence = {{"delay", value}, {"periods", value / shorter}, {"most", max_delay_samples}}});
  }
  if (has_damper_loop(loop) && !parameters.wall.filters.empty()) {
    checks.refuse("wall.filter", {.code = ProblemCode::filters_beside_damper_loop});
  }
}

void check_filters(const DeviceParameters& parameters, Checks& checks) {
  const std::vector<WallFilter>& filters = parameters.wall.filters;
  if (filters.size() > max_wall_filters) {
    checks.refuse("wall.filter", stands_too_often(filters.size(), max_wall_filters, "filters"));
    return;
  }
  if (!positive_numbers.contains(parameters.loop.sampling_period)) return;  // their frequencies stand beside it
  for (std::size_t i = 0; i < filters.size(); ++i) {
    const auto found = find_problem(filters[i], parameters.loop.sampling_period);
    if (found) checks.refuse(fmt::format("wall.filter.{}.{}", i, found->member), found->problem.value());
  }
}

void check_driver(const DeviceParameters& parameters, Checks& checks) {
  if (!parameters.driver) return;
  const MotorDrive& drive = *parameters.driver;
  if (parameters.motion == Motion::linear && !drive.travel) {
    checks.refuse("driver.travel", {.code = ProblemCode::travel_per_turn_missing});
  }
  checks.numbers(DeviceTable::driver, "driver", drive);
  const bool is_letter = drive.command.size() == 1 && ((drive.command[0] >= 'A' && drive.command[0] <= 'Z') ||
                                                       (drive.command[0] >= 'a' && drive.command[0] <= 'z'));
  if (!is_letter) checks.refuse("driver.command", {.code = ProblemCode::no_letter});
}

void check_mechanism(const DeviceParameters& parameters, Checks& checks) {
  const MechanismFile& file = parameters.mechanism->mechanism;
  const std::array<double, 3>& normal = parameters.mechanism->normal;
  if (parameters.transfer_function || !parameters.bodies.empty() || !parameters.links.empty()) {
    checks.refuse("mechanism", {.code = ProblemCode::beside_mechanism});
  }
  if (parameters.motion == Motion::rotary) {
    checks.refuse("motion", {.code = ProblemCode::mechanism_of_rotary_motion});
  }
  if (file.path.empty() == file.text.empty()) {
    checks.refuse("mechanism.file", {.code = ProblemCode::given_beside, .subjects = {{"other", "mechanism.text"}}});
  }
  checks.name("mechanism.tip", file.tip);
  const bool is_finite = std::ranges::all_of(normal, [](double value) { return std::isfinite(value); });
  if (!parameters.mechanism->is_point &&
      (!is_finite || std::ranges::all_of(normal, [](double value) { return value == 0.0; }))) {
    checks.refuse("mechanism.normal", {.code = ProblemCode::no_direction,
                                       .evidence = {{"x", normal[0]}, {"y", normal[1]}, {"z", normal[2]}}});
  }
  for (const auto& [joint, position] : file.pose) {
    const std::string key = fmt::format("mechanism.pose.{}", joint);
    checks.name(key, joint);
    if (!not_negative_numbers.contains(std::abs(position))) {
      checks.refuse(key, {.code = ProblemCode::value_not_finite});
    }
  }
  for (const auto& [number, value] : file.numbers) {
    const std::string key = fmt::format("{}.{}", path_of(DeviceTable::mechanism), number);
    const KeyRow* row = is_key_of_mechanism_file(key) ? row_of(key) : nullptr;
    checks.name(key, number);
    if (row == nullptr) {
      checks.refuse(key, {.code = ProblemCode::no_parameter_of_device, .subjects = {{"name", number}}});
    } else {
      checks.number(key.substr(0, key.rfind('.')), row->key, value);
    }
  }
  if (file.transmissions.size() > max_bodies) {
    checks.refuse("transmission", stands_too_often(file.transmissions.size(), max_bodies, "transmissions"));
  }
  for (std::size_t i = 0; i < file.transmissions.size(); ++i) {
    checks.name(fmt::format("transmission.{}.joint", i), file.transmissions[i].joint);
    checks.numbers(DeviceTable::transmission, fmt::format("transmission.{}", i), file.transmissions[i]);
  }
}

void check_loop_parts(const DeviceParameters& parameters, Checks& checks) {
  checks.numbers(DeviceTable::actuator, "actuator", parameters.actuator);
  checks.numbers(DeviceTable::sensor, "sensor", parameters.sensor);
  checks.numbers(DeviceTable::wall, "wall", parameters.wall);
  check_filters(parameters, checks);
  check_driver(parameters, checks);
  checks.numbers(DeviceTable::user, "operator", parameters.user);
}

/// Of numbers that make a mechanism: what is wrong where it is put to its pose.
std::optional<DeviceProblem> find_problem_at_pose(const DeviceParameters& parameters) {
  if (put_to_pose() == nullptr) {
    return device_problem("mechanism", {.code = ProblemCode::no_mechanism_at_pose});
  }
  DeviceParameters posed = parameters;
  try {
    put_to_pose()(posed);
  } catch (const Error& error) {
    for (const InputProblem& each : error.problems()) {
      return DeviceProblem{each.place.key, each.what, each.allowed, each.problem};
    }
    return device_problem("mechanism.file",
                          {.code = ProblemCode::mechanism_file_refused, .subjects = {{"why", error.what()}}});
  }
  return find_problem(posed);
}

}  // namespace

std::vector<DeviceProblem> find_value_problems(const DeviceParameters& parameters) {
  Checks checks;
  checks.name("name", parameters.name);
  if (parameters.mechanism) check_mechanism(parameters, checks);
  if (lacks_coordinates(parameters)) {
    // what they are is found by the mechanism
  } else if (parameters.coordinates) {
    if (auto problem = find_coordinates_problem(parameters)) return {*std::move(problem)};
  } else if (parameters.transfer_function) {
    check_transfer_function(parameters, checks);
  } else if (parameters.bodies.empty()) {
    checks.refuse("body", {.code = ProblemCode::no_body_at_all});
    return std::move(checks).problems();
  } else {
    check_bodies(parameters, checks);
    check_links(parameters, checks);
  }
  check_loop(parameters, checks);
  check_damper(parameters, checks);
  check_loop_parts(parameters, checks);
  return std::move(checks).problems();
}

std::optional<DeviceProblem> find_problem(const DeviceParameters& parameters) {
  std::vector<DeviceProblem> problems = find_value_problems(parameters);
  if (!problems.empty()) return std::move(problems.front());
  if (lacks_coordinates(parameters)) return find_problem_at_pose(parameters);
  if (!parameters.bodies.empty()) {
    if (auto problem = find_loose_body(parameters)) return problem;
  }
  return parameters.uncertainty ? find_uncertainty_problem(parameters) : std::nullopt;
}

Device::Device(DeviceParameters parameters) : parameters_(std::move(parameters)) {
  if (lacks_coordinates(parameters_) && put_to_pose() != nullptr) {
    const std::vector<DeviceProblem> problems = find_value_problems(parameters_);
    if (!problems.empty()) refuse_key(problems.front());
    put_to_pose()(parameters_);
  }
  require_valid(find_problem(parameters_));
}

void require_no_coordinates(const Device& device) {
  if (device.parameters().coordinates)
    throw Error(ErrorCode::needs_bodies, {.code = ProblemCode::coordinates_not_known});
}

void require_no_tracking(const Device& device) {
  if (device.parameters().sensor.tracking_bandwidth > 0.0) {
    require_valid(
        std::optional(device_problem("sensor.tracking_bandwidth", {.code = ProblemCode::tracking_not_known})));
  }
}

std::size_t Device::body_index(const std::string& name) const {
  const auto& bodies = parameters_.bodies;
  const auto found = std::ranges::find(bodies, name, &Body::name);
  if (found == bodies.end()) {
    throw Error(ErrorCode::no_such_body, Problem{.code = ProblemCode::no_such_body, .subjects = {{"name", name}}});
  }
  return static_cast<std::size_t>(found - bodies.begin());
}

}  // namespace zwidth
