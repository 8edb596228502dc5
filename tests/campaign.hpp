#pragma once

#include <cstdlib>

namespace zwidth::test {

/// The one of the two that a test needs: over how many seeds and devices it repeats a proof, or how closely it looks.
/// scripts/campaign sets ZWIDTH_CAMPAIGN. Whole tests that the suite leaves out are of suites named *Campaign.
template <typename Choice>
[[nodiscard]] Choice by_tier(Choice in_suite, Choice in_campaign) {
  return std::getenv("ZWIDTH_CAMPAIGN") != nullptr ? in_campaign : in_suite;
}

}  // namespace zwidth::test
