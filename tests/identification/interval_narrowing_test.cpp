#include "identification/interval_narrowing.hpp"

#include <gtest/gtest.h>

namespace zwidth {
namespace {

TEST(OpenInterval, IsOneOfMoreThanAFactorOfTwo) {
  EXPECT_FALSE(is_open(StiffnessInterval{.lower = 100.0, .upper = 200.0}));
  EXPECT_TRUE(is_open(StiffnessInterval{.lower = 100.0, .upper = 201.0}));
  EXPECT_TRUE(is_open(StiffnessInterval{.lower = 0.0, .upper = 1.0}));
}

TEST(OpenInterval, IsNamedByItsFactorWhereItHasOne) {
  EXPECT_EQ(internal::open_interval_reason({.lower = 100.0, .upper = 350.0}),
            "the data leave the critical stiffness open within a factor of 3.5; excite more strongly or for longer");
  EXPECT_EQ(internal::open_interval_reason({.lower = 0.0, .upper = 350.0}),
            "the data leave the critical stiffness open down to 0, where not even the softest wall is stable; "
            "excite more strongly or for longer");
}

}  // namespace
}  // namespace zwidth
