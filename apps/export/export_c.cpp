#include "export/export_c.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "report/text/explanation.hpp"
#include "report/text/holder_limit_text.hpp"
#include "report/text/quantity.hpp"
#include "report/text/trust_text.hpp"
#include "report/text/wall_filter_text.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/stability/holder_limit.hpp"

namespace zwidth::report {
namespace {

constexpr std::size_t longest_prefix = 20;

bool is_letter(char c) { return c >= 'a' && c <= 'z'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// A double that C reads back exactly, of type double.
std::string literal(double value) {
  const std::string digits = fmt::format("{:.17g}", value);
  return digits.find_first_of(".e") == std::string::npos ? digits + ".0" : digits;
}

/// Text that can neither end a comment nor begin one, nor be a trigraph.
std::string in_comment(std::string text) {
  for (const std::string_view pair : {"*/", "/*", "??"}) {
    for (auto at = text.find(pair); at != std::string::npos; at = text.find(pair, at + 1)) text.insert(at + 1, " ");
  }
  return text;
}

/// K_CR with each holder, a line each.
std::string coded_limit_lines(const HoldingLimits& limits, std::string_view unit) {
  const auto line = [&](Holder holder, const std::string& limit) {
    return fmt::format(" *     {:<18}{}\n", words_of(holder), limit);
  };
  std::string lines = line(Holder::nobody, holder_limit_text(limits.nobody, unit));
  if (limits.user) lines += line(Holder::user, holder_limit_text(*limits.user, unit));
  if (!limits.any_user) return lines + line(Holder::any_user, "not computed");
  return lines + line(Holder::any_user, limits.any_user->critical_stiffness > 0.0
                                            ? holder_limit_text(*limits.any_user, unit)
                                            : std::string("0: some user destabilises every wall"));
}

class CodeWriter {
 public:
  explicit CodeWriter(const CodedWall& coded)
      : coded_(coded),
        device_(coded.wall.device.parameters()),
        wall_(device_.wall),
        units_(units_of(device_.motion)),
        name_(c_identifier(device_.name)) {}

  [[nodiscard]] std::string text() const {
    if (is_apart()) return opening_comment() + apart_declarations() + apart_functions();
    return opening_comment() + declarations() + reset_function() + force_function();
  }

 private:
  [[nodiscard]] bool has_velocity() const { return wall_.damping > 0.0; }
  /// The damper has a loop of its own.
  [[nodiscard]] bool is_apart() const { return has_velocity() && has_damper_loop(device_.loop); }
  [[nodiscard]] bool is_one_sided() const { return coded_.contact == ControllerOptions::Contact::unilateral; }

  [[nodiscard]] std::string opening_comment() const {
    const Analysis& analysis = coded_.wall.analysis;
    std::string text = fmt::format(
        "/* Virtual wall for {}\n"
        " *\n"
        " * Written by zwidth {}. C99, no library needed.\n"
        " *\n"
        " *   stiffness K         {} {} ({})\n"
        " *   damping B           {} {}\n",
        in_comment(display_name(coded_.wall.device)), ZWIDTH_VERSION, *wall_.stiffness, units_.stiffness,
        in_comment(coded_.stiffness_source), wall_.damping, units_.damping);
    if (has_velocity() && wall_.velocity_filter_hz > 0.0) {
      text += fmt::format(" *   velocity low-pass   {} Hz\n", wall_.velocity_filter_hz);
    }
    if (const auto filters = wall_filters_text(wall_)) text += fmt::format(" *   filters             {}\n", *filters);
    if (device_.actuator.force_limit) {
      text += fmt::format(" *   force limit         {} {}\n", *device_.actuator.force_limit, units_.force);
    }
    text += fmt::format(
        " *   contact             {}\n"
        " *   critical stiffness, with this damping and these filters closed:\n"
        "{}"
        " *   this wall is        {}\n"
        " *\n"
        "{}",
        is_one_sided() ? "unilateral: it pushes only, out of position > 0" : "bilateral: a spring on both sides of 0",
        coded_limit_lines(analysis.limits, units_.stiffness), words_of(stability_of(*analysis.wall_stable_for)),
        valid_for());
    if (const auto note = trust_note(analysis.trust)) text += " *\n * " + in_comment(*note) + "\n";
    if (const std::string holders = unstable_with(*analysis.wall_stable_for); !holders.empty()) {
      text += fmt::format(" *\n * WARNING: with this wall the loop is UNSTABLE by linear analysis, {}.\n", holders);
    }
    return text + " */\n\n";
  }

  [[nodiscard]] std::string valid_for() const {
    const Loop& loop = device_.loop;
    if (!is_apart()) {
      return fmt::format(" * Valid for one call per sampling period of {} s, at a delay of {} s besides the hold.\n",
                         loop.sampling_period, loop.delay);
    }
    const auto [period, delay] = damper_timing(loop);
    return fmt::format(
        " * Valid for one call of {0}_spring_step per {1} s, its force there {2} s later, and one of\n"
        " * {0}_damper_step per {3} s, its force there {4} s later, besides the hold of either. Both read\n"
        " * at once wherever the longer period begins. What acts is {0}_wall_sum of the two forces there.\n",
        name_, loop.sampling_period, loop.delay, period, delay);
  }

  [[nodiscard]] std::string apart_declarations() const {
    return fmt::format(
        "typedef struct {{\n"
        "  int started;      /* 0: the next sample is the first */\n"
        "  double previous;  /* position of the last sample, {2} */\n"
        "  double velocity;  /* {2}/s */\n"
        "}} {0}_damper_t;\n\n"
        "/* Forgets the past: before the first sample, and whenever the wall is entered anew. */\n"
        "void {0}_damper_reset({0}_damper_t *damper);\n\n"
        "/* The damper's force, {1}, for its sample's position, {2}; the wall fills position > 0. */\n"
        "double {0}_damper_step({0}_damper_t *damper, double position);\n\n"
        "/* The spring's force, {1}, for its sample's position, {2}. */\n"
        "double {0}_spring_step(double position);\n\n"
        "/* Force to command, {1}, of the forces of both that have arrived; each is 0 before its first. */\n"
        "double {0}_wall_sum(double spring, double damper);\n\n",
        name_, units_.force, units_.length);
  }

  [[nodiscard]] std::string apart_functions() const {
    const double period = damper_timing(device_.loop).sampling_period;
    std::string text = fmt::format(
        "void {0}_damper_reset({0}_damper_t *damper) {{\n"
        "  damper->started = 0;\n  damper->previous = 0.0;\n  damper->velocity = 0.0;\n}}\n\n"
        "double {0}_damper_step({0}_damper_t *damper, double position) {{\n{1}",
        name_, velocity_block("damper", period));
    if (is_one_sided()) text += "  if (!(position > 0.0)) return 0.0; /* outside */\n";
    text += fmt::format("  return -({} * damper->velocity);\n}}\n\n", literal(wall_.damping));
    text += fmt::format("double {}_spring_step(double position) {{\n", name_);
    if (is_one_sided()) text += "  if (!(position > 0.0)) return 0.0; /* outside */\n";
    text += fmt::format("  return -({} * position);\n}}\n\n", literal(*wall_.stiffness));
    text +=
        fmt::format("double {}_wall_sum(double spring, double damper) {{\n  double force = spring + damper;\n", name_);
    if (is_one_sided()) text += "  if (force > 0.0) force = 0.0; /* it would pull */\n";
    return text + force_limit_block() + "  return force;\n}\n";
  }

  [[nodiscard]] std::string declarations() const {
    std::string members = has_velocity() ? fmt::format(
                                               "  int started;      /* 0: the next sample is the first */\n"
                                               "  double previous;  /* position of the last sample, {} */\n"
                                               "  double velocity;  /* {}/s */\n",
                                               units_.length, units_.length)
                                         : "";
    if (!wall_.filters.empty()) {
      members += fmt::format("  double filter[{}][2]; /* of each filter: w and its step to the next sample */\n",
                             wall_.filters.size());
    }
    if (members.empty()) members = "  int unused; /* this wall has no past */\n";
    return fmt::format(
        "typedef struct {{\n{0}}} {1}_wall_t;\n\n"
        "/* Forgets the past: before the first sample, and whenever the wall is entered anew. */\n"
        "void {1}_wall_reset({1}_wall_t *wall);\n\n"
        "/* Force to command, {2}, for this sample's position, {3}; the wall fills position > 0. */\n"
        "double {1}_wall_force({1}_wall_t *wall, double position);\n\n",
        members, name_, units_.force, units_.length);
  }

  [[nodiscard]] std::string reset_function() const {
    std::string body;
    if (has_velocity()) body += "  wall->started = 0;\n  wall->previous = 0.0;\n  wall->velocity = 0.0;\n";
    for (std::size_t i = 0; i < wall_.filters.size(); ++i) {
      body += fmt::format("  wall->filter[{0}][0] = 0.0;\n  wall->filter[{0}][1] = 0.0;\n", i);
    }
    if (body.empty()) body = "  wall->unused = 0;\n";
    return fmt::format("void {0}_wall_reset({0}_wall_t *wall) {{\n{1}}}\n\n", name_, body);
  }

  [[nodiscard]] std::string force_function() const {
    std::string body;
    if (has_velocity()) {
      body += velocity_block("wall", device_.loop.sampling_period);
      body += fmt::format("  force = -({} * position + {} * wall->velocity);\n", literal(*wall_.stiffness),
                          literal(wall_.damping));
    } else {
      body += fmt::format("  force = -({} * position);\n", literal(*wall_.stiffness));
    }
    if (is_one_sided())
      body += "  if (!(position > 0.0 && force < 0.0)) force = 0.0; /* outside, or it would pull */\n";
    for (std::size_t i = 0; i < wall_.filters.size(); ++i) body += filter_block(i);
    if (is_one_sided() && !wall_.filters.empty()) body += "  if (force > 0.0) force = 0.0;\n";
    body += force_limit_block();
    const char* unused = !has_velocity() && wall_.filters.empty() ? "  (void)wall;\n" : "";
    return fmt::format(
        "double {0}_wall_force({0}_wall_t *wall, double position) {{\n  double force;\n{1}{2}  return force;\n}}\n",
        name_, unused, body);
  }

  /// VelocityFilter, in the state of that name.
  [[nodiscard]] std::string velocity_block(std::string_view state, double period) const {
    const double pole = velocity_filter_pole(wall_.velocity_filter_hz, period);
    std::string text = fmt::format("  if (!{0}->started) {0}->previous = position;\n  {0}->started = 1;\n", state);
    const std::string step =
        fmt::format("{} * (position - {}->previous)", literal((1.0 - pole) * (1.0 / period)), state);
    if (pole > 0.0) {
      text += fmt::format("  /* low-pass: (1 - a)/T (1 - z^-1)/(1 - a z^-1), a = {} */\n", literal(pole));
      text += fmt::format("  {0}->velocity = {1} * {0}->velocity + {2};\n", state, literal(pole), step);
    } else {
      text += fmt::format("  {}->velocity = {};\n", state, step);
    }
    return text + fmt::format("  {}->previous = position;\n", state);
  }

  [[nodiscard]] std::string force_limit_block() const {
    if (!device_.actuator.force_limit) return {};
    return fmt::format("  if (force > {0}) force = {0};\n  if (force < -{0}) force = -{0};\n",
                       literal(*device_.actuator.force_limit));
  }

  /// delta^n w = force - d0 w - d1 delta w: RunningFilter.
  [[nodiscard]] std::string filter_block(std::size_t index) const {
    const WallFilter& filter = wall_.filters[index];
    const FilterCoefficients c = in_delta(filter_section(filter, device_.loop.sampling_period));
    const auto n = [&](std::size_t i) { return literal(c.numerator[i]); };
    const auto d = [&](std::size_t i) { return literal(c.denominator[i]); };
    std::string text = fmt::format("  {{ /* {} */\n    double *w = wall->filter[{}];\n", filter_text(filter), index);
    if (c.denominator.size() == 2) {
      text += fmt::format("    const double next = force - {} * w[0];\n", d(0));
      text += fmt::format("    force = {} * w[0] + {} * next;\n", n(0), n(1));
      return text + "    w[0] += next;\n  }\n";
    }
    text += fmt::format("    const double next = force - {} * w[0] - {} * w[1];\n", d(0), d(1));
    text += fmt::format("    force = {} * w[0] + {} * w[1] + {} * next;\n", n(0), n(1), n(2));
    return text + "    w[0] += w[1];\n    w[1] += next;\n  }\n";
  }

  const CodedWall& coded_;
  const DeviceParameters& device_;
  const Wall& wall_;
  Units units_;
  std::string name_;
};

}  // namespace

std::string c_identifier(std::string_view name) {
  std::string identifier;
  for (const char given : name) {
    const char c = given >= 'A' && given <= 'Z' ? static_cast<char>(given - 'A' + 'a') : given;
    if (is_letter(c) || is_digit(c)) {
      identifier += c;
    } else if (!identifier.empty() && identifier.back() != '_') {
      identifier += '_';
    }
  }
  if (!identifier.empty() && is_digit(identifier.front())) identifier.insert(0, "device_");
  identifier.resize(std::min(identifier.size(), longest_prefix));
  while (!identifier.empty() && identifier.back() == '_') identifier.pop_back();
  return identifier.empty() ? "device" : identifier;
}

std::string export_c(const CodedWall& wall) {
  if (!wall.wall.device.parameters().wall.stiffness) {
    throw Error(ErrorCode::invalid_argument, "there is no wall to write: wall.stiffness is missing");
  }
  if (!wall.wall.analysis.wall_stable_for) {
    throw Error(ErrorCode::invalid_argument, "there is no verdict on the wall to write: its analysis is refused");
  }
  return CodeWriter(wall).text();
}

}  // namespace zwidth::report
