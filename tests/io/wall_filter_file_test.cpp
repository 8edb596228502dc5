// [[wall.filter]] in device files and overrides: what is read, and what is refused.
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "io/device_texts.hpp"
#include "io/problem_data.hpp"
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

InputProblem refusal(const std::string& text, const std::vector<std::string>& overrides = {}) {
  const auto device = parse_device(text, "f.toml", overrides);
  return device ? InputProblem{{}, "is read", "", {}} : InputProblem(device.error());
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

struct BadFilter {
  std::string keys;
  test::RefusedProblem refused;
};

TEST(WallFilterFile, RefusedWithItsPlace) {
  const std::vector<BadFilter> cases{
      {"frequency_hz = 60\n",
       {{"f.toml", 6, 1, "wall.filter.0.type"}, {.code = ProblemCode::is_missing, .subjects = {{"needed", "choice"}}}}},
      {"type = 3\n",
       {{"f.toml", 7, 8, "wall.filter.0.type"},
        {.code = ProblemCode::of_other_type, .evidence = {{"number", 3.0}}, .subjects = {{"needed", "text"}}}}},
      {"type = \"lowpass\"\n",
       {{"f.toml", 7, 8, "wall.filter.0.type"},
        {.code = ProblemCode::not_one_of, .subjects = {{"given", "lowpass"}, {"meant", "low_pass"}}}}},
      {"type = \"elliptic\"\n",
       {{"f.toml", 7, 8, "wall.filter.0.type"},
        {.code = ProblemCode::not_one_of,
         .subjects = {{"given", "elliptic"}, {"choices", "one of low_pass, notch, lead_lag, biquad, digital"}}}}},
      {"type = \"notch\"\n",
       {{"f.toml", 6, 1, "wall.filter.0.frequency_hz"},
        {.code = ProblemCode::is_missing, .subjects = {{"needed", "positive"}}}}},
      {"type = \"notch\"\nfrequncy_hz = 3\n",
       {{"f.toml", 8, 1, "wall.filter.0.frequncy_hz"},
        {.code = ProblemCode::unknown_key, .subjects = {{"name", "frequncy_hz"}, {"meant", "frequency_hz"}}}}},
      {"type = \"notch\"\nfrequency_hz = 3\nratio = 2\n",
       {{"f.toml", 9, 9, "wall.filter.0.ratio"},
        {.code = ProblemCode::key_of_other_filters,
         .subjects = {{"type", "notch"}, {"keys", "type, frequency_hz, damping_ratio, depth"}}}}},
      {"type = \"digital\"\nnumerator = [1]\ndenominator = [1, 0.5]\nfrequency_hz = 3\n",
       {{"f.toml", 10, 16, "wall.filter.0.frequency_hz"},
        {.code = ProblemCode::key_of_other_filters,
         .subjects = {{"type", "digital"}, {"keys", "type, numerator, denominator"}}}}},
      {"type = \"lead_lag\"\nfrequency_hz = 3\n",
       {{"f.toml", 6, 1, "wall.filter.0.ratio"},
        {.code = ProblemCode::is_missing, .subjects = {{"needed", "positive"}}}}},
      {"type = \"biquad\"\nnumerator = [1]\n",
       {{"f.toml", 6, 1, "wall.filter.0.denominator"},
        {.code = ProblemCode::is_missing, .subjects = {{"needed", "numbers"}}}}},
      {"type = \"low_pass\"\nfrequency_hz = 3\norder = 1.5\n",
       {{"f.toml", 9, 9, "wall.filter.0.order"},
        {.code = ProblemCode::not_one_of, .evidence = {{"value", 1.5}}, .subjects = {{"choices", "1 or 2"}}}}},
      {"type = \"low_pass\"\nfrequency_hz = 3\ndamping_ratio = 1\n",
       {{"f.toml", 9, 17, "wall.filter.0.damping_ratio"}, {.code = ProblemCode::damping_of_first_order}}},
      {"type = \"low_pass\"\nfrequency_hz = 500\n",
       {{"f.toml", 8, 16, "wall.filter.0.frequency_hz"},
        {.code = ProblemCode::filter_frequency_out_of_range, .evidence = {{"value", 500.0}, {"nyquist", 500.0}}}}},
      {"type = \"low_pass\"\nfrequency_hz = -1\n",
       {{"f.toml", 8, 16, "wall.filter.0.frequency_hz"},
        {.code = ProblemCode::filter_frequency_out_of_range, .evidence = {{"value", -1.0}, {"nyquist", 500.0}}}}},
      {"type = \"notch\"\nfrequency_hz = 5\ndepth = 0\n",
       {{"f.toml", 9, 9, "wall.filter.0.depth"}, {.code = ProblemCode::not_between, .evidence = {{"value", 0.0}}}}},
      {"type = \"notch\"\nfrequency_hz = 5\ndepth = nan\n",
       {{"f.toml", 9, 9, "wall.filter.0.depth"},
        {.code = ProblemCode::not_between, .evidence = {{"value", std::nan("")}}}}},
      {"type = \"digital\"\nnumerator = [1]\ndenominator = [1, -1]\n",
       {{"f.toml", 9, 15, "wall.filter.0.denominator"}, {.code = ProblemCode::filter_not_stable}}},
      {"type = \"biquad\"\nnumerator = [1, 2, 3, 4]\ndenominator = [1, 2, 3]\n",
       {{"f.toml", 8, 13, "wall.filter.0.numerator"},
        {.code = ProblemCode::number_of_coefficients, .evidence = {{"count", 4.0}}}}},
      {"type = \"biquad\"\nnumerator = [1e-300]\ndenominator = [1, 2, 3]\n",
       {{"f.toml", 8, 13, "wall.filter.0.numerator"},
        {.code = ProblemCode::coefficient_out_of_range, .evidence = {{"value", 1e-300}}}}},
  };
  for (const BadFilter& each : cases) test::expect_refused(refusal(with_filter(each.keys)), each.refused);
}

TEST(WallFilterFile, FiltersMustBeTables) {
  test::expect_refused(refusal(small_device_text + "[wall.filter]\ntype = \"notch\"\n"),
                       {{"f.toml", 6, 1, "wall.filter"},
                        {.code = ProblemCode::of_other_type, .subjects = {{"kind", "table"}, {"needed", "tables"}}}});
  test::expect_refused(
      refusal(small_device_text + "[wall]\nfilter = [3]\n"),
      {{"f.toml", 7, 11, "wall.filter"},
       {.code = ProblemCode::of_other_type, .evidence = {{"number", 3.0}}, .subjects = {{"needed", "tables"}}}});
  test::expect_refused(
      refusal("frequency_hz = 3\n" + small_device_text),
      {{"f.toml", 1, 1, "frequency_hz"},
       {.code = ProblemCode::unknown_key, .subjects = {{"name", "frequency_hz"}, {"homes", "[[wall.filter]]"}}}});
}

TEST(WallFilterFile, AtMostTwenty) {
  std::string text = small_device_text;
  for (int i = 0; i < 21; ++i) text += "[[wall.filter]]\ntype = \"low_pass\"\nfrequency_hz = 60\n";
  test::expect_refused(refusal(text), {{"f.toml", 6, 1, "wall.filter"},
                                       {.code = ProblemCode::stands_too_often, .evidence = {{"count", 21.0}}}});
}

TEST(WallFilterFile, BadOverridesAreNamed) {
  test::expect_refused(refusal(five_filters, {"wall.filter.depth=1"}),
                       {test::of_override("wall.filter.depth"),
                        {.code = ProblemCode::in_several_tables,
                         .evidence = {{"count", 5.0}},
                         .subjects = {{"header", "[[wall.filter]]"}, {"example", "wall.filter.0.depth"}}}});
  test::expect_refused(refusal(five_filters, {"wall.filter.5.depth=1"}),
                       {test::of_override("wall.filter.5.depth"),
                        {.code = ProblemCode::no_such_name,
                         .evidence = {{"last", 4.0}},
                         .subjects = {{"what", "wall.filter"}, {"name", "5"}}}});
  test::expect_refused(refusal(five_filters, {"wall.filter.1.dept=1"}),
                       {test::of_override("wall.filter.1.dept"),
                        {.code = ProblemCode::unknown_key, .subjects = {{"name", "dept"}, {"meant", "depth"}}}});
  test::expect_refused(refusal(five_filters, {"wall.filter.0.depth=1"}),
                       {test::of_override("wall.filter.0.depth"),
                        {.code = ProblemCode::key_of_other_filters,
                         .subjects = {{"type", "low_pass"}, {"keys", "type, frequency_hz, order, damping_ratio"}}}});
  test::expect_refused(
      refusal(five_filters, {"wall.filter.1.frequency_hz=600"}),
      {test::of_override("wall.filter.1.frequency_hz"),
       {.code = ProblemCode::filter_frequency_out_of_range, .evidence = {{"value", 600.0}, {"nyquist", 500.0}}}});
  test::expect_refused(refusal(small_device_text, {"wall.filter.0.depth=1"}),
                       {test::of_override("wall.filter.0.depth"),
                        {.code = ProblemCode::no_table_to_override, .subjects = {{"header", "[[wall.filter]]"}}}});
  test::expect_refused(refusal(small_device_text, {"wall.fliter.0.depth=1"}),
                       {test::of_override("wall.fliter.0.depth"),
                        {.code = ProblemCode::unknown_key, .subjects = {{"name", "fliter"}, {"meant", "filter"}}}});
  test::expect_refused(
      refusal("wall = 3\n" + small_device_text, {"wall.filter.0.depth=1"}),
      {{"f.toml", 1, 8, "wall"},
       {.code = ProblemCode::of_other_type, .evidence = {{"number", 3.0}}, .subjects = {{"needed", "table"}}}});
}

}  // namespace
}  // namespace zwidth
