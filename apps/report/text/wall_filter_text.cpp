#include "report/text/wall_filter_text.hpp"

#include <fmt/format.h>

#include "report/text/quantity.hpp"
#include "zwidth/model/damper_timing.hpp"

namespace zwidth::report {

std::string filter_text(const WallFilter& filter) {
  using enum WallFilter::Kind;
  const std::string frequency = quantity(filter.frequency_hz, "Hz");
  const std::string damping = fmt::format(", damping ratio {}", number(filter.damping_ratio));
  switch (filter.kind) {
    case low_pass:
      if (filter.order == 1) return "low-pass " + frequency;
      return "low-pass of second order " + frequency + damping;
    case notch:
      return fmt::format("notch {}, depth {}{}", frequency, number(filter.depth),
                         filter.damping_ratio == WallFilter{}.damping_ratio ? "" : damping);
    case lead_lag:
      return fmt::format("{} {}, ratio {}", filter.ratio >= 1.0 ? "lead" : "lag", frequency, number(filter.ratio));
    case biquad:
      return fmt::format("biquad of order {}", filter.denominator.size() - 1);
    case digital:
      return fmt::format("digital filter of order {}", filter.denominator.size() - 1);
  }
  return "";
}

std::optional<std::string> wall_filters_text(const Wall& wall) {
  if (wall.filters.empty()) return std::nullopt;
  std::string text;
  for (const WallFilter& filter : wall.filters) text += (text.empty() ? "" : "; ") + filter_text(filter);
  return text;
}

std::optional<std::string> damper_apart_text(const Device& device, double damping) {
  if (damping == 0.0 || !has_damper_loop(device.loop())) return std::nullopt;
  const auto [period, delay] = damper_timing(device.loop());
  return fmt::format("{} at {}, delay {}", quantity(damping, units_of(device.parameters().motion).damping),
                     quantity(1.0 / period, "Hz"), quantity(delay, "s"));
}

}  // namespace zwidth::report
