#include "report/page/answer_box.hpp"

#include <fmt/format.h>

#include "report/page/html_page.hpp"
#include "report/text/explanation.hpp"
#include "report/text/limit_rows.hpp"
#include "report/text/markup.hpp"
#include "report/text/quantity.hpp"
#include "report/text/text_table.hpp"
#include "report/text/trust_text.hpp"

namespace zwidth::report {
namespace {

/// The stiffest spring of each holder.
std::string springs(const AnalysedDevice& analysed) {
  const HoldingLimits& limits = analysed.analysis.limits;
  const std::string_view unit = units_of(analysed.device.parameters().motion).stiffness;
  std::string items;
  const auto add = [&](Holder holder, double limit) {
    items += fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", escape_markup(words_of(holder)),
                         escape_markup(limit_value_text(limit, unit)));
  };
  add(Holder::nobody, limits.nobody.critical_stiffness);
  if (limits.user) add(Holder::user, limits.user->critical_stiffness);
  if (limits.any_user) add(Holder::any_user, limits.any_user->critical_stiffness);
  return element("p", "Stiffest stable spring") + "<dl class=\"holders\">\n" + items + "</dl>\n";
}

/// The rows without the commands that tell more: the page has it.
std::string limit_table(const AnalysedDevice& analysed) {
  TextTable table{{Align::left, Align::left, Align::left}, {{"wall", "who holds", "stable"}}};
  for (const LimitRow& row : limit_rows(analysed)) table.rows.push_back({row.what, row.holder, row.answer});
  return table.rows.size() > 1 ? html_table(table) : "";
}

}  // namespace

std::string answer_box(const AnalysedDevice& analysed) {
  const Trust& trust = analysed.analysis.trust;
  std::string text = element("p", trust_note(trust).value_or("sound"));
  if (!trust.refused()) text += springs(analysed) + limit_table(analysed);
  if (const auto interval = interval_note(analysed)) text += element("p", "95 % interval: " + *interval + ".");
  return answer_element(trust.verdict, text);
}

}  // namespace zwidth::report
