// What a column's name says of its unit: 1000 times too high and sure of it where it was not understood.
#include "io/column_unit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <numbers>
#include <span>
#include <string>

#include "zwidth/identification/identification.hpp"

namespace zwidth::internal {
namespace {

using enum StatedQuantity;

struct Named {
  const char* name;
  StatedQuantity quantity;
  double factor;
};

constexpr double degree = std::numbers::pi / 180.0;
constexpr double ounce_inch = 0.27801385095378125 * 0.0254;

TEST(ColumnUnit, OfForces) {
  for (const Named& each : {Named{"F [N]", force, 1.0},
                            Named{"force (in mN)", force, 1e-3},
                            Named{"force (mN) cmd", force, 1e-3},
                            Named{"force/mN", force, 1e-3},
                            Named{"force:mN", force, 1e-3},
                            Named{"mN", force, 1e-3},
                            Named{"f_uN", force, 1e-6},
                            Named{"f_gf", force, 0.00980665},
                            Named{"f_kgf", force, 9.80665},
                            Named{"f_lbf", force, 4.4482216152605},
                            Named{"torque_Nmm", force, 1e-3},
                            Named{"torque_N_mm", force, 1e-3},
                            Named{"torque [N mm]", force, 1e-3},
                            Named{"torque [mN*m]", force, 1e-3},
                            Named{"torque [mN.m]", force, 1e-3},
                            Named{"torque [Ncm]", force, 1e-2},
                            Named{"torque_ozin", force, ounce_inch},
                            Named{"torque [oz-in]", force, ounce_inch},
                            Named{"torque_lbft", force, 4.4482216152605 * 0.3048},
                            Named{"torque_mN_m", force, 1e-3},
                            Named{"torque_mN.m", force, 1e-3},
                            Named{"torque mN*m", force, 1e-3},
                            Named{"torque {mN m}", force, 1e-3},
                            Named{"torque_ozf_in", force, ounce_inch},
                            Named{"torque_lbf_ft", force, 4.4482216152605 * 0.3048},
                            Named{"f_cmd (milli-newton)", force, 1e-3},

                            Named{"torque_nm", force, 1.0}}) {
    const ColumnUnit unit = unit_of_column(each.name);
    EXPECT_EQ(unit.quantity, each.quantity) << each.name;
    EXPECT_NEAR(unit.factor, each.factor, 1e-12 * each.factor) << each.name;
  }
}

TEST(ColumnUnit, OfMotions) {
  for (const Named& each :
       {Named{"x [mm]", position, 1e-3}, Named{"x_mm", position, 1e-3}, Named{"x_\u00b5m", position, 1e-6},
        Named{"x (micron)", position, 1e-6}, Named{"x (inch)", position, 0.0254}, Named{"x [in]", position, 0.0254},
        Named{"x_mils", position, 0.0254e-3}, Named{"x (millimeters)", position, 1e-3}, Named{"x_nm", position, 1e-9},
        Named{"angle_deg", position, degree}, Named{"angle_\u00b0", position, degree},
        Named{"angle_arcmin", position, degree / 60.0}, Named{"angle_urad", position, 1e-6},
        Named{"speed_m/s", velocity, 1.0}, Named{"speed_rpm", velocity, 6.0 * degree},
        Named{"a [m/s^2]", acceleration, 1.0}, Named{"a_mm/s2", acceleration, 1e-3}}) {
    const ColumnUnit unit = unit_of_column(each.name);
    EXPECT_EQ(unit.quantity, each.quantity) << each.name;
    EXPECT_NEAR(unit.factor, each.factor, 1e-12 * each.factor) << each.name;
  }
}

TEST(ColumnUnit, OfWhatIsNoForceOrMotion) {
  for (const char* name : {"current_A", "cmd [V]", "force_counts", "force [degC]", "force_lb", "force [oz]",
                           "force [kg]", "a [g]", "x_mm_rel", "pos_deg_filtered", "force [N", "angle_rot", "f_dyn",
                           "x_ticks", "x [counts]", "pwm_%", "force [quark]", "i_mA"}) {
    EXPECT_EQ(unit_of_column(name).quantity, other) << name;
    EXPECT_FALSE(unit_of_column(name).text.empty()) << name;
  }
}

TEST(ColumnUnit, NothingForSure) {
  for (const char* name : {"force", "force_in", "x_m", "channel_A", "F_g", "force (filtered)", "q[0]", "x(1,2)", "1",
                           "", "position_motor", "[", "]x[", "()", "force (", "u_min", "torque_ref"}) {
    EXPECT_EQ(unit_of_column(name).quantity, nothing) << name;
  }
}

TEST(ColumnUnit, ThatIsNotUnderstoodIsDoubtful) {
  // whatever else is said of a few samples
  const auto doubted = [](StatedQuantity of_force, StatedQuantity of_motion, bool doubts_rate = false) {
    Recording recording{"", 1e-3, {{"force", {}}, {"position", {}}}, {}};
    recording.channels[0].quantity = of_force;
    recording.channels[1].quantity = of_motion;
    if (doubts_rate)
      recording.doubts.push_back({.code = FindingCode::stated, .subjects = {{"reason", "the rate by its name"}}});
    for (std::size_t k = 0; k < 4096; ++k) {
      const double sign = (k / 7 + k * k / 50) % 2 == 0 ? 1.0 : -1.0;
      const double last =
          k < 2 ? 0.0 : 2.0 * recording.channels[1].samples[k - 1] - recording.channels[1].samples[k - 2];
      recording.channels[1].samples.push_back(0.999 * last + 1e-7 * sign);
      recording.channels[0].samples.push_back(sign);
    }
    const MeasuredResponse measured = frequency_response(std::span(&recording, 1), {});
    return std::ranges::any_of(measured.trust.reasons,
                               [](const std::string& each) { return each.find("by its name") != std::string::npos; });
  };
  EXPECT_FALSE(doubted(nothing, nothing));
  EXPECT_FALSE(doubted(force, position));
  EXPECT_TRUE(doubted(other, position));
  EXPECT_TRUE(doubted(force, velocity));
  EXPECT_TRUE(doubted(position, force));
  EXPECT_TRUE(doubted(nothing, nothing, true));  // what was doubted as the file was read
}

}  // namespace
}  // namespace zwidth::internal
