#pragma once

#include <cstdlib>

namespace zwidth::test {

/// How often one proof is repeated, over seeds or devices: `in_campaign` times where scripts/campaign asks, which sets
/// ZWIDTH_CAMPAIGN, and `in_suite` times else. Whole tests that the suite leaves out are of suites named *Campaign.
template <typename Count>
[[nodiscard]] Count repetitions(Count in_suite, Count in_campaign) {
  return std::getenv("ZWIDTH_CAMPAIGN") != nullptr ? in_campaign : in_suite;
}

}  // namespace zwidth::test
