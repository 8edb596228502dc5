#include "report/text/design_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "report/text/explanation.hpp"
#include "report/text/quantity.hpp"
#include "report/text/text_table.hpp"
#include "report/text/trust_text.hpp"
#include "zwidth/model/mechanism_key.hpp"

namespace zwidth::report {
namespace {

constexpr double typical_change = 10.0;  // %
constexpr double negligible = 5e-6;      // relative slope: shown as 0.0000 %
constexpr double nothing = 1e-14;        // of K_CR per unit: rounding
constexpr std::size_t key_width = 40;

class DesignWriter {
 public:
  DesignWriter(const Device& device, const Design& design)
      : design_(design), analysed_{device, design.analysis}, device_(device), motion_(device.parameters().motion) {}

  [[nodiscard]] std::string text() const {
    const CriticalStiffness& critical = design_.analysis.critical;
    const auto trust = trust_note(design_.analysis.trust);
    std::string text = shortened(display_name(device_), line_width) + "\n" +
                       (trust ? labelled("  trust", *trust) : "") +
                       labelled("  critical stiffness", critical_stiffness_text(critical, motion_));
    if (const auto limit = what_limits(analysed_)) text += labelled("  limited by", *limit);
    if (const auto limit = absolute_stability_note(analysed_)) text += labelled("  any passive user", *limit);
    text += "\n";
    if (design_.sensitivities.empty() && design_.absolute_stability_sensitivities.empty()) {
      return text + "No sensitivities: there is no limit that a parameter could move.\n";
    }
    text += relative_table();
    text += unit_table();
    return text + switch_notes() + "\n" +
           wrap(
               "Slopes at the device as it is: a change of 10 % follows them nearly, a larger one less and less. What "
               "it "
               "really gives: zwidth design FILE --sweep KEY=FIRST:LAST:COUNT",
               line_width, 0);
  }

 private:
  static std::string percent(const Sensitivity* sensitivity) {
    if (sensitivity == nullptr || !sensitivity->relative) return "-";
    const double value = typical_change * *sensitivity->relative;
    return std::abs(*sensitivity->relative) < negligible ? "0 %" : fmt::format("{:+.3g} %", value);
  }

  /// Keys of both lists, in the order of the file.
  [[nodiscard]] std::vector<const Sensitivity*> all() const {
    std::vector<const Sensitivity*> result;
    for (const Sensitivity& each : design_.sensitivities) result.push_back(&each);
    for (const Sensitivity& each : design_.absolute_stability_sensitivities) {
      if (find_sensitivity(design_.sensitivities, each.key) == nullptr) result.push_back(&each);
    }
    return result;
  }

  [[nodiscard]] std::string relative_table() const {
    std::vector<const Sensitivity*> rows = all();
    std::erase_if(rows, [](const Sensitivity* each) { return !each->relative; });
    std::ranges::stable_sort(rows, [](const Sensitivity* a, const Sensitivity* b) {
      return std::abs(*a->relative) > std::abs(*b->relative);
    });
    TextTable table{{Align::left, Align::right, Align::right, Align::right},
                    {{fmt::format("+{:.0f} % of", typical_change), "now", "critical stiffness", "any passive user"}}};
    for (const Sensitivity* each : rows) {
      table.rows.push_back({shortened(each->key, key_width),
                            parameter_text(each->key, each->value, motion_of(each->key)),
                            percent(find_sensitivity(design_.sensitivities, each->key)),
                            percent(find_sensitivity(design_.absolute_stability_sensitivities, each->key))});
    }
    if (design_.absolute_stability_sensitivities.empty()) drop_last_column(table);
    return fmt::format("What +{:.0f} % of each number gives, the strongest first\n", typical_change) + layout(table);
  }

  /// `heading` stands over the keys. Nothing where there are none.
  template <typename Row>
  [[nodiscard]] std::string slope_table(const std::string& title, const std::string& heading, const Row& is_row) const {
    const std::string_view stiffness = units_of(motion_).stiffness;
    TextTable table{{Align::left, Align::right, Align::right, Align::left},
                    {{heading, "critical stiffness", "any passive user", ""}}};
    const auto cell = [&](const Sensitivity* each) {
      if (each == nullptr) return std::string("-");
      return std::abs(each->slope) <= nothing * design_.analysis.critical.stiffness
                 ? "0"
                 : fmt::format("{:+.3g}", each->slope);
    };
    for (const Sensitivity* each : all()) {
      if (each->relative || !is_row(*each)) continue;
      const std::string unit = parameter_unit(each->key, motion_of(each->key));
      table.rows.push_back({shortened(each->key, key_width), cell(find_sensitivity(design_.sensitivities, each->key)),
                            cell(find_sensitivity(design_.absolute_stability_sensitivities, each->key)),
                            fmt::format("{} per {}", stiffness, unit.empty() ? "1" : unit)});
    }
    if (table.rows.size() < 2) return {};
    return "\n" + title + "\n" + layout(table);
  }

  [[nodiscard]] std::string unit_table() const {
    const auto is_of_joint = [](const Sensitivity& each) { return is_key_of_pose(each.key); };
    return slope_table("Joints of the pose, per unit", "joint", is_of_joint) +
           slope_table("Numbers that are 0 now, per unit", "now 0; its first", std::not_fn(is_of_joint));
  }

  static void drop_last_column(TextTable& table) {
    table.alignment.pop_back();
    for (auto& row : table.rows) row.pop_back();
  }

  [[nodiscard]] std::string mechanism(const Crossover& crossover) const {
    return fmt::format("{} at {}", long_name(crossover.limited_by), quantity(hertz(crossover.frequency), "Hz"));
  }

  [[nodiscard]] std::string switch_note(const BranchSwitch& each) const {
    const Sensitivity* sensitivity = find_sensitivity(design_.sensitivities, each.key);
    const bool grows = sensitivity == nullptr || each.value > sensitivity->value;
    std::string note = fmt::format("{} {} {}: ", each.key, grows ? "above" : "below",
                                   parameter_text(each.key, each.value, motion_of(each.key)));
    if (!each.beyond) {
      return note + (each.stiffness_beyond > 0.0 ? "every wall is stable" : "no wall is stable from K = 0");
    }
    note += fmt::format("limited by {}, before by {}; ", mechanism(*each.beyond), mechanism(each.before));
    const std::string_view unit = units_of(motion_).stiffness;
    const bool jumps = std::abs(each.stiffness_beyond - each.stiffness) > 1e-4 * each.stiffness;
    return note + (jumps ? fmt::format("K_CR jumps from {} to {}", quantity(each.stiffness, unit),
                                       quantity(each.stiffness_beyond, unit))
                         : fmt::format("K_CR is {} there", quantity(each.stiffness, unit)));
  }

  [[nodiscard]] std::string switch_notes() const {
    if (!design_.branch_switches) {
      return fmt::format("\nWhere another crossover takes over is not searched with more than {} bodies\n",
                         most_bodies_for_branch_switches);
    }
    if (design_.branch_switches->empty()) return {};
    std::string text = "\nWhere another crossover takes over, and the slope above ends\n";
    for (const BranchSwitch& each : *design_.branch_switches) text += bulleted(switch_note(each));
    return text;
  }

  [[nodiscard]] Motion motion_of(const std::string& key) const { return motion_of_key(device_.parameters(), key); }

  const Design& design_;
  AnalysedDevice analysed_;
  const Device& device_;
  Motion motion_;
};

}  // namespace

std::string design_text(const Device& device, const Design& design) { return DesignWriter(device, design).text(); }

}  // namespace zwidth::report
