#include "identification/model/presliding_step.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "identification/model/friction_step.hpp"

namespace zwidth::internal {
namespace {

/// A body of 0.2 on friction of 0.05 and a spring of 0.05 / 2e-3 until it slides, pushed with 0.045 to and fro: it bends and
/// slides as Dahl's law says. A midpoint integration with steps of 1 us is the judge.
TEST(PreslidingStep, FrictionBendsBeforeItSlides) {
  constexpr double limit = 0.05;
  constexpr double length = 2e-3;
  constexpr double mass = 0.2;
  constexpr double duration = 2.5e-4;
  constexpr double push = 0.045;
  double velocity = 0.0;
  double bend = 0.0;
  double exact_velocity = 0.0;
  double exact_bend = 0.0;
  double largest = 0.0;
  double furthest = 0.0;
  for (int step = 0; step < 4000; ++step) {
    const double force = step < 2000 ? push : -push;
    const PreslidingStep next =
        presliding_step(velocity, velocity + force * duration / mass, limit, duration / mass, bend, length, duration);
    velocity = next.velocity.value;
    bend = next.bend.value;
    constexpr int fine = 250;
    constexpr double h = duration / fine;
    for (int i = 0; i < fine; ++i) {
      const auto change = [&](double v, double z) {
        return std::pair((force - limit * z) / mass, (v - std::abs(v) * z) / length);
      };
      const auto [a1, b1] = change(exact_velocity, exact_bend);
      const auto [a2, b2] = change(exact_velocity + 0.5 * h * a1, exact_bend + 0.5 * h * b1);
      exact_velocity += h * a2;
      exact_bend += h * b2;
    }
    largest = std::max(largest, std::abs(exact_velocity));
    furthest = std::max(furthest, std::abs(velocity - exact_velocity));
  }
  EXPECT_GT(largest, 1e-3);
  EXPECT_LT(furthest, 1e-3 * largest);
}

/// With a presliding length far below all motion it is Coulomb's friction, and slides for ever.
TEST(PreslidingStep, ShortPreslidingIsCoulombs) {
  constexpr double limit = 0.3;
  constexpr double compliance = 1e-3;
  constexpr double duration = 1e-3;
  constexpr double length = 1e-12;
  const auto last = [&](double before, double free, double bend) {
    return presliding_step(before, free, limit, compliance, bend, length, duration).velocity.value;
  };
  EXPECT_NEAR(last(0.01, 0.012, 1.0), friction_step(0.01, 0.012, limit, compliance).velocity, 1e-9);
  EXPECT_NEAR(last(-0.01, -0.012, -1.0), friction_step(-0.01, -0.012, limit, compliance).velocity, 1e-9);
  EXPECT_NEAR(last(0.0, 0.0002, 0.5), 0.0, 1e-8);
  EXPECT_NEAR(last(0.0001, 0.0002, 1.0), 0.0, 1e-8);
  // it turns round within the step: a part of eight is the error
  EXPECT_NEAR(last(0.0001, -0.0009, 1.0), friction_step(0.0001, -0.0009, limit, compliance).velocity,
              2.0 * limit * compliance / 8.0);
}

TEST(PreslidingStep, SlopesOfPreslidingAreDifferences) {
  struct Case {
    double before, free, bend;
  };
  for (const Case& each : {Case{0.02, 0.025, 0.3}, Case{0.02, 0.025, -0.9}, Case{-0.01, 0.012, -0.7},
                           Case{0.0004, -0.0007, 0.98}, Case{-0.02, -0.021, -1.0}}) {
    std::array<double, 6> at = {each.before, each.free, 0.3, 1e-3, each.bend, 2e-5};
    const auto step = [](const std::array<double, 6>& p) {
      return presliding_step(p[0], p[1], p[2], p[3], p[4], p[5], 1e-3);
    };
    const PreslidingStep here = step(at);
    const auto slopes = [](const PreslidingStep::End& end) {
      return std::array{end.by_before, end.by_free, end.by_limit, end.by_compliance, end.by_bend, end.by_length};
    };
    for (std::size_t i = 0; i < at.size(); ++i) {
      if (std::abs(each.bend) == 1.0 && i == 4) continue;  // the bound
      const double by = 1e-6 * std::abs(at[i]);
      std::array<double, 6> above = at;
      std::array<double, 6> below = at;
      above[i] += by;
      below[i] -= by;
      const PreslidingStep high = step(above);
      const PreslidingStep low = step(below);
      const double velocity = (high.velocity.value - low.velocity.value) / (2.0 * by);
      const double bend = (high.bend.value - low.bend.value) / (2.0 * by);
      EXPECT_NEAR(slopes(here.velocity)[i], velocity, 1e-5 * (std::abs(velocity) + 1e-5 / std::abs(at[i]))) << i;
      EXPECT_NEAR(slopes(here.bend)[i], bend, 1e-5 * (std::abs(bend) + 1e-2 / std::abs(at[i]))) << i;
    }
  }
}

}  // namespace
}  // namespace zwidth::internal
