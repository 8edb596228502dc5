#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

#include "report/text/design_text.hpp"
#include "report/text/explanation.hpp"
#include "report/text/quantity.hpp"
#include "report/text/text_table.hpp"
#include "report/text/trust_text.hpp"
#include "zwidth/model/mechanism_key.hpp"

namespace zwidth::report {
namespace {

constexpr std::size_t most_rows = 25;

std::string status_text(const SweepPoint& point, std::string_view unit) {
  return point.status == StiffnessStatus::none_stable ? "none stable" : limit_value_text(point.stiffness, unit);
}

class SweepWriter {
 public:
  SweepWriter(const Device& device, const ParameterSweep& sweep)
      : device_(device), sweep_(sweep), motion_(device.parameters().motion), unit_(units_of(motion_).stiffness) {}

  [[nodiscard]] std::string text() const {
    const std::string title = shortened(display_name(device_), line_width) + "\n";
    if (sweep_.trust.refused()) return title + trust_lines(sweep_.trust);
    return title + trust_lines(sweep_.trust) + (sweep_.axes.size() == 1 ? rows() : extremes());
  }

 private:
  [[nodiscard]] std::string value_text(std::size_t axis, double value) const {
    const std::string& key = sweep_.axes[axis].key;
    return parameter_text(key, value, motion_of_key(device_.parameters(), key));
  }

  [[nodiscard]] std::string rows() const {
    TextTable table{{Align::right, Align::right, Align::right, Align::left},
                    {{sweep_.axes[0].key, "K_CR", "oscillates at", "limited by"}}};
    if (sweep_.has_any_user) {
      table.alignment.push_back(Align::right);
      table.rows[0].emplace_back("any user");
    }
    const std::size_t count = sweep_.points.size();
    const std::size_t stride = (count - 1 + most_rows - 2) / (most_rows - 1);
    for (std::size_t i = 0;; i = std::min(i + stride, count - 1)) {
      const SweepPoint& point = sweep_.points[i];
      std::vector<std::string> cells = {value_text(0, sweep_.values[0][i]), status_text(point, unit_),
                                        point.limit ? quantity(hertz(point.limit->frequency), "Hz") : "-",
                                        point.limit ? short_name(point.limit->limited_by) : "-"};
      if (sweep_.has_any_user)
        cells.push_back(point.any_user ? limit_value_text(point.any_user->stiffness, unit_) : "-");
      table.rows.push_back(std::move(cells));
      if (i + 1 == count) break;
    }
    const std::size_t shown = table.rows.size() - 1;
    const std::string thinned =
        shown < count ? fmt::format("  {} of {} points; --output FILE.csv or --json gives all\n", shown, count) : "";
    return layout(table) + thinned;
  }

  [[nodiscard]] std::string place(std::size_t index) const {
    const std::size_t columns = sweep_.values[1].size();
    return fmt::format("{} = {}, {} = {}", sweep_.axes[0].key, value_text(0, sweep_.values[0][index / columns]),
                       sweep_.axes[1].key, value_text(1, sweep_.values[1][index % columns]));
  }

  [[nodiscard]] std::string extremes() const {
    std::optional<std::size_t> least;
    std::optional<std::size_t> most;
    std::size_t none = 0;
    std::size_t unbounded = 0;
    std::size_t refused = 0;
    for (std::size_t i = 0; i < sweep_.points.size(); ++i) {
      const SweepPoint& point = sweep_.points[i];
      none += point.status == StiffnessStatus::none_stable ? 1U : 0U;
      unbounded += point.status == StiffnessStatus::unbounded ? 1U : 0U;
      refused += point.status == StiffnessStatus::refused ? 1U : 0U;
      if (!point.limit) continue;
      if (!least || point.stiffness < sweep_.points[*least].stiffness) least = i;
      if (!most || point.stiffness > sweep_.points[*most].stiffness) most = i;
    }
    std::string text = fmt::format("  {} x {} points\n", sweep_.values[0].size(), sweep_.values[1].size());
    if (most) {
      text += wrap(fmt::format("largest K_CR {} at {}", quantity(sweep_.points[*most].stiffness, unit_), place(*most)),
                   line_width, 2);
      text += wrap(fmt::format("least K_CR {} at {}", quantity(sweep_.points[*least].stiffness, unit_), place(*least)),
                   line_width, 2);
    }
    if (none > 0) text += fmt::format("  no wall is stable from K = 0 at {} points\n", none);
    if (unbounded > 0) text += fmt::format("  every wall is stable at {} points\n", unbounded);
    if (refused > 0) text += fmt::format("  no answer is given at {} points\n", refused);
    return text + "  --output FILE.csv or --json gives all points, FILE.svg a map\n";
  }

  const Device& device_;
  const ParameterSweep& sweep_;
  Motion motion_;
  std::string_view unit_;
};

}  // namespace

std::string sweep_text(const Device& device, const ParameterSweep& sweep) { return SweepWriter(device, sweep).text(); }

}  // namespace zwidth::report
