#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "zwidth/trust.hpp"

namespace zwidth::report {

/// "DOUBTFUL: why; and why", "REFUSED, no number is given: why"; "sound".
[[nodiscard]] std::string verdict_text(const Trust& trust);

/// verdict_text() where there is something to say.
[[nodiscard]] std::optional<std::string> trust_note(const Trust& trust);

/// What stands behind a figure's title: " (DOUBTFUL)", " (REFUSED)", nothing where the answer is sound.
[[nodiscard]] std::string_view trust_mark(const Trust& trust);

/// A line per reason.
[[nodiscard]] std::string reason_lines(const Trust& trust);

/// A heading, which says of what, and a line per reason; empty where the answer is sound.
[[nodiscard]] std::string trust_lines(const Trust& trust, std::string_view what = "critical stiffness");

}  // namespace zwidth::report
