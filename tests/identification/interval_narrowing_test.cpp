#include "identification/interval_narrowing.hpp"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "identification/synthetic_response.hpp"
#include "lhifam.hpp"
#include "zwidth/identification/identification.hpp"
#include "zwidth/words/finding_text.hpp"

namespace zwidth {
namespace {

TEST(OpenInterval, IsOneOfMoreThanAFactorOfTwo) {
  EXPECT_FALSE(is_inconclusive(StiffnessInterval{.lower = 100.0, .upper = 200.0}));
  EXPECT_TRUE(is_inconclusive(StiffnessInterval{.lower = 100.0, .upper = 201.0}));
  EXPECT_TRUE(is_inconclusive(StiffnessInterval{.lower = 0.0, .upper = 1.0}));
}

TEST(OpenInterval, IsNamedByItsFactorWhereItHasOne) {
  EXPECT_EQ(text(internal::interval_left_open({.lower = 100.0, .upper = 350.0})),
            "the data leave the critical stiffness open within a factor of 3.5; excite more strongly or for longer");
  EXPECT_EQ(
      text(internal::interval_left_open({.lower = 1e-27, .upper = 350.0})),
      "the data leave the critical stiffness open by more than a factor of 1000; excite more strongly or for longer");
  EXPECT_EQ(text(internal::interval_left_open({.lower = 0.0, .upper = 350.0})),
            "the data leave the critical stiffness open down to 0, where not even the softest wall is stable; "
            "excite more strongly or for longer");
}

// A search that ran away leaves no deviation of any number: the answer was sound, without an interval.
TEST(OpenInterval, WhereThereIsNoneTheAnswerIsDoubtful) {
  const Device device(test::rigid_parameters());
  ExcitationOptions options;
  options.kind = ExcitationKind::noise;
  options.amplitude = 10.0;
  options.lowest_hz = 1.0;
  std::vector<double> force = excite(options).samples;
  std::vector<double> position = test::synthetic_position(device, force, {0.01, 1e-6, 1});
  const Recording recording{"", 1e-3, {{"force", std::move(force)}, {"position", std::move(position)}}, {}};
  Identification found = identify(recording, device);
  ASSERT_TRUE(found.analysis.interval && found.fit.misfit);
  EXPECT_FALSE(internal::doubt_of_interval(found));
  found.analysis.interval.reset();
  EXPECT_TRUE(internal::doubt_of_interval(found));
}

}  // namespace
}  // namespace zwidth
