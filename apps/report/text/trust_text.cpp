#include "report/text/trust_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "report/text/text_table.hpp"

namespace zwidth::report {

std::string verdict_text(const Trust& trust) {
  if (trust.sound()) return "sound";
  return fmt::format("{}: {}", trust.refused() ? "REFUSED, no number is given" : "DOUBTFUL",
                     fmt::join(trust.reasons, "; "));
}

std::optional<std::string> trust_note(const Trust& trust) {
  return trust.sound() ? std::nullopt : std::optional(verdict_text(trust));
}

std::string_view trust_mark(const Trust& trust) {
  return trust.sound() ? "" : trust.refused() ? " (REFUSED)" : " (DOUBTFUL)";
}

std::string reason_lines(const Trust& trust) {
  std::string text;
  for (const std::string& reason : trust.reasons) text += labelled("  ! ", reason, 4);
  return text;
}

std::string trust_lines(const Trust& trust, std::string_view what) {
  if (trust.sound()) return "";
  return (trust.refused() ? fmt::format("REFUSED: no {} is given, because\n", what)
                          : fmt::format("DOUBTFUL: data and model do not carry the {}, because\n", what)) +
         reason_lines(trust);
}

}  // namespace zwidth::report
