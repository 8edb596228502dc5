// The words of drives that cannot be used, from codes and numbers.

#include "zwidth/words/drive_problem_text.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string_view>

#include "zwidth/error.hpp"

namespace zwidth {
namespace {

using enum DriveProblemCode;

TEST(DriveProblemText, EveryCodeHasWordsOfItsOwnName) {
  std::set<std::string_view> names;
  constexpr auto count = static_cast<unsigned>(last_drive_problem) + 1;
  for (unsigned i = 0; i < count; ++i) names.insert(name_of(static_cast<DriveProblemCode>(i)));
  EXPECT_EQ(names.size(), count) << "a name stands twice";
  EXPECT_THROW((void)name_of(static_cast<DriveProblemCode>(count)), Error);
}

TEST(DriveProblemText, HasTheRemedyBehindIt) {
  EXPECT_EQ(text({not_a_serial_port}), "is no serial port");
  EXPECT_EQ(text({no_port_named}), "names no port; a serial port, such as /dev/ttyUSB0");
  EXPECT_EQ(text({speed_unknown, {{"baud", 7.0}}, {{"known", "8, 9"}}}), "driver.baud is 7; one of 8, 9");
  EXPECT_THROW((void)text({speed_unknown}), Error) << "a number is missing";
}

TEST(DriveProblemText, NamesTheRangeOfEachDrive) {
  const auto refused = [](const char* drive) {
    return text({id_out_of_range, {{"id", 200.0}, {"least", 0.0}, {"most", 62.0}}, {{"drive", drive}}});
  };
  EXPECT_EQ(refused("odrive"), "driver.id is 200; an ODrive has the axes 0 and 62");
  EXPECT_EQ(refused("moteus"), "driver.id is 200; a moteus has 0 to 62");
  EXPECT_EQ(refused("vesc-can"), "driver.id is 200; 0 to 62, the next one is this program's");
  EXPECT_EQ(refused("odrive-can"), "driver.id is 200; 0 to 62, the axis's node id");
}

TEST(DriveProblemText, GivesErrorsInHexadecimal) {
  EXPECT_EQ(text({odrive_fault, {{"axis", 0.0}, {"error", 2049.0}, {"watchdog", 1.0}}}),
            "axis 0 stands on error 0x801, its watchdog's among them; find its cause with odrivetool (dump_errors), "
            "then clear it");
  EXPECT_EQ(text({odrive_fault, {{"node", 5.0}, {"error", 1.0 * 0xffffffffU}}}),
            "node 5 stands on error 0xffffffff; find its cause with odrivetool (dump_errors), then clear it");
}

TEST(DriveProblemText, TellsTheModesOfAMoteusApart) {
  const auto let_go = [](double mode) { return text({moteus_let_go, {{"id", 1.0}, {"mode", mode}}}); };
  EXPECT_EQ(let_go(0.0), "moteus 1 has let go: it is in mode 0, stopped");
  EXPECT_EQ(let_go(11.0),
            "moteus 1 has let go: it is in mode 11, its watchdog's; the loop is too slow, or the line too busy");
  EXPECT_EQ(let_go(12.0),
            "moteus 1 has let go: it is in mode 12, zero velocity: another host commands it; end that one");
  EXPECT_EQ(let_go(15.0), "moteus 1 has let go: it is in mode 15, brake: another host commands it; end that one");
  EXPECT_EQ(let_go(5.0), "moteus 1 has let go: it is in mode 5");
}

TEST(DriveProblemText, NamesAFasterLineWhereThereIsOne) {
  DriveProblem slow{
      line_too_slow,
      {{"bytes", 20.0}, {"baud", 9600.0}, {"carried_hz", 38.0}, {"wanted_hz", 1000.0}, {"period", 0.026}}};
  EXPECT_EQ(text(slow),
            "the line is too slow: 20 bytes per cycle at 9600 Bd leave 38 Hz at most, the loop runs at 1000 Hz; "
            "loop.sampling_period to 0.026 s or more");
  slow.evidence.push_back({"sufficient_baud", 460800.0});
  EXPECT_EQ(text(slow),
            "the line is too slow: 20 bytes per cycle at 9600 Bd leave 38 Hz at most, the loop runs at 1000 Hz; "
            "set the drive and driver.baud to 460800 or more, or loop.sampling_period to 0.026 s or more");
}

}  // namespace
}  // namespace zwidth
