#include "identification/model/row_sums.hpp"

#include <gtest/gtest.h>

namespace zwidth::internal {
namespace {

/// As many rows as a step of six bodies has and more, each by its factor; beyond the width nothing is touched.
TEST(RowSums, AreProducts) {
  constexpr Eigen::Index width = 12;
  for (Eigen::Index count = 0; count <= 21; ++count) {
    const Rows from = Rows::Random(count, width + 3);
    const Eigen::VectorXd by = Eigen::VectorXd::Random(count);
    const Eigen::VectorXd before = Eigen::VectorXd::Random(width + 3);
    Eigen::VectorXd sums = before;
    add_rows(sums.data(), by.data(), count, from.data(), from.cols(), width);
    const Eigen::VectorXd expected = before + from.transpose() * by;
    EXPECT_LT((sums - expected).head(width).cwiseAbs().maxCoeff(), 1e-14) << count;
    EXPECT_EQ(sums.tail(3), before.tail(3)) << count;
  }
  EXPECT_EQ(padded(0), 0);
  EXPECT_EQ(padded(lanes), lanes);
  EXPECT_EQ(padded(lanes + 1), 2 * lanes);
}

}  // namespace
}  // namespace zwidth::internal
