// Slips of writing in a device file: each is answered with the value to put.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "io/device_texts.hpp"
#include "zwidth/io/device_file.hpp"

namespace zwidth {
namespace {

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
    {"unit_without_quotes", body_text("") + loop_text("delay = 0.5 ms  # more"), 7, 9, "loop.delay", "0.5 ms"},
    {"frequency_without_quotes", body_text("") + "[loop]\nsampling_period = 2 kHz\n", 6, 19, "loop.sampling_period",
     "0.5 ms"},
    {"word_without_quotes", body_text("") + loop_text("sensed = a"), 7, 10, "loop.sensed", "a"},
    {"decimal_comma", body_of("0,5") + loop_text(), 3, 8, "body.a.mass", "0.5"},
    {"decimal_comma_with_unit", body_of("0,5 kg") + loop_text(), 3, 8, "body.a.mass", "0.5 kg"},
    {"decimal_comma_in_quotes", body_of("\"0,5 kg\"") + loop_text(), 3, 8, "body.a.mass", "0.5 kg"},
    {"thousands_or_thousandths", body_of("1,000") + loop_text(), 3, 8, "body.a.mass", ""},
    {"second_body", body_text("") + "[[body]]\nmass = 0,25\n" + loop_text(), 6, 8, "body.1.mass", "0.25"},
    {"gram_square_centimetre", of_rotary + body_of("\"22 gcm2\"") + loop_text(), 4, 8, "body.a.mass", "22 g cm2"},
    {"kilogram_square_metre", of_rotary + body_of("\"0.1 kgm2\"") + loop_text(), 4, 8, "body.a.mass", "0.1 kg m2"},
    {"newton_second_metre", body_text("damping = \"5 Ns/m\"") + loop_text(), 4, 11, "body.a.damping", "5 N s/m"},
    {"unit_that_is_none", body_text("damping = \"5 furlong\"") + loop_text(), 4, 11, "body.a.damping", ""},
    {"frequency_for_a_period", body_text("") + "[loop]\nsampling_period = \"2 kHz\"\n", 6, 19, "loop.sampling_period",
     "0.5 ms"},
    {"counts_for_a_step", body_text("") + loop_text() + "[sensor]\nresolution = \"200 counts/mm\"\n", 9, 14,
     "sensor.resolution", "1 mm/200"},
    {"misspelt_body", two_body_text + "[wall]\nstiffness = 1\n[operator]\nmas = 1\n", 15, 1, "operator.mas", ""},
    {"motion", "motion = \"Rotary\"\n" + body_of("\"22 g cm^2\"") + loop_text(), 1, 10, "motion", "rotary"},
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

}  // namespace
}  // namespace zwidth
