#pragma once

#include <string>

#include "report/document.hpp"
#include "zwidth/simulation/relay.hpp"

namespace zwidth::report {

/// The answer for a reader: every trial, their mean, the predictions, and what it all means for a wall.
[[nodiscard]] std::string relay_text(const RelayResult& result);

/// The same on a page, without its heading.
void add_relay(Document& document, const RelayResult& result);

}  // namespace zwidth::report
