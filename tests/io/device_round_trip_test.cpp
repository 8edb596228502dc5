// Properties over random devices and random bytes. Seeds are fixed and shown on failure.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "io/device_texts.hpp"
#include "zwidth/error.hpp"
#include "zwidth/io/device_file.hpp"

namespace zwidth {
namespace {

using Random = std::mt19937_64;

std::size_t index_below(Random& random, std::size_t count) {
  return std::uniform_int_distribution<std::size_t>(0, count - 1)(random);
}

/// Over all magnitudes that a device may have.
double positive(Random& random) { return std::pow(10.0, std::uniform_real_distribution(-29.9, 29.9)(random)); }
double not_negative(Random& random) { return index_below(random, 3) == 0 ? 0.0 : positive(random); }

std::string random_name(Random& random, std::size_t number) {
  static const std::vector<std::string> pieces{"motor", "é", "\"", "\\", ".", " ", "#", "日本", "'", "=", "]", "0"};
  std::string name = std::to_string(number);  // keeps names different
  for (std::size_t i = index_below(random, 5); i > 0; --i) name += pieces[index_below(random, pieces.size())];
  return name;
}

void add_bodies(Random& random, DeviceParameters& device) {
  const std::size_t count = 1 + index_below(random, 6);
  for (std::size_t i = 0; i < count; ++i) {
    device.bodies.push_back({.name = random_name(random, i),
                             .mass = positive(random),
                             .damping = not_negative(random),
                             .stiffness = not_negative(random),
                             .coulomb = not_negative(random)});
    if (i > 0) {
      device.links.push_back({.first = i,
                              .second = index_below(random, i),
                              .stiffness = positive(random),
                              .damping = not_negative(random)});
    }
  }
  device.loop.actuated = index_below(random, count);
  device.loop.sensed = index_below(random, count);
  device.loop.held = index_below(random, count);
  device.user = {not_negative(random), not_negative(random), not_negative(random)};
}

void add_transfer_function(Random& random, DeviceParameters& device) {
  const std::size_t degree = 1 + index_below(random, 6);
  TransferFunction transfer;
  for (std::size_t i = 0; i < degree; ++i) transfer.numerator.push_back(not_negative(random));
  transfer.numerator.back() = -positive(random);
  for (std::size_t i = 0; i <= degree; ++i)
    transfer.denominator.push_back(i == 0 ? positive(random) : -not_negative(random));
  device.transfer_function = transfer;
}

double coefficient(Random& random) { return std::pow(10.0, std::uniform_real_distribution(-90.0, 90.0)(random)); }

/// Only with the members that its type has.
WallFilter random_filter(Random& random, double sampling_period) {
  using enum WallFilter::Kind;
  WallFilter filter;
  filter.kind = static_cast<WallFilter::Kind>(index_below(random, 5));
  const auto between = [&](double least, double greatest) {
    return std::exp(std::uniform_real_distribution(std::log(least), std::log(greatest))(random));
  };
  if (filter.kind == biquad || filter.kind == digital) {
    filter.denominator = filter.kind == digital ? std::vector{2.0, -between(0.01, 1.99)}
                                                : std::vector{coefficient(random), coefficient(random)};
    filter.numerator = {0.0, coefficient(random)};
    if (filter.kind == digital || index_below(random, 2) == 0) return filter;
  }
  filter.frequency_hz = between(1e-2, 0.99) * 0.5 / sampling_period;
  if (filter.kind == low_pass) filter.order = index_below(random, 2) == 0 ? 1 : 2;
  if (filter.kind == notch || filter.order == 2) filter.damping_ratio = between(1e-5, 1e2);
  if (filter.kind == notch) filter.depth = between(1e-5, 1.0);
  if (filter.kind == lead_lag) filter.ratio = between(1e-5, 1e5);
  return filter;
}

DeviceParameters random_device(Random& random) {
  DeviceParameters device;
  device.name = random_name(random, 0);
  device.motion = index_below(random, 2) == 0 ? Motion::linear : Motion::rotary;
  if (index_below(random, 4) == 0) {
    add_transfer_function(random, device);
  } else {
    add_bodies(random, device);
  }
  device.loop.sampling_period = positive(random);
  if (index_below(random, 2) == 0) {
    device.loop.delay =
        std::min(1e30, device.loop.sampling_period * std::uniform_real_distribution(1.0, 9999.0)(random));
  }
  device.actuator.time_constant = not_negative(random);
  if (index_below(random, 2) == 0) device.actuator.force_limit = positive(random);
  device.sensor.resolution = not_negative(random);
  if (index_below(random, 2) == 0) device.wall.stiffness = not_negative(random);
  device.wall.damping = not_negative(random);
  device.wall.velocity_filter_hz = not_negative(random);
  if (device.loop.sampling_period < 1e25) {  // beyond, the Nyquist frequency is less than a filter may have
    const std::size_t filters = std::max<std::size_t>(index_below(random, 6), 2) - 2;
    for (std::size_t i = 0; i < filters; ++i) {
      device.wall.filters.push_back(random_filter(random, device.loop.sampling_period));
    }
  }
  return device;
}

bool same(const Body& a, const Body& b) {
  return a.name == b.name && a.mass == b.mass && a.damping == b.damping && a.stiffness == b.stiffness &&
         a.coulomb == b.coulomb;
}
bool same(const Link& a, const Link& b) {
  return a.first == b.first && a.second == b.second && a.stiffness == b.stiffness && a.damping == b.damping;
}

void expect_same(const DeviceParameters& a, const DeviceParameters& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.motion, b.motion);
  EXPECT_TRUE(std::ranges::equal(a.bodies, b.bodies, [](const Body& x, const Body& y) { return same(x, y); }));
  EXPECT_TRUE(std::ranges::equal(a.links, b.links, [](const Link& x, const Link& y) { return same(x, y); }));
  ASSERT_EQ(a.transfer_function.has_value(), b.transfer_function.has_value());
  if (a.transfer_function) {
    EXPECT_EQ(a.transfer_function->numerator, b.transfer_function->numerator);
    EXPECT_EQ(a.transfer_function->denominator, b.transfer_function->denominator);
  }
  EXPECT_EQ(a.loop.actuated, b.loop.actuated);
  EXPECT_EQ(a.loop.sensed, b.loop.sensed);
  EXPECT_EQ(a.loop.held, b.loop.held);
  EXPECT_EQ(a.loop.sampling_period, b.loop.sampling_period);
  EXPECT_EQ(a.loop.delay, b.loop.delay);
  EXPECT_EQ(a.actuator.time_constant, b.actuator.time_constant);
  EXPECT_EQ(a.actuator.force_limit, b.actuator.force_limit);
  EXPECT_EQ(a.sensor.resolution, b.sensor.resolution);
  EXPECT_EQ(a.wall.stiffness, b.wall.stiffness);
  EXPECT_EQ(a.wall.damping, b.wall.damping);
  EXPECT_EQ(a.wall.velocity_filter_hz, b.wall.velocity_filter_hz);
  EXPECT_TRUE(a.wall.filters == b.wall.filters);
  EXPECT_EQ(a.user.mass, b.user.mass);
  EXPECT_EQ(a.user.damping, b.user.damping);
  EXPECT_EQ(a.user.stiffness, b.user.stiffness);
}

TEST(DeviceRoundTrip, WrittenDevicesReadBackExactly) {
  for (unsigned seed = 1; seed <= 2000; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    const DeviceParameters device = random_device(random);
    const std::string text = write_device(device);
    const auto again = parse_device(text, "written.toml");
    ASSERT_TRUE(again.has_value()) << again.error().str() << "\n" << text;
    expect_same(device, again->parameters());
    if (HasFailure()) return;
  }
}

TEST(DeviceRoundTrip, ImpossibleParametersAreNotWritten) {
  EXPECT_THROW((void)write_device(DeviceParameters{}), Error);
}

/// A refusal must be complete: one line, with a reason, at a place.
void expect_proper(const InputError& error) {
  const std::string message = error.str();
  EXPECT_FALSE(error.what.empty());
  EXPECT_EQ(message.find('\n'), std::string::npos);
  EXPECT_TRUE(error.place.file == "an override" || error.place.line > 0) << message;
}

TEST(DeviceReader, SurvivesDamagedFiles) {
  using namespace std::string_literals;
  static const std::string letters = "\0\n\r\t \"'#.,=[]{}-+_eE0159axn\\\x7f\x80\xc3\xa9\xef\xff"s;
  std::size_t refused = 0;
  for (unsigned seed = 1; seed <= 5000; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    std::string text = full_device_text;
    for (std::size_t edits = 1 + index_below(random, 8); edits > 0; --edits) {
      const std::size_t at = index_below(random, text.size());
      switch (index_below(random, 3)) {
        case 0:
          text[at] = letters[index_below(random, letters.size())];
          break;
        case 1:
          text.erase(at, 1 + index_below(random, 10));
          break;
        default:
          text.insert(at, 1, letters[index_below(random, letters.size())]);
      }
    }
    const auto device = parse_device(text, "damaged.toml");
    if (device) continue;
    ++refused;
    expect_proper(device.error());
    if (HasFailure()) return;
  }
  EXPECT_GT(refused, 2500U);  // else the damage is not worth the name
}

TEST(DeviceReader, SurvivesAnyBytes) {
  for (unsigned seed = 1; seed <= 2000; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    std::string bytes(index_below(random, 200), '\0');
    for (char& byte : bytes) byte = static_cast<char>(index_below(random, 256));
    const std::vector<std::string> overrides{bytes};
    const auto as_text = parse_device(bytes, "bytes");
    const auto as_override = parse_device(small_device_text, "small.toml", overrides);
    ASSERT_FALSE(as_text.has_value());
    expect_proper(as_text.error());
    if (!as_override) expect_proper(as_override.error());
    if (HasFailure()) return;
  }
}

}  // namespace
}  // namespace zwidth
