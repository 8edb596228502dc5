// What the reports make of the interval of the critical stiffness.
#include <gmock/gmock.h>

#include <limits>

#include "lhifam.hpp"
#include "report/analysis_report.hpp"
#include "report/example_analyses.hpp"
#include "report/text/explanation.hpp"
#include "results/analysis_json.hpp"

namespace zwidth::report {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

AnalysedDevice with_interval(StiffnessInterval interval) {
  AnalysedDevice analysed = analysed_device(Device(test::lhifam_parameters()));
  analysed.analysis.interval = interval;
  return analysed;
}

TEST(IntervalReport, TextPageAndDocumentHaveIt) {
  const AnalysedDevice analysed = with_interval({8700.0, 9000.0, 0.0, 1000});
  EXPECT_THAT(analysis_text({&analysed, 1}), HasSubstr("95 % interval       8.7 kN/m to 9 kN/m, from the uncertainty"));
  EXPECT_THAT(html_report({&analysed, 1}), HasSubstr("95 % interval: 8.7 kN/m to 9 kN/m"));
  const auto document = document_of(analysed);
  EXPECT_EQ(document["critical_stiffness_interval"], results::Json::parse("[8700.0, 9000.0]"));
  EXPECT_EQ(document["other_mechanism_share"], 0.0);
}

TEST(IntervalReport, AnotherMechanismIsMentioned) {
  EXPECT_THAT(*interval_note(with_interval({8000.0, 9000.0, 0.125, 1000})),
              HasSubstr("in 12 % of the devices that it allows another mechanism limits"));
  EXPECT_THAT(*interval_note(with_interval({8000.0, 9000.0, 0.0, 1000})), Not(HasSubstr("another mechanism")));
}

TEST(IntervalReport, AFitThatIsNotToBeTrustedSaysSo) {
  AnalysedDevice analysed = with_interval({8000.0, 9000.0, 0.0, 1000});
  EXPECT_TRUE(document_of(analysed)["uncertainty_warning"].is_null());
  DeviceParameters parameters = analysed.device.parameters();
  parameters.uncertainty = Uncertainty{{"link.0.stiffness"}, {{1.0}}, "the data do not determine body.handle.mass"};
  analysed.device = Device(parameters);
  EXPECT_THAT(*interval_note(analysed), HasSubstr("NOT TO BE TRUSTED: the data do not determine body.handle.mass"));
  EXPECT_EQ(document_of(analysed)["uncertainty_warning"], "the data do not determine body.handle.mass");
}

TEST(IntervalReport, AnUnboundedEndIsNoNumber) {
  const AnalysedDevice analysed = with_interval({8000.0, std::numeric_limits<double>::infinity(), 0.0, 1000});
  EXPECT_THAT(*interval_note(analysed), HasSubstr("8 kN/m to unbounded"));
  EXPECT_TRUE(document_of(analysed)["critical_stiffness_interval"][1].is_null());
}

TEST(IntervalReport, WithoutUncertaintyThereIsNone) {
  const AnalysedDevice analysed = analysed_device(Device(test::lhifam_parameters()));
  EXPECT_FALSE(interval_note(analysed).has_value());
  EXPECT_TRUE(document_of(analysed)["critical_stiffness_interval"].is_null());
  EXPECT_TRUE(document_of(analysed)["other_mechanism_share"].is_null());
  EXPECT_THAT(analysis_text({&analysed, 1}), Not(HasSubstr("95 % interval")));
}

}  // namespace
}  // namespace zwidth::report
