#include "report/page/html_page.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <charconv>
#include <cstdint>
#include <cstdlib>
#include <ctime>
#include <string>

#include "report/text/markup.hpp"

namespace zwidth::report {
namespace {

constexpr std::string_view style = R"(
:root { color-scheme: light dark; --ink: #1a1a1a; --paper: #fff; --quiet: #555; --line: #d4d4d4; --rule: #888;
  --sound: #15803d; --doubtful: #b45309; --refused: #b91c1c; }
@media (prefers-color-scheme: dark) { :root { --ink: #e6e6e6; --paper: #16181b; --quiet: #a8adb3; --line: #3c4148;
  --rule: #7a808a; --sound: #4ade80; --doubtful: #fbbf24; --refused: #f87171; } }
body { font: 16px/1.5 system-ui, -apple-system, "Segoe UI", Roboto, Helvetica, Arial, sans-serif; color: var(--ink);
  background: var(--paper); max-width: 1000px; margin: 0 auto; padding: 1.5rem 1rem 3rem; overflow-wrap: break-word; }
h1 { font-size: 1.7rem; line-height: 1.25; margin: 0 0 1rem; }
h2 { font-size: 1.25rem; margin: 2rem 0 .5rem; }
h3 { font-size: 1.05rem; margin: 1.5rem 0 .5rem; }
sub { line-height: 0; }
p, ul { margin: .5rem 0; }
pre { font-size: .93rem; overflow-x: auto; }
.answer { border: 1px solid var(--line); border-left: 6px solid var(--rule); border-radius: 4px; padding: .8rem 1.2rem;
  margin: 1rem 0; }
.answer.sound { border-left-color: var(--sound); }
.answer.doubtful { border-left-color: var(--doubtful); }
.answer.refused { border-left-color: var(--refused); }
.answer p { margin: .2rem 0; }
.answer td:nth-child(-n+2) { min-width: 8.5rem; }
.holders { display: grid; grid-template-columns: repeat(auto-fit, minmax(11rem, 1fr)); gap: .3rem 1.5rem; margin: .3rem 0 .6rem; }
.holders dt { color: var(--quiet); }
.holders dd, .answer .value { font-size: 1.6rem; font-weight: 600; margin: 0; line-height: 1.2; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; margin: .6rem 0; font-size: .93rem; }
th, td { padding: .3rem .7rem; border-bottom: 1px solid var(--line); text-align: left; vertical-align: top; }
th { border-bottom: 2px solid var(--rule); font-weight: 600; }
.n { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
th.n { white-space: normal; }
.rows th { border-bottom: 1px solid var(--line); white-space: nowrap; }
.reasons td:last-child { min-width: 17rem; }
figure { margin: 1.2rem 0; overflow-x: auto; }
/* Letters of figures must stay legible on a phone: they scroll sideways there. On dark paper light and dark change
   places and colours keep their hue; maps, which are pictures within the figure, stay as they are. */
figure svg { width: 100%; min-width: 620px; height: auto; display: block; background: #fff; border-radius: 4px; }
@media screen and (prefers-color-scheme: dark) {
  figure svg, figure svg image { filter: invert(.91) hue-rotate(180deg); } }
figcaption { font-size: .9rem; color: var(--quiet); margin-top: .3rem; padding-bottom: .3rem; }
.device { border-top: 1px solid var(--line); margin-top: 2.5rem; padding-top: 1rem; }
footer { margin-top: 2.5rem; padding-top: .6rem; border-top: 1px solid var(--line); font-size: .85rem; color: var(--quiet); }
@media (max-width: 480px) { body { padding: 1rem .7rem 2rem; } h1 { font-size: 1.4rem; } pre { font-size: .72rem; } th, td { padding: .3rem .45rem; }
  .answer { padding: .6rem .8rem; } .answer td:nth-child(-n+2) { min-width: 0; } .holders dd, .answer .value { font-size: 1.3rem; } }
@media print { :root { color-scheme: light; --ink: #1a1a1a; --paper: #fff; --quiet: #555; --line: #d4d4d4; }
  figure { overflow: visible; } figure svg { min-width: 0; } body { max-width: none; padding: 0; font-size: 11pt; } figure, table, .answer { break-inside: avoid; }
  h2, h3 { break-after: avoid; } .device { break-before: page; border: 0; } .wide { overflow: visible; } }
@page { margin: 18mm; }
)";

/// https://reproducible-builds.org/specs/source-date-epoch
std::time_t time_of_writing() {
  const char* const given = std::getenv("SOURCE_DATE_EPOCH");  // NOLINT(concurrency-mt-unsafe): nothing here sets it
  std::int64_t seconds = 0;
  const std::string_view text = given == nullptr ? "" : given;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), seconds);
  const bool is_day = !text.empty() && read.ec == std::errc() && seconds >= 0 && seconds < 253402300800;  // year 10000
  return is_day ? static_cast<std::time_t>(seconds) : std::time(nullptr);
}

}  // namespace

std::string html_page(std::string_view title, std::string_view body, std::string_view note) {
  const std::string written = fmt::format("{}{}Written by zwidth {} on {:%Y-%m-%d}.", note, note.empty() ? "" : " ",
                                          ZWIDTH_VERSION, fmt::gmtime(time_of_writing()));
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" "
      "content=\"width=device-width, initial-scale=1\">\n<title>{}</title>\n<style>{}</style>\n</head>\n<body>\n{}\n"
      "<footer>{}</footer>\n</body>\n</html>\n",
      escape_markup(title), style, body, html_text(written));
}

std::string answer_element(Trust::Verdict verdict, std::string_view markup) {
  const std::string_view name = verdict == Trust::Verdict::sound      ? "sound"
                                : verdict == Trust::Verdict::doubtful ? "doubtful"
                                                                      : "refused";
  return fmt::format("<div class=\"answer {}\">\n{}</div>\n", name, markup);
}

std::string html_table(const TextTable& table) {
  std::string text = "<div class=\"wide\"><table>\n";
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const std::string_view cell = i == 0 ? "th" : "td";
    text += i == 0 ? "<thead><tr>" : "<tr>";
    for (std::size_t j = 0; j < table.rows[i].size(); ++j) {
      const std::string_view alignment = table.alignment.at(j) == Align::right ? " class=\"n\"" : "";
      text += fmt::format("<{0}{1}>{2}</{0}>", cell, alignment, html_text(table.rows[i][j]));
    }
    text += i == 0 ? "</tr></thead>\n<tbody>\n" : "</tr>\n";
  }
  return text + "</tbody></table></div>\n";
}

std::string html_rows(std::span<const LabelledText> rows) {
  std::string text = "<div class=\"wide\"><table class=\"rows\">\n<tbody>\n";
  for (const LabelledText& each : rows) {
    text += fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td></tr>\n", html_text(each.label), html_text(each.text));
  }
  return text + "</tbody></table></div>\n";
}

std::string element(std::string_view tag, std::string_view text) {
  return fmt::format("<{0}>{1}</{0}>\n", tag, html_text(text));
}

std::string html_figure(std::string_view svg, std::string_view name, std::string_view caption) {
  return fmt::format("<figure>{}{}</figure>\n", inline_svg(svg, name), element("figcaption", caption));
}

}  // namespace zwidth::report
