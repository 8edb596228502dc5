#include "report/text/trust_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace zwidth::report {

std::string verdict_text(const Trust& trust) {
  if (trust.sound()) return "sound";
  return fmt::format("{}: {}", trust.refused() ? "REFUSED, no number is given" : "DOUBTFUL",
                     fmt::join(trust.reasons, "; "));
}

std::optional<std::string> trust_note(const Trust& trust) {
  return trust.sound() ? std::nullopt : std::optional(verdict_text(trust));
}

}  // namespace zwidth::report
