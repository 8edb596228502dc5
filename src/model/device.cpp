#include "zwidth/model/device.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <type_traits>
#include <utility>

#include "model/key_members.hpp"
#include "model/uncertainty_problem.hpp"
#include "zwidth/error.hpp"

namespace zwidth {
using namespace internal;
namespace {

// Coefficients are products of up to `degree` frequencies, so they spread further than physical quantities.
constexpr double smallest_coefficient = 1e-100;
constexpr double largest_coefficient = 1e100;

/// What a number outside the range must be.
std::string allowed_in(const NumberRange& range, KeyType type, double value) {
  const bool is_plain = range == positive_numbers || range == not_negative_numbers;
  const bool is_positive = value > 0.0 && std::isfinite(value);
  if (is_plain && !is_positive) return fmt::format("must be a finite number {} 0", range.takes_zero ? ">=" : ">");
  return fmt::format("must be {}{}from {} to {}", type == KeyType::whole_number ? "a whole number " : "",
                     range.takes_zero ? "0 or " : "", range.least, range.greatest);
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

  void refuse(std::string key, std::string what, std::string allowed) {
    if (std::ranges::find(problems_, key, &DeviceProblem::key) != problems_.end()) return;
    problems_.push_back({std::move(key), std::move(what), std::move(allowed)});
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

  void name(std::string key, const std::string& value) {
    const bool has_control = std::ranges::any_of(value, [](unsigned char c) { return c < 0x20 || c == 0x7f; });
    if (has_control) {
      refuse(std::move(key), "has a control character", "must be one line of plain text");
    } else if (value.size() > max_name_size) {
      refuse(std::move(key), fmt::format("has {} bytes", value.size()),
             fmt::format("must be at most {} bytes long", max_name_size));
    }
  }

 private:
  template <typename Number>
  void number(std::string_view path, const DeviceKey& key, Number value) {
    const auto given = static_cast<double>(value);
    const bool is_sign = key.type == KeyType::sign;
    if (is_sign ? std::abs(given) == 1.0 : !key.range || key.range->contains(given)) return;
    refuse(fmt::format("{}.{}", path, key.name), fmt::format("is {}", value),
           is_sign ? "must be 1 or -1" : allowed_in(*key.range, key.type, given));
  }

  std::vector<DeviceProblem> problems_;
};

void check_bodies(const DeviceParameters& parameters, Checks& checks) {
  const auto& bodies = parameters.bodies;
  if (bodies.size() > max_bodies) {
    checks.refuse("body", fmt::format("stands {} times", bodies.size()),
                  fmt::format("must be at most {} bodies", max_bodies));
    return;
  }
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Body& body = bodies[i];
    const std::string name_key = fmt::format("body.{}.name", i);
    if (body.name.empty()) checks.refuse(name_key, "is empty", "must be a name");
    checks.name(name_key, body.name);
    const auto same_name = [&](const Body& other) { return other.name == body.name; };
    if (std::any_of(bodies.begin(), bodies.begin() + static_cast<std::ptrdiff_t>(i), same_name)) {
      checks.refuse(name_key, fmt::format("\"{}\" names two bodies", body.name), "must be different for every body");
    }
    const std::string key = body_key(parameters, i);
    checks.numbers(DeviceTable::body, key, body);
  }
}

void check_links(const DeviceParameters& parameters, Checks& checks) {
  if (parameters.links.size() > max_links) {
    checks.refuse("link", fmt::format("stands {} times", parameters.links.size()),
                  fmt::format("must be at most {} links", max_links));
    return;
  }
  for (std::size_t i = 0; i < parameters.links.size(); ++i) {
    const Link& link = parameters.links[i];
    const std::string key = fmt::format("link.{}", i);
    if (std::max(link.first, link.second) >= parameters.bodies.size()) {
      checks.refuse(
          key + ".between",
          fmt::format("has body number {} of {}", std::max(link.first, link.second), parameters.bodies.size()),
          "must be two bodies of the device, counted from 0");
    } else if (link.first == link.second) {
      checks.refuse(key + ".between", fmt::format("ties \"{}\" to itself", parameters.bodies[link.first].name),
                    "must be two different bodies");
    }
    checks.numbers(DeviceTable::link, key, link);
    if (link.stiffness == 0.0 && link.damping == 0.0) {
      checks.refuse(key + ".stiffness", "and damping are both 0", "one of the two must be > 0, or there is no link");
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
  return DeviceProblem{
      body_key(parameters, index),
      has_link ? fmt::format("is not connected to body \"{}\"", parameters.bodies[0].name) : "is tied to nothing",
      "must be connected to every other body through [[link]]s"};
}

void check_coefficients(const std::string& key, const std::vector<double>& coefficients, Checks& checks) {
  if (coefficients.empty()) checks.refuse(key, "is empty", "must be one or more coefficients");
  if (coefficients.size() > max_degree + 1) {
    checks.refuse(key, fmt::format("has {} coefficients", coefficients.size()),
                  fmt::format("must be at most {} coefficients", max_degree + 1));
  }
  for (const double coefficient : coefficients) {
    const double magnitude = std::abs(coefficient);
    if (magnitude == 0.0 || (magnitude >= smallest_coefficient && magnitude <= largest_coefficient)) continue;
    checks.refuse(key, fmt::format("has the coefficient {}", coefficient),
                  fmt::format("every coefficient must be 0 or from {} to {} in magnitude", smallest_coefficient,
                              largest_coefficient));
  }
}

void check_transfer_function(const DeviceParameters& parameters, Checks& checks) {
  const TransferFunction& transfer = *parameters.transfer_function;
  if (!parameters.bodies.empty() || !parameters.links.empty()) {
    checks.refuse(parameters.bodies.empty() ? "link" : "body", "stands beside a transfer function",
                  "must be either bodies and links or a transfer function");
  }
  check_coefficients("transfer_function.numerator", transfer.numerator, checks);
  check_coefficients("transfer_function.denominator", transfer.denominator, checks);
  if (!checks.passed()) return;
  const auto leading = std::ranges::find_if(transfer.numerator, [](double c) { return c != 0.0; });
  if (leading == transfer.numerator.end()) {
    checks.refuse("transfer_function.numerator", "is 0", "must have a coefficient that is not 0");
  }
  if (transfer.denominator.front() == 0.0) {
    checks.refuse("transfer_function.denominator", "begins with 0", "the leading coefficient must not be 0");
  }
  const auto degree = transfer.denominator.size() - 1;
  const auto numerator_degree = transfer.numerator.end() - leading - 1;
  if (std::cmp_greater_equal(numerator_degree, degree)) {
    checks.refuse("transfer_function.numerator",
                  fmt::format("has degree {} under a denominator of degree {}", numerator_degree, degree),
                  "must be of lower degree than the denominator");
  }
  if (transfer.numerator.size() > transfer.denominator.size()) {
    checks.refuse("transfer_function.numerator", "is longer than the denominator", "leave out its leading zeros");
  }
  const Loop& loop = parameters.loop;
  if (loop.actuated != 0 || loop.sensed != 0 || loop.held != 0) {
    checks.refuse("loop", "names a body beside a transfer function", "a transfer function has no bodies");
  }
  const User& user = parameters.user;
  if (user.mass != 0.0 || user.damping != 0.0 || user.stiffness != 0.0) {
    checks.refuse("operator", "stands beside a transfer function", "an operator needs bodies: leave it out");
  }
}

void check_loop(const DeviceParameters& parameters, Checks& checks) {
  const Loop& loop = parameters.loop;
  const auto is_body = [&](std::string_view member, std::size_t body) {
    if (body < parameters.bodies.size()) return;
    checks.refuse(fmt::format("loop.{}", member),
                  fmt::format("is body number {} of {}", body, parameters.bodies.size()),
                  "must be a body of the device, counted from 0");
  };
  if (!parameters.transfer_function) {
    is_body("actuated", loop.actuated);
    is_body("sensed", loop.sensed);
    is_body("held", loop.held);
  }
  checks.numbers(DeviceTable::loop, "loop", loop);
  if (positive_numbers.contains(loop.sampling_period) && loop.delay > max_delay_samples * loop.sampling_period) {
    checks.refuse("loop.delay",
                  fmt::format("is {} s, {:.6g} sampling periods", loop.delay, loop.delay / loop.sampling_period),
                  fmt::format("must be at most {} sampling periods", max_delay_samples));
  }
}

void check_filters(const DeviceParameters& parameters, Checks& checks) {
  const std::vector<WallFilter>& filters = parameters.wall.filters;
  if (filters.size() > max_wall_filters) {
    checks.refuse("wall.filter", fmt::format("stands {} times", filters.size()),
                  fmt::format("must be at most {} filters", max_wall_filters));
    return;
  }
  if (!positive_numbers.contains(parameters.loop.sampling_period)) return;  // their frequencies stand beside it
  for (std::size_t i = 0; i < filters.size(); ++i) {
    const auto problem = find_problem(filters[i], parameters.loop.sampling_period);
    if (problem) checks.refuse(fmt::format("wall.filter.{}.{}", i, problem->member), problem->what, problem->allowed);
  }
}

void check_driver(const DeviceParameters& parameters, Checks& checks) {
  if (!parameters.driver) return;
  const MotorDrive& drive = *parameters.driver;
  if (parameters.motion == Motion::linear && !drive.travel) {
    checks.refuse("driver.travel", "is missing",
                  "must be given: how far the device moves in a turn, such as \"25 mm\"");
  }
  checks.numbers(DeviceTable::driver, "driver", drive);
  const bool is_letter = drive.command.size() == 1 && ((drive.command[0] >= 'A' && drive.command[0] <= 'Z') ||
                                                       (drive.command[0] >= 'a' && drive.command[0] <= 'z'));
  if (!is_letter) checks.refuse("driver.command", "is no letter", "must be one letter, such as \"M\"");
}

void check_loop_parts(const DeviceParameters& parameters, Checks& checks) {
  checks.numbers(DeviceTable::actuator, "actuator", parameters.actuator);
  checks.numbers(DeviceTable::sensor, "sensor", parameters.sensor);
  checks.numbers(DeviceTable::wall, "wall", parameters.wall);
  check_filters(parameters, checks);
  check_driver(parameters, checks);
  checks.numbers(DeviceTable::user, "operator", parameters.user);
}

}  // namespace

std::vector<DeviceProblem> find_value_problems(const DeviceParameters& parameters) {
  Checks checks;
  checks.name("name", parameters.name);
  if (parameters.transfer_function) {
    check_transfer_function(parameters, checks);
  } else if (parameters.bodies.empty()) {
    checks.refuse("body", "is missing: the device has no [[body]] and no [transfer_function]",
                  "must be one or more bodies, or a transfer function");
    return std::move(checks).problems();
  } else {
    check_bodies(parameters, checks);
    check_links(parameters, checks);
  }
  check_loop(parameters, checks);
  check_loop_parts(parameters, checks);
  return std::move(checks).problems();
}

std::optional<DeviceProblem> find_problem(const DeviceParameters& parameters) {
  std::vector<DeviceProblem> problems = find_value_problems(parameters);
  if (!problems.empty()) return std::move(problems.front());
  if (!parameters.transfer_function) {
    if (auto problem = find_loose_body(parameters)) return problem;
  }
  return parameters.uncertainty ? find_uncertainty_problem(parameters) : std::nullopt;
}

Device::Device(DeviceParameters parameters) : parameters_(std::move(parameters)) {
  if (const auto problem = find_problem(parameters_)) {
    InputProblem told{{}, problem->what, problem->allowed, {}};
    told.problem = problem->problem;
    told.place.key = problem->key;
    throw Error(ErrorCode::invalid_argument, fmt::format("{}: {}; {}", problem->key, problem->what, problem->allowed),
                {std::move(told)});
  }
}

std::size_t Device::body_index(const std::string& name) const {
  const auto& bodies = parameters_.bodies;
  const auto found = std::ranges::find(bodies, name, &Body::name);
  if (found == bodies.end()) throw Error(ErrorCode::no_such_body, fmt::format("the device has no body \"{}\"", name));
  return static_cast<std::size_t>(found - bodies.begin());
}

}  // namespace zwidth
