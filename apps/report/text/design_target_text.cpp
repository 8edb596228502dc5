#include <fmt/format.h>

#include <cmath>

#include "report/text/design_text.hpp"
#include "report/text/explanation.hpp"
#include "report/text/quantity.hpp"
#include "report/text/text_table.hpp"
#include "report/text/trust_text.hpp"
#include "zwidth/model/mechanism_key.hpp"
#include "zwidth/remark.hpp"
#include "zwidth/words/finding_text.hpp"

namespace zwidth::report {
namespace {

constexpr std::size_t target_width = 30;

/// The limit's number in words: K, or B of a damper alone.
class LimitWords {
 public:
  LimitWords(WallNumber number, Motion motion) : is_damper_(number == WallNumber::damping), units_(units_of(motion)) {}

  [[nodiscard]] std::string value(double limit) const {
    return is_damper_ ? fmt::format("{} {}", number(limit), units_.damping) : quantity(limit, units_.stiffness);
  }
  [[nodiscard]] std::string limit(const std::optional<double>& limit) const {
    if (!limit) return "refused";
    if (*limit == 0.0) return is_damper_ ? "none: no damper is stable" : "none: no wall is stable from K = 0 on";
    return std::isfinite(*limit) ? value(*limit) : std::string("unbounded");
  }
  [[nodiscard]] std::string asked(const DesignTargetOptions& options, const DesignTargets& targets) const {
    if (!options.times_now) return value(options.stiffness);
    const std::string multiple = fmt::format("{:.4g} times that", *options.times_now);
    return targets.target ? fmt::format("{}, {}", multiple, value(*targets.target)) : multiple;
  }
  [[nodiscard]] std::string any_user(const std::optional<double>& limit) const {
    if (!limit) return "-";
    if (*limit == 0.0) return is_damper_ ? "no damper" : "no wall";
    return std::isfinite(*limit) ? value(*limit) : std::string(is_damper_ ? "any damper" : "any wall");
  }
  [[nodiscard]] std::string_view nobody() const { return is_damper_ ? "critical damping  " : "critical stiffness"; }

 private:
  bool is_damper_;
  Units units_;
};

std::string change_text(const DesignTarget& target) {
  if (!target.value_needed || target.value_now == 0.0) return "";
  return factor_text(*target.value_needed / target.value_now);
}

/// A table of targets and a note on each, under its heading; nothing without any.
class TargetTable {
 public:
  TargetTable(const Device& device, const LimitWords& words, bool judged) : device_(device), words_(words) {
    if (judged) {
      table_ = {{Align::left, Align::right, Align::right, Align::right, Align::right},
                {{"one number alone", "now", "needed", "change", "any passive user then"}}};
    }
  }

  void add(const DesignTarget& each) {
    const std::string key = shortened(each.key, target_width);
    const Motion motion = motion_of_key(device_.parameters(), each.key);
    std::vector<std::string> row{key, parameter_text(each.key, each.value_now, motion),
                                 parameter_text(each.key, *each.value_needed, motion), change_text(each)};
    if (table_.alignment.size() > row.size()) {
      row.push_back(words_.any_user(each.absolute_stability_limit_then));
    }
    table_.rows.push_back(std::move(row));
    notes_ += bulleted(fmt::format("{}: {}", key, text(each.why)));
  }

  [[nodiscard]] std::string under(const std::string& heading) const {
    return table_.rows.size() > 1 ? "\n" + wrap(heading, line_width, 0) + layout(table_) + notes_ : "";
  }

 private:
  const Device& device_;
  const LimitWords& words_;
  TextTable table_{{Align::left, Align::right, Align::right, Align::right},
                   {{"one number alone", "now", "needed", "change"}}};
  std::string notes_;
};

}  // namespace

std::string design_target_text(const Device& device, const DesignTargetOptions& options, const DesignTargets& targets) {
  const Motion motion = device.parameters().motion;
  const LimitWords words(options.limit_of, motion);
  const bool any_user = options.goal == StiffnessGoal::absolute_stability_limit;
  std::string text = shortened(display_name(device), line_width) + "\n";
  if (const auto trust = trust_note(targets.trust)) text += labelled("  trust", *trust);
  text += fmt::format("  {}  {}, asked for {}\n", any_user ? "any passive user  " : words.nobody(),
                      words.limit(targets.limit_now), words.asked(options, targets));
  if (!any_user && targets.absolute_stability_limit_now) {
    text += fmt::format("  any passive user    {}\n", words.limit(targets.absolute_stability_limit_now));
  }
  for (const Remark& remark : targets.remarks) text += bulleted(remark_line(remark));
  TargetTable reaching(device, words, targets.absolute_stability_limit_now.has_value());
  TargetTable lowering(device, words, true);
  std::string without;
  for (const DesignTarget& each : targets.targets) {
    if (each.value_needed) {
      (each.safe.value_or(true) ? reaching : lowering).add(each);
    } else {
      without += bulleted(fmt::format("{}: {}", shortened(each.key, target_width), zwidth::text(each.why)));
    }
  }
  text += reaching.under("What reaches it, the smallest change first; numbers that are 0 now at the end");
  text += lowering.under(
      fmt::format("What reaches it, but lowers the limit with any passive user, now {}, or leaves it unknown",
                  words.limit(targets.absolute_stability_limit_now)));
  if (!without.empty()) text += "\nWhat does not\n" + without;
  if (targets.drive_damper) text += "\nThe damper on the drive\n" + bulleted(zwidth::text(targets.drive_damper->why));
  return text;
}

}  // namespace zwidth::report
