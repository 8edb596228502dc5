// [[wall.filter]] in device files and overrides: what is read, and what is refused, word for word.
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "io/device_texts.hpp"
#include "zwidth/io/device_file.hpp"

namespace zwidth {
namespace {

using enum WallFilter::Kind;

const std::string five_filters = small_device_text + R"(
[wall]
stiffness = 100
[[wall.filter]]
type = "low_pass"
frequency_hz = 60
[[wall.filter]]
type = "notch"
frequency_hz = 30.5
damping_ratio = 0.3
depth = 0.2
[[wall.filter]]
type = "lead_lag"
frequency_hz = 12
ratio = 3
[[wall.filter]]
type = "biquad"
numerator = [1, 2]
denominator = [1, 2, 3]
frequency_hz = 7
[[wall.filter]]
type = "digital"
numerator = [0.25, 0.25]
denominator = [1, -0.5]
)";

std::vector<WallFilter> filters_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
  const auto device = parse_device(text, "f.toml", overrides);
  if (!device) throw std::runtime_error(device.error().str());
  return device->parameters().wall.filters;
}

std::string refusal(const std::string& text, const std::vector<std::string>& overrides = {}) {
  const auto device = parse_device(text, "f.toml", overrides);
  return device ? "" : device.error().str();
}

// small_device_text has 5 lines: the filter's keys begin in line 7.
std::string with_filter(const std::string& keys) { return small_device_text + "[[wall.filter]]\n" + keys; }

TEST(WallFilterFile, ReadsEveryType) {
  const std::vector<WallFilter> filters = filters_of(five_filters);
  ASSERT_EQ(filters.size(), 5U);
  EXPECT_EQ(filters[0], (WallFilter{.kind = low_pass, .frequency_hz = 60.0}));
  EXPECT_EQ(filters[1], (WallFilter{.kind = notch, .frequency_hz = 30.5, .damping_ratio = 0.3, .depth = 0.2}));
  EXPECT_EQ(filters[2], (WallFilter{.kind = lead_lag, .frequency_hz = 12.0, .ratio = 3.0}));
  EXPECT_EQ(filters[3],
            (WallFilter{.kind = biquad, .frequency_hz = 7.0, .numerator = {1.0, 2.0}, .denominator = {1.0, 2.0, 3.0}}));
  EXPECT_EQ(filters[4], (WallFilter{.kind = digital, .numerator = {0.25, 0.25}, .denominator = {1.0, -0.5}}));
}

TEST(WallFilterFile, SecondOrder) {
  const auto filters =
      filters_of(with_filter("type = \"low_pass\"\nfrequency_hz = 9\norder = 2\ndamping_ratio = 0.4\n"));
  EXPECT_EQ(filters.at(0), (WallFilter{.kind = low_pass, .frequency_hz = 9.0, .order = 2, .damping_ratio = 0.4}));
}

TEST(WallFilterFile, OverridesReachFilters) {
  EXPECT_EQ(filters_of(five_filters, {"wall.filter.1.frequency_hz=61"}).at(1).frequency_hz, 61.0);
  const auto one = with_filter("type = \"notch\"\nfrequency_hz = 9\n");
  EXPECT_EQ(filters_of(one, {"wall.filter.depth=0.5"}).at(0).depth, 0.5);
  EXPECT_EQ(filters_of(one, {"wall.filter.type=low_pass"}).at(0).kind, low_pass);
  EXPECT_TRUE(filters_of(five_filters, {"wall.filter=[]"}).empty());
  const auto added = filters_of(small_device_text, {"wall.filter=[{type=\"low_pass\", frequency_hz=60}]"});
  EXPECT_EQ(added.at(0), (WallFilter{.kind = low_pass, .frequency_hz = 60.0}));
}

struct Refused {
  std::string keys;
  std::string message;
};

TEST(WallFilterFile, RefusedWithItsPlace) {
  const std::vector<Refused> cases{
      {"frequency_hz = 60\n",
       "6:1: wall.filter.0.type: is missing; must be given as one of low_pass, notch, lead_lag, biquad, digital"},
      {"type = 3\n", "7:8: wall.filter.0.type: is the number 3; must be text in quotes"},
      {"type = \"lowpass\"\n", "7:8: wall.filter.0.type: is \"lowpass\"; did you mean \"low_pass\"?"},
      {"type = \"elliptic\"\n",
       "7:8: wall.filter.0.type: is \"elliptic\"; must be one of low_pass, notch, lead_lag, biquad, digital"},
      {"type = \"notch\"\n", "6:1: wall.filter.0.frequency_hz: is missing; must be given as a number > 0"},
      {"type = \"notch\"\nfrequncy_hz = 3\n",
       "8:1: wall.filter.0.frequncy_hz: unknown key \"frequncy_hz\"; did you mean \"frequency_hz\"?"},
      {"type = \"notch\"\nfrequency_hz = 3\nratio = 2\n",
       "9:9: wall.filter.0.ratio: is no key of a filter of type \"notch\"; its keys are type, frequency_hz, "
       "damping_ratio, depth"},
      {"type = \"digital\"\nnumerator = [1]\ndenominator = [1, 0.5]\nfrequency_hz = 3\n",
       "10:16: wall.filter.0.frequency_hz: is no key of a filter of type \"digital\"; its keys are type, numerator, "
       "denominator"},
      {"type = \"lead_lag\"\nfrequency_hz = 3\n",
       "6:1: wall.filter.0.ratio: is missing; must be given as a number > 0"},
      {"type = \"biquad\"\nnumerator = [1]\n",
       "6:1: wall.filter.0.denominator: is missing; must be given as an array of numbers"},
      {"type = \"low_pass\"\nfrequency_hz = 3\norder = 1.5\n", "9:9: wall.filter.0.order: is 1.5; must be 1 or 2"},
      {"type = \"low_pass\"\nfrequency_hz = 3\ndamping_ratio = 1\n",
       "9:17: wall.filter.0.damping_ratio: stands beside order 1, which has none; must be left out, or set order = 2"},
      {"type = \"low_pass\"\nfrequency_hz = 500\n",
       "8:16: wall.filter.0.frequency_hz: is 500; must be at least 1e-30 and below the Nyquist frequency, 500 Hz"},
      {"type = \"low_pass\"\nfrequency_hz = -1\n",
       "8:16: wall.filter.0.frequency_hz: is -1; must be at least 1e-30 and below the Nyquist frequency, 500 Hz"},
      {"type = \"notch\"\nfrequency_hz = 5\ndepth = 0\n", "9:9: wall.filter.0.depth: is 0; must be from 1e-06 to 1"},
      {"type = \"notch\"\nfrequency_hz = 5\ndepth = nan\n",
       "9:9: wall.filter.0.depth: is nan; must be from 1e-06 to 1"},
      {"type = \"digital\"\nnumerator = [1]\ndenominator = [1, -1]\n",
       "9:15: wall.filter.0.denominator: has a pole that does not die out; all roots in z must lie inside the unit "
       "circle"},
      {"type = \"biquad\"\nnumerator = [1, 2, 3, 4]\ndenominator = [1, 2, 3]\n",
       "8:13: wall.filter.0.numerator: has 4 coefficients; must have at least 1 and no more than the denominator"},
      {"type = \"biquad\"\nnumerator = [1e-300]\ndenominator = [1, 2, 3]\n",
       "8:13: wall.filter.0.numerator: has the coefficient 1e-300; every coefficient must be 0 or from 1e-100 to "
       "1e+100 in magnitude"},
  };
  for (const Refused& each : cases) EXPECT_EQ(refusal(with_filter(each.keys)), "f.toml:" + each.message);
}

TEST(WallFilterFile, FiltersMustBeTables) {
  EXPECT_EQ(refusal(small_device_text + "[wall.filter]\ntype = \"notch\"\n"),
            "f.toml:6:1: wall.filter: is a table; must be tables, [[wall.filter]]");
  EXPECT_EQ(refusal(small_device_text + "[wall]\nfilter = [3]\n"),
            "f.toml:7:11: wall.filter: is the number 3; must be tables, [[wall.filter]]");
  EXPECT_EQ(refusal("frequency_hz = 3\n" + small_device_text),
            "f.toml:1:1: frequency_hz: unknown key \"frequency_hz\"; it belongs in [[wall.filter]]");
}

TEST(WallFilterFile, AtMostTwenty) {
  std::string text = small_device_text;
  for (int i = 0; i < 21; ++i) text += "[[wall.filter]]\ntype = \"low_pass\"\nfrequency_hz = 60\n";
  EXPECT_EQ(refusal(text), "f.toml:6:1: wall.filter: stands 21 times; must be at most 20 filters");
}

TEST(WallFilterFile, BadOverridesAreNamed) {
  EXPECT_EQ(
      refusal(five_filters, {"wall.filter.depth=1"}),
      "an override: wall.filter.depth: could be in any of 5 [[wall.filter]]; write for instance wall.filter.0.depth");
  EXPECT_EQ(refusal(five_filters, {"wall.filter.5.depth=1"}),
            "an override: wall.filter.5.depth: there is no wall.filter \"5\"; must be wall.filter.0 to wall.filter.4");
  EXPECT_EQ(refusal(five_filters, {"wall.filter.1.dept=1"}),
            "an override: wall.filter.1.dept: unknown key \"dept\"; did you mean \"depth\"?");
  EXPECT_EQ(
      refusal(five_filters, {"wall.filter.0.depth=1"}),
      "an override: wall.filter.0.depth: is no key of a filter of type \"low_pass\"; its keys are type, frequency_hz, "
      "order, damping_ratio");
  EXPECT_EQ(refusal(five_filters, {"wall.filter.1.frequency_hz=600"}),
            "an override: wall.filter.1.frequency_hz: is 600; must be at least 1e-30 and below the Nyquist frequency, "
            "500 Hz");
  EXPECT_EQ(refusal(small_device_text, {"wall.filter.0.depth=1"}),
            "an override: wall.filter.0.depth: the device has no [[wall.filter]]; to add one write "
            "wall.filter=[{type=\"low_pass\", frequency_hz=60}]");
  EXPECT_EQ(refusal(small_device_text, {"wall.fliter.0.depth=1"}),
            "an override: wall.fliter.0.depth: unknown key \"fliter\"; did you mean \"filter\"?");
  EXPECT_EQ(refusal("wall = 3\n" + small_device_text, {"wall.filter.0.depth=1"}),
            "f.toml:1:8: wall: is the number 3; must be a table, [wall]");
}

}  // namespace
}  // namespace zwidth
