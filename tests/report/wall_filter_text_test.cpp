#include "report/text/wall_filter_text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "export/export_c.hpp"
#include "report/analysis_report.hpp"
#include "report/example_analyses.hpp"
#include "report/figure/device_bode_figure.hpp"
#include "report/text/explanation.hpp"
#include "report/text/region_text.hpp"

namespace zwidth::report {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using enum WallFilter::Kind;

TEST(WallFilterText, SaysWhatEachTypeIs) {
  EXPECT_EQ(filter_text({.kind = low_pass, .frequency_hz = 60.0}), "low-pass 60 Hz");
  EXPECT_EQ(filter_text({.kind = low_pass, .frequency_hz = 1500.0, .order = 2, .damping_ratio = 0.5}),
            "low-pass of second order 1.5 kHz, damping ratio 0.5");
  EXPECT_EQ(filter_text({.kind = notch, .frequency_hz = 60.0}), "notch 60 Hz, depth 0.1");
  EXPECT_EQ(filter_text({.kind = notch, .frequency_hz = 60.0, .damping_ratio = 0.2, .depth = 0.05}),
            "notch 60 Hz, depth 0.05, damping ratio 0.2");
  EXPECT_EQ(filter_text({.kind = lead_lag, .frequency_hz = 30.0, .ratio = 3.0}), "lead 30 Hz, ratio 3");
  EXPECT_EQ(filter_text({.kind = lead_lag, .frequency_hz = 30.0, .ratio = 0.5}), "lag 30 Hz, ratio 0.5");
  EXPECT_EQ(filter_text({.kind = biquad, .numerator = {1.0}, .denominator = {1.0, 2.0, 3.0}}), "biquad of order 2");
  EXPECT_EQ(filter_text({.kind = digital, .numerator = {1.0}, .denominator = {1.0, 0.5}}), "digital filter of order 1");
}

AnalysedDevice filtered_lhifam() {
  DeviceParameters parameters = lhifam_with_wall().device.parameters();
  parameters.wall.filters = {{.kind = notch, .frequency_hz = 84.0}, {.kind = low_pass, .frequency_hz = 200.0}};
  return analysed_device(Device(parameters));
}

constexpr auto filters = "notch 84 Hz, depth 0.1; low-pass 200 Hz";

TEST(WallFilterText, StandsInEveryReport) {
  const AnalysedDevice analysed = filtered_lhifam();
  EXPECT_THAT(analysis_text({&analysed, 1}), HasSubstr(filters));
  EXPECT_THAT(html_report({&analysed, 1}), HasSubstr(filters));
  const BodeFigure figure = device_bode_figure({&analysed, 1});
  EXPECT_THAT(figure.notes, ::testing::Contains(HasSubstr(filters)));
  EXPECT_THAT(figure.curves[0].name, HasSubstr("Through the filters, F Z[H G e^(-t_d s)]"));
  const WallRegion walls = zwidth::region(analysed.device);
  EXPECT_THAT(region_text(analysed.device, walls), HasSubstr(filters));
  EXPECT_THAT(region_text(analysed.device, walls), HasSubstr("filters in the wall"));
  for (const ComparedApproximation& each : walls.approximations) {
    EXPECT_THAT(each.formula.not_met, ::testing::Contains(UnmetAssumption::wall_filters));
  }
  EXPECT_THAT(*what_limits(analysed), HasSubstr("the wall's filters, "));
  const AnalysedDevice bare = lhifam_with_wall();
  EXPECT_THAT(*what_limits(bare), Not(HasSubstr("filters")));
  EXPECT_THAT(analysis_text({&bare, 1}), Not(HasSubstr("Filters")));
}

TEST(ExportC, IdentifiersAreShortAndValid) {
  EXPECT_EQ(c_identifier("LHIfAM, translational axis"), "lhifam_translational");
  EXPECT_EQ(c_identifier("__x--Y!"), "x_y");
  EXPECT_EQ(c_identifier("3DOF"), "device_3dof");
  EXPECT_EQ(c_identifier("日本"), "device");
  EXPECT_EQ(c_identifier(""), "device");
  EXPECT_EQ(c_identifier("0123456789012345678901234"), "device_0123456789012");
  EXPECT_EQ(c_identifier("abcdefghijklmnopqrs tuv"), "abcdefghijklmnopqrs");
}

}  // namespace
}  // namespace zwidth::report
