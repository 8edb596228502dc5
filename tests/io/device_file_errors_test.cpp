// What is wrong with a device file, and where.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "io/device_texts.hpp"
#include "io/problem_data.hpp"
#include "zwidth/io/device_file.hpp"

namespace zwidth {
namespace {

struct BadText {
  std::string name;
  std::string text;
  test::RefusedProblem refused;
};

std::string transfer_function(const std::string& numerator, const std::string& denominator) {
  return fmt::format("[transfer_function]\nnumerator = {}\ndenominator = {}\n{}", numerator, denominator, loop_text());
}

const std::string shortened_key = std::string(60, 'k') + "...";

class RefusedText : public testing::TestWithParam<BadText> {};

TEST_P(RefusedText, IsNamedWithItsPlace) {
  const auto device = parse_device(GetParam().text, "f.toml");
  ASSERT_FALSE(device.has_value());
  test::expect_refused(device.error(), GetParam().refused);
}

const BadText texts[] = {
    {"empty", "", {{"f.toml", 1, 1, "body"}, {.code = ProblemCode::no_body_at_all}}},
    {"white_space", " \n\t\n", {{"f.toml", 1, 1, "body"}, {.code = ProblemCode::no_body_at_all}}},
    {"byte_order_mark_only", "\xEF\xBB\xBF", {{"f.toml", 1, 1, "body"}, {.code = ProblemCode::no_body_at_all}}},
    {"only_loop", loop_text(), {{"f.toml", 1, 1, "body"}, {.code = ProblemCode::no_body_at_all}}},
    {"zero_byte",
     std::string("a\nb\0c", 5),
     {{"f.toml", 2, 2, ""}, {.code = ProblemCode::not_toml, .subjects = {{"kind", "zero_byte"}}}}},
    {"json",
     "\n {\"a.b.c\": 1}",
     {{"f.toml", 1, 1, ""}, {.code = ProblemCode::not_toml, .subjects = {{"kind", "brace"}}}}},
    {"not_utf8", "\xFF\xFE", {{"f.toml", 1, 1, ""}, {.code = ProblemCode::not_toml}}},
    {"not_toml", "name = \"x\"\n= 1", {{"f.toml", 2, 1, ""}, {.code = ProblemCode::not_toml}}},
    {"header_without_key", "[=]", {{"f.toml", 1, 2, ""}, {.code = ProblemCode::not_toml}}},
    {"deep_nesting", "x = [[[[[[[[[[1]]]]]]]]]]", {{"f.toml", 1, 13, ""}, {.code = ProblemCode::not_toml}}},
    {"huge_integer",
     body_text("damping = 99999999999999999999"),
     {{"f.toml", 4, 31, ""}, {.code = ProblemCode::number_beyond_range}}},
    {"huge_number", body_text("damping = 1e400"), {{"f.toml", 4, 16, ""}, {.code = ProblemCode::number_beyond_range}}},
    {"bidirectional_control",
     "name = \"a\u202Eb\"\n" + body_text("") + loop_text(),
     {{"f.toml", 1, 8, "name"}, {.code = ProblemCode::control_character}}},
    {"isolating_control",
     "name = \"a\u2066b\"\n" + body_text("") + loop_text(),
     {{"f.toml", 1, 8, "name"}, {.code = ProblemCode::control_character}}},
    {"second_control_set",
     "name = \"a\u009Bb\"\n" + body_text("") + loop_text(),
     {{"f.toml", 1, 8, "name"}, {.code = ProblemCode::control_character}}},
    {"repeated_name_before_a_reference_to_it",
     body_text("") + body_text("") + "[[link]]\nbetween = [\"a\", \"b\"]\nstiffness = 1\n" + loop_text(),
     {{"f.toml", 6, 8, "body.1.name"}, {.code = ProblemCode::names_two_bodies, .subjects = {{"name", "a"}}}}},
    {"table_twice", body_text("") + loop_text() + loop_text(), {{"f.toml", 8, 1, ""}, {.code = ProblemCode::not_toml}}},
    {"misspelt_key",
     "[[body]]\nname = \"a\"\nmas = 1\n",
     {{"f.toml", 3, 1, "body.a.mas"},
      {.code = ProblemCode::unknown_key, .subjects = {{"name", "mas"}, {"meant", "mass"}}}}},
    {"misspelt_name",
     "[[body]]\nnam = \"a\"\nmass = 1\n",
     {{"f.toml", 2, 1, "body.0.nam"},
      {.code = ProblemCode::unknown_key, .subjects = {{"name", "nam"}, {"meant", "name"}}}}},
    {"misspelt_table",
     body_text("") + "[lop]\n",
     {{"f.toml", 5, 2, "lop"}, {.code = ProblemCode::unknown_key, .subjects = {{"name", "lop"}, {"meant", "loop"}}}}},
    {"swapped_letters",
     body_text("") + loop_text("dealy = 0"),
     {{"f.toml", 7, 1, "loop.dealy"},
      {.code = ProblemCode::unknown_key, .subjects = {{"name", "dealy"}, {"meant", "delay"}}}}},
    {"key_of_another_table",
     body_text("delay = 1"),
     {{"f.toml", 4, 1, "body.a.delay"},
      {.code = ProblemCode::unknown_key, .subjects = {{"name", "delay"}, {"homes", "[loop] or [loop.damper]"}}}}},
    {"key_of_several_tables",
     body_text("") + loop_text("stiffness = 1"),
     {{"f.toml", 7, 1, "loop.stiffness"},
      {.code = ProblemCode::unknown_key,
       .subjects = {{"name", "stiffness"},
                    {"homes",
                     "[[body]] or [[link]] or [mechanism.joint.NAME] or [mechanism.tendon.NAME] or "
                     "[[transmission]] or [wall] or [operator]"}}}}},
    {"unheard_of_key",
     body_text("") + loop_text() + "[wall]\ncolour = 3\n",
     {{"f.toml", 9, 1, "wall.colour"},
      {.code = ProblemCode::unknown_key, .subjects = {{"name", "colour"}, {"table", "[wall]"}}}}},
    {"key_with_newline",
     "\"a\\nb\" = 1\n",
     {{"f.toml", 1, 1, "a\nb"},
      {.code = ProblemCode::unknown_key, .subjects = {{"name", "a\nb"}, {"table", "the top level"}}}}},
    {"long_key",
     std::string(70, 'k') + " = 1\n",
     {{"f.toml", 1, 1, shortened_key},
      {.code = ProblemCode::unknown_key, .subjects = {{"name", shortened_key}, {"table", "the top level"}}}}},
    {"text_for_number",
     body_text("damping = \"x\""),
     {{"f.toml", 4, 11, "body.a.damping"},
      {.code = ProblemCode::of_other_type, .subjects = {{"text", "x"}, {"needed", "measured"}, {"in", "N s/m"}}}}},
    {"date_for_number",
     body_text("damping = 1979-05-27"),
     {{"f.toml", 4, 11, "body.a.damping"},
      {.code = ProblemCode::of_other_type, .subjects = {{"kind", "time"}, {"needed", "measured"}, {"in", "N s/m"}}}}},
    {"truth_for_number",
     body_text("damping = true"),
     {{"f.toml", 4, 11, "body.a.damping"},
      {.code = ProblemCode::of_other_type, .subjects = {{"kind", "true"}, {"needed", "measured"}, {"in", "N s/m"}}}}},
    {"array_for_number",
     body_text("damping = [1]"),
     {{"f.toml", 4, 11, "body.a.damping"},
      {.code = ProblemCode::of_other_type, .subjects = {{"kind", "array"}, {"needed", "measured"}, {"in", "N s/m"}}}}},
    {"unit_of_another_kind",
     body_text("damping = \"5 N/m\""),
     {{"f.toml", 4, 11, "body.a.damping"},
      {.code = ProblemCode::unit_of_other_measure,
       .subjects = {{"unit", "N/m"}, {"measure", "damping"}, {"in", "N s/m"}}}}},
    {"unit_of_rotary_motion",
     body_text("stiffness = \"5 N m/deg\""),
     {{"f.toml", 4, 13, "body.a.stiffness"},
      {.code = ProblemCode::unit_of_other_measure,
       .subjects = {{"unit", "N m/deg"}, {"measure", "stiffness"}, {"in", "N/m"}}}}},
    {"number_without_unit",
     body_text("damping = \"5\""),
     {{"f.toml", 4, 11, "body.a.damping"},
      {.code = ProblemCode::number_without_unit, .subjects = {{"text", "5"}, {"in", "N s/m"}}}}},
    {"no_unit",
     body_text("damping = \"5 N s/mile\""),
     {{"f.toml", 4, 11, "body.a.damping"},
      {.code = ProblemCode::unknown_unit, .subjects = {{"unit", "N s/mile"}, {"in", "N s/m"}}}}},
    {"temperature",
     body_text("damping = \"5 N s/m @ 3\""),
     {{"f.toml", 4, 11, "body.a.damping"},
      {.code = ProblemCode::unknown_unit, .subjects = {{"unit", "N s/m @ 3"}, {"in", "N s/m"}}}}},
    {"period_as_a_frequency",
     body_text("") + "[loop]\nsampling_period = \"2.5 kHz\"\n",
     {{"f.toml", 6, 19, "loop.sampling_period"},
      {.code = ProblemCode::unit_of_other_measure,
       .subjects = {{"unit", "kHz"}, {"measure", "time"}, {"period", "0.4 ms"}}}}},
    {"counts_as_a_step",
     "motion = \"rotary\"\n" + body_text("") + loop_text() + "[sensor]\nresolution = \"4096 counts/turn\"\n",
     {{"f.toml", 10, 14, "sensor.resolution"},
      {.code = ProblemCode::unit_of_other_measure,
       .subjects = {{"unit", "counts/turn"}, {"measure", "angle"}, {"step", "1 turn/4096"}}}}},
    {"counts_as_a_linear_step",
     body_text("") + loop_text() + "[sensor]\nresolution = \"200 counts/mm\"\n",
     {{"f.toml", 9, 14, "sensor.resolution"},
      {.code = ProblemCode::unit_of_other_measure,
       .subjects = {{"unit", "counts/mm"}, {"measure", "length"}, {"step", "1 mm/200"}}}}},
    {"period_as_a_frequency_that_no_decimal_inverts",
     body_text("") + "[loop]\nsampling_period = \"3 kHz\"\n",
     {{"f.toml", 6, 19, "loop.sampling_period"},
      {.code = ProblemCode::unit_of_other_measure,
       .subjects = {{"unit", "kHz"}, {"measure", "time"}, {"period", "1 s/3000"}}}}},
    {"unit_out_of_range",
     body_text("damping = \"1e400 N s/m\""),
     {{"f.toml", 4, 11, "body.a.damping"}, {.code = ProblemCode::number_beyond_range}}},
    {"negative_with_unit",
     body_text("damping = \"-3 N s/mm\"") + loop_text(),
     {{"f.toml", 4, 11, "body.a.damping"}, {.code = ProblemCode::no_finite_number, .evidence = {{"value", -3000.0}}}}},
    {"unit_of_an_order",
     body_text("") + loop_text() + "[[wall.filter]]\ntype = \"low_pass\"\nfrequency_hz = 3\norder = \"2 s\"\n",
     {{"f.toml", 11, 9, "wall.filter.0.order"},
      {.code = ProblemCode::of_other_type, .subjects = {{"text", "2 s"}, {"needed", "number"}}}}},
    {"sampling_frequency",
     body_text("") + "[loop]\nsampling_frequency = 2000\n",
     {{"f.toml", 6, 1, "loop.sampling_frequency"},
      {.code = ProblemCode::unknown_key,
       .subjects = {{"name", "sampling_frequency"},
                    {"result", "sampling_period"},
                    {"of", "[loop]"},
                    {"formula", "1/frequency"}}}}},
    {"sample_time_at_the_top",
     "Ts = 1e-3\n" + body_text("") + loop_text(),
     {{"f.toml", 1, 1, "Ts"},
      {.code = ProblemCode::unknown_key, .subjects = {{"name", "Ts"}, {"same", "sampling_period"}, {"of", "[loop]"}}}}},
    {"friction",
     body_text("friction = 1"),
     {{"f.toml", 4, 1, "body.a.friction"},
      {.code = ProblemCode::unknown_key, .subjects = {{"name", "friction"}, {"kinds", "friction"}}}}},
    {"damping_ratio_of_a_link",
     "[[link]]\nbetween = [\"a\", \"b\"]\ndamping_ratio = 0.1\n",
     {{"f.toml", 3, 1, "link.0.damping_ratio"},
      {.code = ProblemCode::unknown_key, .subjects = {{"name", "damping_ratio"}, {"result", "damping"}}}}},
    {"both_velocity_filters",
     body_text("") + loop_text() + "[wall]\nvelocity_filter_hz = 3\nvelocity_filter_tau = 1e-3\n",
     {{"f.toml", 10, 23, "wall.velocity_filter_tau"},
      {.code = ProblemCode::given_beside, .subjects = {{"other", "velocity_filter_hz"}}}}},
    {"time_constant_of_no_cutoff",
     body_text("") + loop_text() + "[wall]\nvelocity_filter_tau = 1e30\n",
     {{"f.toml", 9, 23, "wall.velocity_filter_tau"},
      {.code = ProblemCode::number_beyond_range, .evidence = {{"value", 1e30}}}}},
    {"negative_time_constant",
     body_text("") + loop_text() + "[wall]\nvelocity_filter_tau = -1e-3\n",
     {{"f.toml", 9, 23, "wall.velocity_filter_tau"},
      {.code = ProblemCode::number_beyond_range, .evidence = {{"value", -0.001}}}}},
    {"number_for_text",
     "name = 3\n",
     {{"f.toml", 1, 8, "name"},
      {.code = ProblemCode::of_other_type, .evidence = {{"number", 3.0}}, .subjects = {{"needed", "text"}}}}},
    {"number_for_table",
     "loop = 1.5\n",
     {{"f.toml", 1, 8, "loop"},
      {.code = ProblemCode::of_other_type, .evidence = {{"number", 1.5}}, .subjects = {{"needed", "table"}}}}},
    {"table_for_tables",
     "[body]\nname = \"a\"\n",
     {{"f.toml", 1, 1, "body"},
      {.code = ProblemCode::of_other_type, .subjects = {{"kind", "table"}, {"needed", "tables"}}}}},
    {"number_for_tables",
     "body = [1]\n",
     {{"f.toml", 1, 9, "body"},
      {.code = ProblemCode::of_other_type, .evidence = {{"number", 1.0}}, .subjects = {{"needed", "tables"}}}}},
    {"wrong_motion",
     "motion = \"Linear\"\n" + body_text("") + loop_text(),
     {{"f.toml", 1, 10, "motion"},
      {.code = ProblemCode::not_one_of, .subjects = {{"given", "Linear"}, {"choices", "\"linear\" or \"rotary\""}}}}},
    {"missing_mass",
     "[[body]]\nname = \"a\"\n" + loop_text(),
     {{"f.toml", 1, 1, "body.a.mass"}, {.code = ProblemCode::is_missing, .subjects = {{"needed", "positive"}}}}},
    {"missing_name",
     "\n[[body]]\nmass = 1\n" + loop_text(),
     {{"f.toml", 2, 1, "body.0.name"}, {.code = ProblemCode::is_missing, .subjects = {{"needed", "text"}}}}},
    {"missing_loop",
     body_text(""),
     {{"f.toml", 1, 1, "loop"}, {.code = ProblemCode::is_missing, .subjects = {{"needed", "loop"}}}}},
    {"missing_sampling_period",
     body_text("") + "[loop]\ndelay = 0\n",
     {{"f.toml", 5, 1, "loop.sampling_period"},
      {.code = ProblemCode::is_missing, .subjects = {{"needed", "positive"}}}}},
    {"missing_between",
     body_text("") + "[[link]]\nstiffness = 1\n" + loop_text(),
     {{"f.toml", 5, 1, "link.0.between"}, {.code = ProblemCode::is_missing, .subjects = {{"needed", "bodies"}}}}},
    {"missing_link_stiffness",
     two_body_text + "[[link]]\nbetween = [\"motor\", \"handle\"]\n",
     {{"f.toml", 12, 1, "link.1.stiffness"}, {.code = ProblemCode::is_missing, .subjects = {{"needed", "gain"}}}}},
    {"missing_denominator",
     "[transfer_function]\nnumerator = [1]\n" + loop_text(),
     {{"f.toml", 1, 1, "transfer_function.denominator"},
      {.code = ProblemCode::is_missing, .subjects = {{"needed", "numbers"}}}}},
    {"inertia_of_linear",
     "[[body]]\nname = \"a\"\ninertia = 1\n" + loop_text(),
     {{"f.toml", 3, 11, "body.a.inertia"}, {.code = ProblemCode::inertia_of_linear_motion}}},
    {"mass_and_inertia",
     "motion = \"rotary\"\n" + body_text("inertia = 1") + loop_text(),
     {{"f.toml", 5, 11, "body.a.inertia"}, {.code = ProblemCode::given_beside, .subjects = {{"other", "mass"}}}}},
    {"negative_mass",
     "[[body]]\nname = \"motor\"\nmass = -0.3\n" + loop_text(),
     {{"f.toml", 3, 8, "body.motor.mass"}, {.code = ProblemCode::no_finite_number, .evidence = {{"value", -0.3}}}}},
    {"zero_mass",
     "[[body]]\nname = \"motor\"\nmass = 0\n" + loop_text(),
     {{"f.toml", 3, 8, "body.motor.mass"}, {.code = ProblemCode::no_finite_number, .evidence = {{"value", 0.0}}}}},
    {"nan_mass",
     "[[body]]\nname = \"motor\"\nmass = nan\n" + loop_text(),
     {{"f.toml", 3, 8, "body.motor.mass"},
      {.code = ProblemCode::no_finite_number, .evidence = {{"value", std::nan("")}}}}},
    {"huge_mass",
     "[[body]]\nname = \"motor\"\nmass = 1e308\n" + loop_text(),
     {{"f.toml", 3, 8, "body.motor.mass"}, {.code = ProblemCode::not_between, .evidence = {{"value", 1e+308}}}}},
    {"tiny_damping",
     body_text("damping = 1e-300") + loop_text(),
     {{"f.toml", 4, 11, "body.a.damping"}, {.code = ProblemCode::not_between, .evidence = {{"value", 1e-300}}}}},
    {"infinite_damping",
     body_text("damping = inf") + loop_text(),
     {{"f.toml", 4, 11, "body.a.damping"}, {.code = ProblemCode::no_finite_number, .evidence = {{"value", INFINITY}}}}},
    {"negative_delay",
     body_text("") + loop_text("delay = -1e-3"),
     {{"f.toml", 7, 9, "loop.delay"}, {.code = ProblemCode::no_finite_number, .evidence = {{"value", -0.001}}}}},
    {"endless_delay",
     body_text("") + loop_text("delay = 11"),
     {{"f.toml", 7, 9, "loop.delay"},
      {.code = ProblemCode::delay_of_too_many_periods, .evidence = {{"periods", 11000.0}}}}},
    {"zero_sampling_period",
     body_text("") + "[loop]\nsampling_period = 0.0\n",
     {{"f.toml", 6, 19, "loop.sampling_period"},
      {.code = ProblemCode::no_finite_number, .evidence = {{"value", 0.0}}}}},
    {"zero_force_limit",
     body_text("") + loop_text() + "[actuator]\nforce_limit = 0\n",
     {{"f.toml", 9, 15, "actuator.force_limit"},
      {.code = ProblemCode::no_finite_number, .evidence = {{"value", 0.0}}}}},
    {"same_name_twice",
     body_text("") + body_text("") + loop_text(),
     {{"f.toml", 6, 8, "body.1.name"}, {.code = ProblemCode::names_two_bodies, .subjects = {{"name", "a"}}}}},
    {"empty_name",
     "[[body]]\nname = \"\"\nmass = 1\n" + loop_text(),
     {{"f.toml", 2, 8, "body.0.name"}, {.code = ProblemCode::name_empty}}},
    {"newline_in_name",
     "[[body]]\nname = \"a\\nb\"\nmass = 1\n" + loop_text(),
     {{"f.toml", 2, 8, "body.0.name"}, {.code = ProblemCode::control_character}}},
    {"tied_to_nothing",
     body_text("") + "[[body]]\nname = \"b\"\nmass = 1\n" + loop_text(),
     {{"f.toml", 5, 1, "body.b"}, {.code = ProblemCode::body_not_connected}}},
    {"tied_to_itself",
     body_text("") + "[[link]]\nbetween = [\"a\", \"a\"]\nstiffness = 1\n" + loop_text(),
     {{"f.toml", 6, 11, "link.0.between"}, {.code = ProblemCode::tied_to_itself}}},
    {"link_to_misspelt_body",
     two_body_text + "[[link]]\nbetween = [\"motor\", \"hadnle\"]\nstiffness = 1\n",
     {{"f.toml", 13, 11, "link.1.between"},
      {.code = ProblemCode::no_such_name, .subjects = {{"what", "body"}, {"name", "hadnle"}, {"meant", "handle"}}}}},
    {"link_to_unknown_body",
     two_body_text + "[[link]]\nbetween = [\"motor\", \"wrist\"]\nstiffness = 1\n",
     {{"f.toml", 13, 11, "link.1.between"},
      {.code = ProblemCode::no_such_name,
       .subjects = {{"what", "body"}, {"name", "wrist"}, {"bodies", "motor, handle"}}}}},
    {"link_of_three",
     two_body_text + "[[link]]\nbetween = [\"motor\", \"handle\", \"motor\"]\nstiffness = 1\n",
     {{"f.toml", 13, 11, "link.1.between"}, {.code = ProblemCode::not_two_bodies, .evidence = {{"length", 3.0}}}}},
    {"link_of_numbers",
     two_body_text + "[[link]]\nbetween = [\"motor\", 2]\nstiffness = 1\n",
     {{"f.toml", 13, 21, "link.1.between"},
      {.code = ProblemCode::of_other_type, .evidence = {{"number", 2.0}}, .subjects = {{"needed", "text"}}}}},
    {"link_of_text",
     two_body_text + "[[link]]\nbetween = \"motor\"\nstiffness = 1\n",
     {{"f.toml", 13, 11, "link.1.between"},
      {.code = ProblemCode::of_other_type, .subjects = {{"text", "motor"}, {"needed", "bodies"}}}}},
    {"slack_link",
     two_body_text + "[[link]]\nbetween = [\"motor\", \"handle\"]\nstiffness = 0\n",
     {{"f.toml", 14, 13, "link.1.stiffness"}, {.code = ProblemCode::link_of_nothing}}},
    {"unknown_sensed_body",
     body_text("") + loop_text("sensed = \"b\""),
     {{"f.toml", 7, 10, "loop.sensed"},
      {.code = ProblemCode::no_such_name, .subjects = {{"what", "body"}, {"name", "b"}, {"bodies", "a"}}}}},
    {"both_descriptions",
     body_text("") + transfer_function("[1]", "[1, 2]"),
     {{"f.toml", 1, 1, "body"}, {.code = ProblemCode::beside_transfer_function, .subjects = {{"part", "bodies"}}}}},
    {"operator_of_transfer_function",
     transfer_function("[1]", "[1, 2]") + "[operator]\n",
     {{"f.toml", 7, 1, "operator"},
      {.code = ProblemCode::beside_transfer_function, .subjects = {{"part", "operator"}}}}},
    {"held_of_transfer_function",
     transfer_function("[1]", "[1, 2]") + "held = \"a\"\n",
     {{"f.toml", 7, 8, "loop.held"}, {.code = ProblemCode::beside_transfer_function, .subjects = {{"part", "loop"}}}}},
    {"not_strictly_proper",
     transfer_function("[1, 1]", "[1, 2]"),
     {{"f.toml", 2, 13, "transfer_function.numerator"},
      {.code = ProblemCode::degree_not_lower, .evidence = {{"degree", 1.0}, {"denominator", 1.0}}}}},
    {"zero_numerator",
     transfer_function("[0, 0]", "[1, 2]"),
     {{"f.toml", 2, 13, "transfer_function.numerator"}, {.code = ProblemCode::all_coefficients_zero}}},
    {"padded_numerator",
     transfer_function("[0, 0, 1]", "[1, 2]"),
     {{"f.toml", 2, 13, "transfer_function.numerator"}, {.code = ProblemCode::longer_than_denominator}}},
    {"zero_leading_denominator",
     transfer_function("[1]", "[0, 1, 2]"),
     {{"f.toml", 3, 15, "transfer_function.denominator"}, {.code = ProblemCode::begins_with_zero}}},
    {"empty_numerator",
     transfer_function("[]", "[1, 2]"),
     {{"f.toml", 2, 13, "transfer_function.numerator"},
      {.code = ProblemCode::number_of_coefficients, .evidence = {{"count", 0.0}}}}},
    {"nan_coefficient",
     transfer_function("[nan]", "[1, 2]"),
     {{"f.toml", 2, 13, "transfer_function.numerator"},
      {.code = ProblemCode::coefficient_out_of_range, .evidence = {{"value", std::nan("")}}}}},
    {"text_coefficient",
     transfer_function("[1, \"x\"]", "[1, 2, 3]"),
     {{"f.toml", 2, 17, "transfer_function.numerator"},
      {.code = ProblemCode::of_other_type, .subjects = {{"text", "x"}, {"needed", "number"}}}}},
};

INSTANTIATE_TEST_SUITE_P(DeviceFile, RefusedText, testing::ValuesIn(texts),
                         [](const auto& test) { return test.param.name; });

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
  EXPECT_EQ(refused_keys("[[body]]\nname = \"a\"\nmas = 1\n" + loop_text()), Keys{"body.a.mas"});
  EXPECT_EQ(refused_keys(body_text("") + "[lop]\nsampling_period = 1\n"), Keys{"lop"});
  EXPECT_EQ(refused_keys("[[body]]\nname = \"a\"\n[[body]]\nmass = 1\n" + loop_text()),
            (Keys{"body.a.mass", "body.1.name"}));
  EXPECT_EQ(refused_keys(""), Keys{"body"});
  // How the bodies hang together is judged where the links are read.
  EXPECT_EQ(refused_keys(two_body_text + "[[link]]\nbetween = [\"motor\", \"hand\"]\nstiffness = \"x\"\n"),
            (Keys{"link.1.between", "link.1.stiffness"}));
  EXPECT_EQ(refused_keys(body_text("") + loop_text() + "[[wall.filter]]\ntype = \"nich\"\n"),
            Keys{"wall.filter.0.type"});
  EXPECT_EQ(refused_keys(body_text("") + loop_text(), {"loop.dely=1", "loop.delay"}), (Keys{"loop.dely", ""}));
  // No answer is longer than a screen or two.
  std::string many = body_text("") + loop_text();
  for (int i = 0; i < 5000; ++i) many += fmt::format("x{} = 1\n", i);
  EXPECT_EQ(refused_keys(many).size(), 100U);
}

TEST(DeviceFile, AnInertiaIsRefusedByItsName) {
  const auto device =
      parse_device("motion = \"rotary\"\n[[body]]\nname = \"a\"\ninertia = -1\n" + loop_text(), "f.toml");
  ASSERT_FALSE(device.has_value());
  EXPECT_EQ(device.error().place.key, "body.a.inertia");
  EXPECT_EQ(device.error().place.line, 4U);
}

TEST(DeviceFile, DeepKeysAreRefusedBeforeTheyNest) {
  std::string key = "a";
  for (int i = 0; i < 200'000; ++i) key += ".a";
  const auto device = parse_device(key + " = 1", "f.toml");
  ASSERT_FALSE(device.has_value());
  test::expect_refused(device.error(),
                       {{"f.toml", 1, 1}, {.code = ProblemCode::too_many_dots, .evidence = {{"most", 200.0}}}});
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
  const auto device = parse_device(text + loop_text(), "f.toml");
  ASSERT_FALSE(device.has_value());
  test::expect_refused(device.error(),
                       {{"f.toml", 1, 1, "body"},
                        {.code = ProblemCode::stands_too_often, .evidence = {{"count", 2000.0}, {"most", 100.0}}}});
}

}  // namespace
}  // namespace zwidth
