// What is wrong with a device file, word for word: the messages are part of the interface.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "io/device_texts.hpp"
#include "zwidth/io/device_file.hpp"

namespace zwidth {
namespace {

struct BadText {
  std::string name;
  std::string text;
  std::string message;  // after "f.toml:"
};

std::string body(const std::string& rest) { return "[[body]]\nname = \"a\"\nmass = 1\n" + rest + "\n"; }
std::string loop(const std::string& rest = "") { return "[loop]\nsampling_period = 1e-3\n" + rest + "\n"; }
std::string transfer_function(const std::string& numerator, const std::string& denominator) {
  return fmt::format("[transfer_function]\nnumerator = {}\ndenominator = {}\n{}", numerator, denominator, loop());
}

const std::string no_device =
    "1:1: body: is missing: the device has no [[body]] and no [transfer_function]; must be one or more bodies, or a "
    "transfer function";

const std::string a_damping = "must be a number of N s/m, or a text with its unit such as \"5 N s/m\"";

class RefusedText : public testing::TestWithParam<BadText> {};

TEST_P(RefusedText, IsNamedWithItsPlace) {
  const auto device = parse_device(GetParam().text, "f.toml");
  ASSERT_FALSE(device.has_value());
  EXPECT_EQ(device.error().str(), "f.toml:" + GetParam().message);
}

const BadText texts[] = {
    {"empty", "", no_device},
    {"white_space", " \n\t\n", no_device},
    {"byte_order_mark_only", "\xEF\xBB\xBF", no_device},
    {"only_loop", loop(), no_device},
    {"zero_byte", std::string("a\nb\0c", 5), "2:2: is not text: it has a zero byte; must be the TOML text of a device"},
    {"json", "\n {\"a.b.c\": 1}", "1:1: begins with a brace, as no TOML text does; must be the TOML text of a device"},
    {"not_utf8", "\xFF\xFE", "1:1: is not TOML: Encountered invalid utf-8 sequence; must be the TOML text of a device"},
    {"not_toml", "name = \"x\"\n= 1",
     "2:1: is not TOML: Error while parsing root table: expected keys, tables, whitespace or comments, saw '='; must "
     "be "
     "the TOML text of a device"},
    {"header_without_key", "[=]",
     "1:2: is not TOML: Error while parsing key: expected bare key starting character or string delimiter, saw '='; "
     "must "
     "be the TOML text of a device"},
    {"deep_nesting", "x = [[[[[[[[[[1]]]]]]]]]]",
     "1:13: is not TOML: Error while parsing value: exceeded maximum nested value depth of 8; must be the TOML text of "
     "a "
     "device"},
    {"huge_integer", body("damping = 99999999999999999999"),
     "4:31: the number is out of range; must be 0 or from 1e-30 to 1e30 in magnitude (coefficients: 1e-100 to 1e100)"},
    {"huge_number", body("damping = 1e400"),
     "4:16: the number is out of range; must be 0 or from 1e-30 to 1e30 in magnitude (coefficients: 1e-100 to 1e100)"},
    {"bidirectional_control", "name = \"a\u202Eb\"\n" + body("") + loop(),
     "1:8: name: has a control character; must be one line of plain text"},
    {"isolating_control", "name = \"a\u2066b\"\n" + body("") + loop(),
     "1:8: name: has a control character; must be one line of plain text"},
    {"second_control_set", "name = \"a\u009Bb\"\n" + body("") + loop(),
     "1:8: name: has a control character; must be one line of plain text"},
    {"repeated_name_before_a_reference_to_it",
     body("") + body("") + "[[link]]\nbetween = [\"a\", \"b\"]\nstiffness = 1\n" + loop(),
     "6:8: body.1.name: \"a\" names two bodies; must be different for every body"},
    {"table_twice", body("") + loop() + loop(),
     "8:1: is not TOML: Error while parsing table header: cannot redefine existing table 'loop'; must be the TOML text "
     "of a device"},
    {"misspelt_key", "[[body]]\nname = \"a\"\nmas = 1\n",
     "3:1: body.a.mas: unknown key \"mas\"; did you mean \"mass\"?"},
    {"misspelt_name", "[[body]]\nnam = \"a\"\nmass = 1\n",
     "2:1: body.0.nam: unknown key \"nam\"; did you mean \"name\"?"},
    {"misspelt_table", body("") + "[lop]\n", "5:2: lop: unknown key \"lop\"; did you mean \"loop\"?"},
    {"swapped_letters", body("") + loop("dealy = 0"),
     "7:1: loop.dealy: unknown key \"dealy\"; did you mean \"delay\"?"},
    {"key_of_another_table", body("delay = 1"), "4:1: body.a.delay: unknown key \"delay\"; it belongs in [loop]"},
    {"key_of_several_tables", body("") + loop("stiffness = 1"),
     "7:1: loop.stiffness: unknown key \"stiffness\"; it belongs in [[body]] or [[link]] or [wall] or [operator]"},
    {"unheard_of_key", body("") + loop() + "[wall]\ncolour = 3\n",
     "9:1: wall.colour: unknown key \"colour\"; the keys of [wall] are stiffness, damping, velocity_filter_hz, "
     "velocity_filter_tau, filter"},
    {"key_with_newline", "\"a\\nb\" = 1\n",
     "1:1: a\\x0Ab: unknown key \"a\\x0Ab\"; the keys of the top level are name, motion, body, link, loop, actuator, "
     "sensor, wall, operator, transfer_function, uncertainty, driver"},
    {"long_key", std::string(70, 'k') + " = 1\n",
     fmt::format("1:1: {0}...: unknown key \"{0}...\"; the keys of the top level are name, motion, body, link, loop, "
                 "actuator, sensor, wall, operator, transfer_function, uncertainty, driver",
                 std::string(60, 'k'))},
    {"text_for_number", body("damping = \"x\""), "4:11: body.a.damping: is the text \"x\"; " + a_damping},
    {"date_for_number", body("damping = 1979-05-27"), "4:11: body.a.damping: is a date or time; " + a_damping},
    {"truth_for_number", body("damping = true"), "4:11: body.a.damping: is true; " + a_damping},
    {"array_for_number", body("damping = [1]"), "4:11: body.a.damping: is an array; " + a_damping},
    {"unit_of_another_kind", body("damping = \"5 N/m\""),
     "4:11: body.a.damping: \"N/m\" is no unit of a damping; " + a_damping},
    {"unit_of_rotary_motion", body("stiffness = \"5 N m/deg\""),
     "4:13: body.a.stiffness: \"N m/deg\" is no unit of a stiffness; must be a number of N/m, or a text with its unit "
     "such as \"5 N/mm\""},
    {"number_without_unit", body("damping = \"5\""), "4:11: body.a.damping: \"5\" has no unit; " + a_damping},
    {"no_unit", body("damping = \"5 N s/mile\""),
     "4:11: body.a.damping: cannot read the unit \"N s/mile\"; " + a_damping},
    {"temperature", body("damping = \"5 N s/m @ 3\""),
     "4:11: body.a.damping: cannot read the unit \"N s/m @ 3\"; " + a_damping},
    {"period_as_a_frequency", body("") + "[loop]\nsampling_period = \"2.5 kHz\"\n",
     "6:19: loop.sampling_period: \"kHz\" is no unit of a time; a period is 1/frequency: \"0.4 ms\""},
    {"counts_as_a_step", "motion = \"rotary\"\n" + body("") + loop() + "[sensor]\nresolution = \"4096 counts/turn\"\n",
     "10:14: sensor.resolution: \"counts/turn\" is no unit of an angle; a step is its inverse: \"1 turn/4096\""},
    {"counts_as_a_linear_step", body("") + loop() + "[sensor]\nresolution = \"200 counts/mm\"\n",
     "9:14: sensor.resolution: \"counts/mm\" is no unit of a length; a step is its inverse: \"1 mm/200\""},
    {"period_as_a_frequency_that_no_decimal_inverts", body("") + "[loop]\nsampling_period = \"3 kHz\"\n",
     "6:19: loop.sampling_period: \"kHz\" is no unit of a time; a period is 1/frequency: \"1 s/3000\""},
    {"unit_out_of_range", body("damping = \"1e400 N s/m\""),
     "4:11: body.a.damping: the number is out of range; must be 0 or from 1e-30 to 1e30 in magnitude (coefficients: "
     "1e-100 to 1e100)"},
    {"negative_with_unit", body("damping = \"-3 N s/mm\"") + loop(),
     "4:11: body.a.damping: is -3000; must be a finite number >= 0"},
    {"unit_of_an_order",
     body("") + loop() + "[[wall.filter]]\ntype = \"low_pass\"\nfrequency_hz = 3\norder = \"2 s\"\n",
     "11:9: wall.filter.0.order: is the text \"2 s\"; must be a number"},
    {"sampling_frequency", body("") + "[loop]\nsampling_frequency = 2000\n",
     "6:1: loop.sampling_frequency: unknown key \"sampling_frequency\"; write sampling_period of [loop], which is "
     "1/frequency: 2 kHz is \"500 us\" or 0.5e-3 (s)"},
    {"sample_time_at_the_top", "Ts = 1e-3\n" + body("") + loop(),
     "1:1: Ts: unknown key \"Ts\"; did you mean \"sampling_period\" of [loop]? A number of s, or a text with its unit "
     "such as \"500 us\""},
    {"friction", body("friction = 1"),
     "4:1: body.a.friction: unknown key \"friction\"; write damping for viscous friction (N s/m), coulomb for dry "
     "friction (N)"},
    {"damping_ratio_of_a_link", "[[link]]\nbetween = [\"a\", \"b\"]\ndamping_ratio = 0.1\n",
     "3:1: link.0.damping_ratio: unknown key \"damping_ratio\"; write damping in N s/m (N m s/rad): 2 damping_ratio "
     "sqrt(stiffness m), m = m1 m2/(m1 + m2) of its two bodies"},
    {"both_velocity_filters", body("") + loop() + "[wall]\nvelocity_filter_hz = 3\nvelocity_filter_tau = 1e-3\n",
     "10:23: wall.velocity_filter_tau: is given beside velocity_filter_hz, which is the same filter; must be one of "
     "the "
     "two"},
    {"time_constant_of_no_cutoff", body("") + loop() + "[wall]\nvelocity_filter_tau = 1e30\n",
     "9:23: wall.velocity_filter_tau: is 1e+30; must be 0 or from 1e-30 to 1e29 (in s)"},
    {"negative_time_constant", body("") + loop() + "[wall]\nvelocity_filter_tau = -1e-3\n",
     "9:23: wall.velocity_filter_tau: is -0.001; must be 0 or from 1e-30 to 1e29 (in s)"},
    {"number_for_text", "name = 3\n", "1:8: name: is the number 3; must be text in quotes"},
    {"number_for_table", "loop = 1.5\n", "1:8: loop: is the number 1.5; must be a table, [loop]"},
    {"table_for_tables", "[body]\nname = \"a\"\n", "1:1: body: is a table; must be tables, [[body]]"},
    {"number_for_tables", "body = [1]\n", "1:9: body: is the number 1; must be tables, [[body]]"},
    {"wrong_motion", "motion = \"Linear\"\n" + body("") + loop(),
     "1:10: motion: is \"Linear\"; must be \"linear\" or \"rotary\""},
    {"missing_mass", "[[body]]\nname = \"a\"\n" + loop(),
     "1:1: body.a.mass: is missing; must be given as a number > 0"},
    {"missing_name", "\n[[body]]\nmass = 1\n" + loop(),
     "2:1: body.0.name: is missing; must be given as text in quotes"},
    {"missing_loop", body(""), "1:1: loop: is missing; must be given as [loop] with sampling_period in seconds"},
    {"missing_sampling_period", body("") + "[loop]\ndelay = 0\n",
     "5:1: loop.sampling_period: is missing; must be given as a number > 0"},
    {"missing_between", body("") + "[[link]]\nstiffness = 1\n" + loop(),
     "5:1: link.0.between: is missing; must be given as an array of two body names"},
    {"missing_link_stiffness", two_body_text + "[[link]]\nbetween = [\"motor\", \"handle\"]\n",
     "12:1: link.1.stiffness: is missing; must be given, or damping, or both"},
    {"missing_denominator", "[transfer_function]\nnumerator = [1]\n" + loop(),
     "1:1: transfer_function.denominator: is missing; must be given as an array of numbers"},
    {"inertia_of_linear", "[[body]]\nname = \"a\"\ninertia = 1\n" + loop(),
     "3:11: body.a.inertia: is for rotary motion; must be \"mass\", or set motion = \"rotary\""},
    {"mass_and_inertia", "motion = \"rotary\"\n" + body("inertia = 1") + loop(),
     "5:11: body.a.inertia: is given beside mass, which means the same; must be one of the two"},
    {"negative_mass", "[[body]]\nname = \"motor\"\nmass = -0.3\n" + loop(),
     "3:8: body.motor.mass: is -0.3; must be a finite number > 0"},
    {"zero_mass", "[[body]]\nname = \"motor\"\nmass = 0\n" + loop(),
     "3:8: body.motor.mass: is 0; must be a finite number > 0"},
    {"nan_mass", "[[body]]\nname = \"motor\"\nmass = nan\n" + loop(),
     "3:8: body.motor.mass: is nan; must be a finite number > 0"},
    {"huge_mass", "[[body]]\nname = \"motor\"\nmass = 1e308\n" + loop(),
     "3:8: body.motor.mass: is 1e+308; must be from 1e-30 to 1e+30"},
    {"tiny_damping", body("damping = 1e-300") + loop(),
     "4:11: body.a.damping: is 1e-300; must be 0 or from 1e-30 to 1e+30"},
    {"infinite_damping", body("damping = inf") + loop(), "4:11: body.a.damping: is inf; must be a finite number >= 0"},
    {"negative_delay", body("") + loop("delay = -1e-3"), "7:9: loop.delay: is -0.001; must be a finite number >= 0"},
    {"endless_delay", body("") + loop("delay = 11"),
     "7:9: loop.delay: is 11 s, 11000 sampling periods; must be at most 10000 sampling periods"},
    {"zero_sampling_period", body("") + "[loop]\nsampling_period = 0.0\n",
     "6:19: loop.sampling_period: is 0; must be a finite number > 0"},
    {"zero_force_limit", body("") + loop() + "[actuator]\nforce_limit = 0\n",
     "9:15: actuator.force_limit: is 0; must be a finite number > 0"},
    {"same_name_twice", body("") + body("") + loop(),
     "6:8: body.1.name: \"a\" names two bodies; must be different for every body"},
    {"empty_name", "[[body]]\nname = \"\"\nmass = 1\n" + loop(), "2:8: body.0.name: is empty; must be a name"},
    {"newline_in_name", "[[body]]\nname = \"a\\nb\"\nmass = 1\n" + loop(),
     "2:8: body.0.name: has a control character; must be one line of plain text"},
    {"tied_to_nothing", body("") + "[[body]]\nname = \"b\"\nmass = 1\n" + loop(),
     "5:1: body.b: is tied to nothing; must be connected to every other body through [[link]]s"},
    {"tied_to_itself", body("") + "[[link]]\nbetween = [\"a\", \"a\"]\nstiffness = 1\n" + loop(),
     "6:11: link.0.between: ties \"a\" to itself; must be two different bodies"},
    {"link_to_misspelt_body", two_body_text + "[[link]]\nbetween = [\"motor\", \"hadnle\"]\nstiffness = 1\n",
     "13:11: link.1.between: there is no body \"hadnle\"; did you mean \"handle\"?"},
    {"link_to_unknown_body", two_body_text + "[[link]]\nbetween = [\"motor\", \"wrist\"]\nstiffness = 1\n",
     "13:11: link.1.between: there is no body \"wrist\"; the bodies are motor, handle"},
    {"link_of_three", two_body_text + "[[link]]\nbetween = [\"motor\", \"handle\", \"motor\"]\nstiffness = 1\n",
     "13:11: link.1.between: has length 3; must name two bodies"},
    {"link_of_numbers", two_body_text + "[[link]]\nbetween = [\"motor\", 2]\nstiffness = 1\n",
     "13:21: link.1.between: is the number 2; every element must be text in quotes"},
    {"link_of_text", two_body_text + "[[link]]\nbetween = \"motor\"\nstiffness = 1\n",
     "13:11: link.1.between: is the text \"motor\"; must be an array of two body names"},
    {"slack_link", two_body_text + "[[link]]\nbetween = [\"motor\", \"handle\"]\nstiffness = 0\n",
     "14:13: link.1.stiffness: and damping are both 0; one of the two must be > 0, or there is no link"},
    {"unknown_sensed_body", body("") + loop("sensed = \"b\""),
     "7:10: loop.sensed: there is no body \"b\"; the bodies are a"},
    {"both_descriptions", body("") + transfer_function("[1]", "[1, 2]"),
     "1:1: body: stands beside [transfer_function]; must be either bodies and links or a transfer function"},
    {"operator_of_transfer_function", transfer_function("[1]", "[1, 2]") + "[operator]\n",
     "7:1: operator: stands beside [transfer_function]; an operator needs bodies: leave it out"},
    {"held_of_transfer_function", transfer_function("[1]", "[1, 2]") + "held = \"a\"\n",
     "7:8: loop.held: names a body beside [transfer_function]; a transfer function has no bodies: leave it out"},
    {"not_strictly_proper", transfer_function("[1, 1]", "[1, 2]"),
     "2:13: transfer_function.numerator: has degree 1 under a denominator of degree 1; must be of lower degree than "
     "the "
     "denominator"},
    {"zero_numerator", transfer_function("[0, 0]", "[1, 2]"),
     "2:13: transfer_function.numerator: is 0; must have a coefficient that is not 0"},
    {"padded_numerator", transfer_function("[0, 0, 1]", "[1, 2]"),
     "2:13: transfer_function.numerator: is longer than the denominator; leave out its leading zeros"},
    {"zero_leading_denominator", transfer_function("[1]", "[0, 1, 2]"),
     "3:15: transfer_function.denominator: begins with 0; the leading coefficient must not be 0"},
    {"empty_numerator", transfer_function("[]", "[1, 2]"),
     "2:13: transfer_function.numerator: is empty; must be one or more coefficients"},
    {"nan_coefficient", transfer_function("[nan]", "[1, 2]"),
     "2:13: transfer_function.numerator: has the coefficient nan; every coefficient must be 0 or from 1e-100 to 1e+100 "
     "in magnitude"},
    {"text_coefficient", transfer_function("[1, \"x\"]", "[1, 2, 3]"),
     "2:17: transfer_function.numerator: is the text \"x\"; every element must be a number"},
};

INSTANTIATE_TEST_SUITE_P(DeviceFile, RefusedText, testing::ValuesIn(texts),
                         [](const auto& test) { return test.param.name; });

struct Slip {
  std::string name;
  std::string text;
  std::size_t line = 0;
  std::size_t column = 0;
  std::string key;
  std::string suggestion;  // empty: none
};

class SlipOfWriting : public testing::TestWithParam<Slip> {};

TEST_P(SlipOfWriting, IsAnsweredWithTheValueToPut) {
  const auto device = parse_device(GetParam().text, "f.toml");
  ASSERT_FALSE(device.has_value());
  const InputError& error = device.error();
  EXPECT_EQ(error.place.file, "f.toml");
  EXPECT_EQ(error.place.line, GetParam().line) << error.str();
  EXPECT_EQ(error.place.column, GetParam().column) << error.str();
  EXPECT_EQ(error.place.key, GetParam().key) << error.str();
  EXPECT_EQ(error.suggestion.value_or(""), GetParam().suggestion) << error.str();
  EXPECT_TRUE(error.others.empty()) << error.others.front().str();
}

const std::string of_rotary = "motion = \"rotary\"\n";
std::string body_of(const std::string& mass) { return "[[body]]\nname = \"a\"\nmass = " + mass + "\n"; }

const Slip slips[] = {
    {"unit_without_quotes", body("") + loop("delay = 0.5 ms  # more"), 7, 9, "loop.delay", "0.5 ms"},
    {"frequency_without_quotes", body("") + "[loop]\nsampling_period = 2 kHz\n", 6, 19, "loop.sampling_period",
     "0.5 ms"},
    {"word_without_quotes", body("") + loop("sensed = a"), 7, 10, "loop.sensed", "a"},
    {"decimal_comma", body_of("0,5") + loop(), 3, 8, "body.a.mass", "0.5"},
    {"decimal_comma_with_unit", body_of("0,5 kg") + loop(), 3, 8, "body.a.mass", "0.5 kg"},
    {"decimal_comma_in_quotes", body_of("\"0,5 kg\"") + loop(), 3, 8, "body.a.mass", "0.5 kg"},
    {"thousands_or_thousandths", body_of("1,000") + loop(), 3, 8, "body.a.mass", ""},
    {"second_body", body("") + "[[body]]\nmass = 0,25\n" + loop(), 6, 8, "body.1.mass", "0.25"},
    {"gram_square_centimetre", of_rotary + body_of("\"22 gcm2\"") + loop(), 4, 8, "body.a.mass", "22 g cm2"},
    {"kilogram_square_metre", of_rotary + body_of("\"0.1 kgm2\"") + loop(), 4, 8, "body.a.mass", "0.1 kg m2"},
    {"newton_second_metre", body("damping = \"5 Ns/m\"") + loop(), 4, 11, "body.a.damping", "5 N s/m"},
    {"unit_that_is_none", body("damping = \"5 furlong\"") + loop(), 4, 11, "body.a.damping", ""},
    {"frequency_for_a_period", body("") + "[loop]\nsampling_period = \"2 kHz\"\n", 6, 19, "loop.sampling_period",
     "0.5 ms"},
    {"counts_for_a_step", body("") + loop() + "[sensor]\nresolution = \"200 counts/mm\"\n", 9, 14, "sensor.resolution",
     "1 mm/200"},
    {"misspelt_body", two_body_text + "[wall]\nstiffness = 1\n[operator]\nmas = 1\n", 15, 1, "operator.mas", ""},
    {"motion", "motion = \"Rotary\"\n" + body_of("\"22 g cm^2\"") + loop(), 1, 10, "motion", "rotary"},
};

INSTANTIATE_TEST_SUITE_P(DeviceFile, SlipOfWriting, testing::ValuesIn(slips),
                         [](const auto& test) { return test.param.name; });

TEST(DeviceFile, ASuggestionTakenIsRead) {
  const std::string text = of_rotary + body_of("\"22 gcm2\"") + "[loop]\nsampling_period = \"2 kHz\"\n";
  const auto refused = parse_device(text, "f.toml");
  ASSERT_FALSE(refused.has_value());
  std::vector<std::string> taken;
  for (const InputProblem& each : refused.error().problems()) {
    taken.push_back(each.place.key + "=" + each.suggestion.value_or(""));
  }
  ASSERT_EQ(taken.size(), 2U);
  const auto device = parse_device(text, "f.toml", taken);
  ASSERT_TRUE(device.has_value()) << device.error().str();
  EXPECT_EQ(device->bodies()[0].mass, 22e-7);
  EXPECT_EQ(device->loop().sampling_period, 0.5e-3);
}

std::vector<std::string> refused_keys(const std::string& text, const std::vector<std::string>& overrides = {}) {
  std::vector<std::string> keys;
  const auto device = parse_device(text, "f.toml", overrides);
  if (device) return keys;
  for (const InputProblem& each : device.error().problems()) keys.push_back(each.place.key);
  return keys;
}

TEST(DeviceFile, EveryProblemIsToldOnceAndNoneThatFollowsFromIt) {
  using Keys = std::vector<std::string>;
  // Types, units and impossible values of one file together.
  EXPECT_EQ(refused_keys("[[body]]\nname = \"a\"\nmass = -1\ndamping = true\nstiffness = \"5 kg\"\n[loop]\n"
                         "sampling_period = 0\ndelay = -1\n[wall]\nstiffness = -2\n"),
            (Keys{"body.a.damping", "body.a.stiffness", "body.a.mass", "loop.sampling_period", "loop.delay",
                  "wall.stiffness"}));
  // A key that is misspelt is not missed beside that; a missing one has no value to be impossible.
  EXPECT_EQ(refused_keys("[[body]]\nname = \"a\"\nmas = 1\n" + loop()), Keys{"body.a.mas"});
  EXPECT_EQ(refused_keys(body("") + "[lop]\nsampling_period = 1\n"), Keys{"lop"});
  EXPECT_EQ(refused_keys("[[body]]\nname = \"a\"\n[[body]]\nmass = 1\n" + loop()),
            (Keys{"body.a.mass", "body.1.name"}));
  EXPECT_EQ(refused_keys(""), Keys{"body"});
  // How the bodies hang together is judged where the links are read.
  EXPECT_EQ(refused_keys(two_body_text + "[[link]]\nbetween = [\"motor\", \"hand\"]\nstiffness = \"x\"\n"),
            (Keys{"link.1.between", "link.1.stiffness"}));
  EXPECT_EQ(refused_keys(body("") + loop() + "[[wall.filter]]\ntype = \"nich\"\n"), Keys{"wall.filter.0.type"});
  EXPECT_EQ(refused_keys(body("") + loop(), {"loop.dely=1", "loop.delay"}), (Keys{"loop.dely", ""}));
  // No answer is longer than a screen or two.
  std::string many = body("") + loop();
  for (int i = 0; i < 5000; ++i) many += fmt::format("x{} = 1\n", i);
  EXPECT_EQ(refused_keys(many).size(), 100U);
}

TEST(DeviceFile, AnInertiaIsRefusedByItsName) {
  const auto device = parse_device(of_rotary + "[[body]]\nname = \"a\"\ninertia = -1\n" + loop(), "f.toml");
  ASSERT_FALSE(device.has_value());
  EXPECT_EQ(device.error().place.key, "body.a.inertia");
  EXPECT_EQ(device.error().place.line, 4U);
}

TEST(DeviceFile, DeepKeysAreRefusedBeforeTheyNest) {
  std::string key = "a";
  for (int i = 0; i < 200'000; ++i) key += ".a";
  const auto device = parse_device(key + " = 1", "f.toml");
  ASSERT_FALSE(device.has_value());
  EXPECT_EQ(device.error().str(), "f.toml:1:1: the line has more than 200 dots; break it into several lines");
}

TEST(DeviceFile, TheDeepestKeysThatAreReadDoNoHarm) {
  std::string value = "1";
  std::string key = "a";
  for (int i = 0; i < 190; ++i) key += ".a";
  for (int i = 0; i < 3; ++i) value = fmt::format("[\n{{{} = {}}}\n]", key, value);
  EXPECT_FALSE(parse_device(key + " = " + value, "f.toml").has_value());
}

TEST(DeviceFile, ALongFileOfBodiesIsRefusedNotComputed) {
  std::string text;
  for (int i = 0; i < 2000; ++i) text += fmt::format("[[body]]\nname = \"b{}\"\nmass = 1\n", i);
  const auto device = parse_device(text + loop(), "f.toml");
  ASSERT_FALSE(device.has_value());
  EXPECT_EQ(device.error().str(), "f.toml:1:1: body: stands 2000 times; must be at most 100 bodies");
}

}  // namespace
}  // namespace zwidth
