#include "identification/likelihood_fit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "identification/campaign/judge.hpp"
#include "identification/campaign/kinds.hpp"

namespace zwidth {
namespace {

namespace campaign = test::campaign;

class LikelihoodFitOfKind : public testing::TestWithParam<const char*> {};

/// Records that a linear fit answers 15 to 380 % too high: what moves the device beside its linear equations is fitted with it.
TEST_P(LikelihoodFitOfKind, HoldsTheTruthWithinATenth) {
  const auto all = campaign::kinds();
  const auto kind =
      std::ranges::find_if(all, [](const campaign::Kind& each) { return std::string(each.name) == GetParam(); });
  ASSERT_NE(kind, all.end());
  const campaign::Case made = campaign::drawn_case(*kind, 1);
  std::vector<Recording> recordings;
  for (const campaign::Rows& rows : campaign::recorded(made, 0))
    recordings.push_back(campaign::detail::read_back(rows));
  const auto found = internal::fit_by_likelihood(recordings, Device(made.structure),
                                                 {.free = made.free, .locked = made.locked, .known = made.known});
  ASSERT_TRUE(found);
  EXPECT_LE(found->lower, made.stiffness);
  EXPECT_GE(found->upper, made.stiffness);
  EXPECT_GT(found->lower, 0.9 * made.stiffness);
  EXPECT_LT(found->upper, 1.1 * made.stiffness);
}

INSTANTIATE_TEST_SUITE_P(Kinds, LikelihoodFitOfKind,
                         testing::Values("drag_once", "friction_and_drag_chirp", "friction_10_twice", "saturation",
                                         "feedback_and_friction"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace zwidth
