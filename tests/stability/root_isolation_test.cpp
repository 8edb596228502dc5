#include "stability/roots/root_isolation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace zwidth {
using namespace internal;
namespace {

// prod (x - root)^power, x = |z - 1|² = 4 sin²(angle/2), by known roots in x.
struct KnownRoots {
  std::vector<double> roots;
  double scale = 1.0;

  [[nodiscard]] double value(double angle) const {
    const double half = std::sin(angle / 2.0);
    return product(4.0 * half * half);
  }
  template <typename Scalar>
  [[nodiscard]] BoundedJet<Scalar> model(double begin, double end) const {
    return product(circle_interval<Scalar>(begin, end).chord_squared);
  }

 private:
  template <typename Real>
  [[nodiscard]] Real product(const Real& x) const {
    Real p(scale);
    for (const double root : roots) p = p * (x + -root);
    return p;
  }
};

// (x - 1)² + gap.
struct NearTouch {
  double gap;
  [[nodiscard]] double value(double angle) const {
    const double half = std::sin(angle / 2.0);
    const double x = 4.0 * half * half - 1.0;
    return x * x + gap;
  }
  template <typename Scalar>
  [[nodiscard]] BoundedJet<Scalar> model(double begin, double end) const {
    return square(circle_interval<Scalar>(begin, end).chord_squared + -1.0) + gap;
  }
};

// Bounds that never settle.
struct Undecidable {
  [[nodiscard]] double value(double) const { return 1.0; }
  template <typename Scalar>
  [[nodiscard]] BoundedJet<Scalar> model(double begin, double end) const {
    return {Scalar(0.0), Scalar(0.0), begin < end ? 1.0 : 0.0, 0.0};
  }
};

std::vector<double> angles(const std::vector<CircleRoot>& roots) {
  std::vector<double> result;
  for (const CircleRoot& root : roots) result.push_back(root.angle);
  return result;
}

void expect_roots(const KnownRoots& f, double tolerance) {
  for (const std::size_t pieces : {1U, 3U, 10U}) {
    const std::vector<CircleRoot> found = roots_on_circle(f, pieces);
    ASSERT_EQ(found.size(), f.roots.size()) << testing::PrintToString(angles(found));
    int direction = f.roots.size() % 2 == 0 ? -1 : 1;  // f > 0 to the right of all
    if (f.scale < 0.0) direction = -direction;
    for (std::size_t i = 0; i < found.size(); ++i) {
      const double exact = angle_of(f.roots[i]);
      EXPECT_NEAR(found[i].angle / exact, 1.0, tolerance);
      EXPECT_EQ(found[i].direction, direction) << "root " << i;
      direction = -direction;
    }
  }
}

TEST(RootsOnCircle, None) {
  EXPECT_TRUE(roots_on_circle(KnownRoots{{}}, 1).empty());
  EXPECT_TRUE(roots_on_circle(KnownRoots{{-1e-9, 4.0 + 1e-9}}, 1).empty());
}

TEST(RootsOnCircle, SimpleOnes) {
  expect_roots({{1.0}}, 1e-15);
  expect_roots({{0.3, 2.2, 3.1}, 1.0}, 1e-14);
  expect_roots({{0.3, 2.2, 3.1}, -1e-40}, 1e-14);
}

TEST(RootsOnCircle, NearZeroAndNearPi) {
  expect_roots({{1e-14, 1e-12, 1e-9, 1.0}}, 1e-13);
  expect_roots({{1e-20}}, 1e-13);
  expect_roots({{1e-16, 4.0 - 1e-9, 4.0 - 1e-12}}, 1e-13);
}

TEST(RootsOnCircle, Clusters) {
  expect_roots({{1.0, 1.0 + 1e-7}}, 1e-9);
  // Closer together, three roots are one to double-double rounding.
  expect_roots({{1.0, 1.0 + 1e-7, 1.0 + 2e-7}}, 1e-10);
  expect_roots({{0.5, 0.500001, 0.500002, 0.500003, 3.0}}, 1e-9);
}

// Touching without a change of sign: one root of direction 0, to the square root of the rounding.
TEST(RootsOnCircle, DoubleRootIsATouch) {
  for (const double x : {1e-6, 0.7, 2.0, 3.999}) {
    const auto found = roots_on_circle(KnownRoots{{x, x}}, 1);
    ASSERT_EQ(found.size(), 1U) << x;
    EXPECT_NEAR(found[0].angle / angle_of(x), 1.0, 1e-7);
    EXPECT_EQ(found[0].direction, 0);
  }
  const auto triple = roots_on_circle(KnownRoots{{1.3, 1.3, 1.3}}, 1);
  ASSERT_EQ(triple.size(), 1U);
  EXPECT_NEAR(triple[0].angle, angle_of(1.3), 1e-4);
  EXPECT_EQ(triple[0].direction, 1);
}

// Nearly touching from one side: no root, and no false one.
TEST(RootsOnCircle, NearTouchIsNone) {
  for (const double gap : {1e-3, 1e-8, 1e-14, 1e-20}) EXPECT_TRUE(roots_on_circle(NearTouch{gap}, 1).empty()) << gap;
}

TEST(RootsOnCircle, AngleOfTheChord) {
  for (const double angle : {1e-8, 0.1, 1.0, 2.0, 3.0, 3.14159}) {
    const double half = std::sin(angle / 2.0);
    EXPECT_NEAR(angle_of(4.0 * half * half) / angle, 1.0, 1e-9);
  }
  EXPECT_EQ(angle_of(4.0), std::numbers::pi);
  EXPECT_EQ(angle_of(0.0), 0.0);
}

// A model that never decides must end in an error, not in a hang.
TEST(RootsOnCircle, UndecidableFunctionHitsTheCap) {
  try {
    (void)roots_on_circle(Undecidable{}, 1);
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::did_not_converge);
  }
}

}  // namespace
}  // namespace zwidth
