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
    return opening_comment() + declarations() + reset_function() + force_function();
  }

 private:
  [[nodiscard]] bool has_velocity() const { return wall_.damping > 0.0; }
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
        " * Valid for one call per sampling period of {} s, at a delay of {} s besides the hold.\n",
        is_one_sided() ? "unilateral: it pushes only, out of position > 0" : "bilateral: a spring on both sides of 0",
        coded_limit_lines(analysis.limits, units_.stiffness), words_of(stability_of(*analysis.wall_stable_for)),
        device_.loop.sampling_period, device_.loop.delay);
    if (const auto note = trust_note(analysis.trust)) text += " *\n * " + in_comment(*note) + "\n";
    if (const std::string holders = unstable_with(*analysis.wall_stable_for); !holders.empty()) {
      text += fmt::format(" *\n * WARNING: with this wall the loop is UNSTABLE by linear analysis, {}.\n", holders);
    }
    return text + " */\n\n";
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
      const double period = device_.loop.sampling_period;
      const double pole = velocity_filter_pole(wall_.velocity_filter_hz, period);
      body += "  if (!wall->started) wall->previous = position;\n  wall->started = 1;\n";
      const std::string step = literal((1.0 - pole) * (1.0 / period)) + " * (position - wall->previous)";
      if (pole > 0.0) {
        body += fmt::format("  /* low-pass: (1 - a)/T (1 - z^-1)/(1 - a z^-1), a = {} */\n", literal(pole));
        body += fmt::format("  wall->velocity = {} * wall->velocity + {};\n", literal(pole), step);
      } else {
        body += fmt::format("  wall->velocity = {};\n", step);
      }
      body += "  wall->previous = position;\n";
      body += fmt::format("  force = -({} * position + {} * wall->velocity);\n", literal(*wall_.stiffness),
                          literal(wall_.damping));
    } else {
      body += fmt::format("  force = -({} * position);\n", literal(*wall_.stiffness));
    }
    if (is_one_sided())
      body += "  if (!(position > 0.0 && force < 0.0)) force = 0.0; /* outside, or it would pull */\n";
    for (std::size_t i = 0; i < wall_.filters.size(); ++i) body += filter_block(i);
    if (is_one_sided() && !wall_.filters.empty()) body += "  if (force > 0.0) force = 0.0;\n";
    if (device_.actuator.force_limit) {
      body += fmt::format("  if (force > {0}) force = {0};\n  if (force < -{0}) force = -{0};\n",
                          literal(*device_.actuator.force_limit));
    }
    const char* unused = !has_velocity() && wall_.filters.empty() ? "  (void)wall;\n" : "";
    return fmt::format(
        "double {0}_wall_force({0}_wall_t *wall, double position) {{\n  double force;\n{1}{2}  return force;\n}}\n",
        name_, unused, body);
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
  require_one_rate(wall.wall.device);
  if (!wall.wall.device.parameters().wall.stiffness) {
    throw Error(ErrorCode::invalid_argument, "there is no wall to write: wall.stiffness is missing");
  }
  if (!wall.wall.analysis.wall_stable_for) {
    throw Error(ErrorCode::invalid_argument, "there is no verdict on the wall to write: its analysis is refused");
  }
  return CodeWriter(wall).text();
}

}  // namespace zwidth::report
