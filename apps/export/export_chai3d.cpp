#include "export/export_chai3d.hpp"

#include <fmt/format.h>

#include <cmath>

#include "report/text/explanation.hpp"
#include "report/text/quantity.hpp"
#include "report/text/trust_text.hpp"
#include "report/text/wall_filter_text.hpp"
#include "zwidth/model/device_user.hpp"
#include "zwidth/stability/holding.hpp"

namespace zwidth::report {
namespace {

constexpr double shown_digits = 4.0;
constexpr double limit_error = 1e-9;  // relative, of the ceilings: 1.9999999999 is 2

double rounded_down(double value) {
  if (!(value > 0.0)) return 0.0;
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - shown_digits + 1.0);
  return unit * std::floor(value / unit * (1.0 + limit_error));
}

/// A reason may hold anything that a device file does.
std::string comment_line(std::string text) {
  for (char& character : text) {
    const auto byte = static_cast<unsigned char>(character);
    if (byte < 0x20 || byte == 0x7f || character == '\\') character = ' ';
  }
  return text;
}

/// As C++ of type double.
std::string rounded_literal(double value) {
  const std::string digits = fmt::format("{:.4g}", value);
  return digits.find_first_of(".e") == std::string::npos ? digits + ".0" : digits;
}

std::string velocity_text(const Wall& wall, Units units) {
  std::string text = fmt::format("Loop taken: damping on the backward difference of the position ({}/s)", units.length);
  if (wall.velocity_filter_hz > 0.0) text += fmt::format(", low-passed at {}", quantity(wall.velocity_filter_hz, "Hz"));
  if (const auto filters = wall_filters_text(wall)) text += "; force through " + *filters;
  return text + ".";
}

/// Whose critical stiffness there is where some user destabilises every wall.
std::string basis_without_users(const Device& device) {
  return fmt::format("the critical stiffness with nobody holding{}: there is no limit for any user",
                     device_has_user(device) ? " and with the file's user, the lesser" : "");
}

std::string interval_text(const SafeWall& ceilings) {
  if (ceilings.uncertainty_share == 1.0) return {};
  return fmt::format("// Both are taken at the lower end of their 95 % intervals, {:.4g} of their value.\n",
                     ceilings.uncertainty_share);
}

std::string doubt_text(const Trust& trust) {
  const auto note = trust_note(trust);
  return note ? "// " + comment_line(*note) + "\n" : std::string();
}

}  // namespace

std::string export_chai3d(const Device& device, const SafeWall& ceilings, double safety_factor) {
  const Units units = units_of(device.parameters().motion);
  const char* kind = device.parameters().motion == Motion::rotary ? "Angular" : "Linear";
  const bool any_user = ceilings.basis == SafeWall::Basis::any_user;
  return fmt::format(
      "// {name}: ceilings by zwidth {version}, safety factor {factor}, loop at {rate} with a delay of {delay}\n"
      "// Stiffness: {factor} of {limit:.4g} {stiffness_unit}, {basis}.\n"
      "// Damping: {factor} of {damping_limit:.4g} {damping_unit}, the least that destabilises some wall up to that "
      "stiffness.\n"
      "// Every wall up to both is {whose}, each alone or both together.\n"
      "// {velocity}\n"
      "{interval}{doubt}"
      "m_specifications.m_max{kind}Stiffness = {stiffness};  // [{stiffness_unit}]\n"
      "m_specifications.m_max{kind}Damping = {damping};  // [{damping_unit}]\n",
      fmt::arg("name", display_name(device)), fmt::arg("version", ZWIDTH_VERSION), fmt::arg("factor", safety_factor),
      fmt::arg("rate", quantity(1.0 / device.loop().sampling_period, "Hz")),
      fmt::arg("delay", quantity(device.loop().delay, "s")), fmt::arg("limit", ceilings.limit),
      fmt::arg("stiffness_unit", units.stiffness), fmt::arg("damping_unit", units.damping),
      fmt::arg("basis", any_user ? std::string("the limit for any passive user") : basis_without_users(device)),
      fmt::arg("damping_limit", ceilings.damping_limit.value_or(ceilings.damping)),
      fmt::arg("whose", words_of(any_user ? WallStability::anyone : WallStability::alone_only)),
      fmt::arg("velocity", velocity_text(device.parameters().wall, units)), fmt::arg("kind", kind),
      fmt::arg("interval", interval_text(ceilings)), fmt::arg("doubt", doubt_text(ceilings.trust)),
      fmt::arg("stiffness", rounded_literal(rounded_down(ceilings.stiffness))),
      fmt::arg("damping", rounded_literal(rounded_down(ceilings.damping))));
}

}  // namespace zwidth::report
