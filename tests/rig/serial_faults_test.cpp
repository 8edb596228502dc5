// The program as a real process against emulated drives on pseudo-terminals, and what goes wrong between them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>

#include "rig/drive_kinds.hpp"
#include "rig/pty_emulator.hpp"
#include "rig/rig_host.hpp"
#include "rig/serial_device.hpp"
#include "zwidth/io/device_file.hpp"

namespace zwidth::rig {
namespace {

using namespace std::chrono_literals;
using test::DriveKind;
using test::EmulatedMotor;
using test::Host;
using test::PtyEmulator;
using test::times;
using test::within;
using testing::AnyOf;
using testing::HasSubstr;
using Fault = PtyEmulator::Fault;

constexpr double period = 0.04;       // s: machines that tests run on pause for many milliseconds
constexpr int most_cycles_after = 4;  // with a force: three, and one that was under way

class DriveFault : public testing::TestWithParam<DriveKind> {
 protected:
  void SetUp() override {
    std::string name = (std::filesystem::temp_directory_path() / "zwidth_drive_XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder = name;
    setenv("XDG_STATE_HOME", (folder / "state").c_str(), 1);
    std::ofstream(folder / "device.toml") << write_device(device.parameters());
  }
  void TearDown() override { std::filesystem::remove_all(folder); }

  [[nodiscard]] Host host(const PtyEmulator& emulator, const std::string& name = "host") const {
    return Host(folder, std::string(GetParam().name) + ":" + emulator.path(), name, folder / (name + ".csv"),
                GetParam().has_watchdog ? std::vector<std::string>{} : std::vector<std::string>{"--no-watchdog"});
  }
  /// Whether it runs, with a force. It may also have stopped by itself: a machine that pauses for three periods stops any
  /// rig. That is tried again, three times at most; one that does not get as far as its first cycle has failed.
  [[nodiscard]] bool runs(const PtyEmulator& emulator, Host& rig) {
    const auto has_force = [&] { return emulator.motor().nonzero_forces() > 5; };
    if (within(20s, [&] { return has_force() || rig.has_ended(); }) && has_force()) return true;
    EXPECT_THAT(rig.errors(),
                AnyOf(HasSubstr("came late"), HasSubstr("stood still"), HasSubstr("brought no position")));
    EXPECT_LT(++pauses, 4) << rig.errors();
    return false;
  }

  /// The record is there as a whole: rows of seven numbers, the last of them without a force.
  void expect_whole_record() const {
    std::ifstream file(folder / "host.csv");
    std::string line;
    std::string last;
    int rows = -1;
    while (std::getline(file, line)) {
      EXPECT_EQ(std::count(line.begin(), line.end(), ','), 6) << line;
      last = line;
      ++rows;
    }
    EXPECT_GT(rows, 3);
    EXPECT_EQ(std::stod(last.substr(last.find(',') + 1)), 0.0) << last;
  }

  /// The rig runs, with a force; then comes `fault`, and the rig stops by itself.
  void expect_stop(const std::function<void(PtyEmulator&, Host&)>& fault, const std::string& reason) {
    for (int i = 0; i < times(1); ++i) {
      PtyEmulator emulator(GetParam().firmware(), device, {.is_paced = true});
      Host rig = host(emulator);
      if (!runs(emulator, rig)) {
        if (HasFailure()) return;
        --i;
        continue;
      }
      const int forces_before = emulator.motor().nonzero_forces();
      fault(emulator, rig);
      EXPECT_EQ(rig.status(), 1) << rig.errors();
      EXPECT_LE(emulator.motor().nonzero_forces() - forces_before, most_cycles_after) << "run " << i;
      // A machine that pauses for three periods stops the rig too, and earlier; one that hands on what came over the line
      // that late does so by its missing positions.
      EXPECT_THAT(rig.errors(), AnyOf(HasSubstr(reason), HasSubstr("came late"), HasSubstr("stood still"),
                                      HasSubstr("brought no position")));
      if (GetParam().has_watchdog) {
        EXPECT_TRUE(within(5s, [&] { return emulator.motor().force() == 0.0; })) << "run " << i;
      }
      expect_whole_record();
      if (HasFailure()) return;
    }
  }

  const Device device = test::belt_device_of(GetParam(), period);
  std::filesystem::path folder;
  int pauses = 0;  // of the machine, which stopped a rig before its fault: it is tried again
};

TEST_P(DriveFault, AKilledHostLeavesTheDriveToItsWatchdog) {
  for (int i = 0; i < times(1); ++i) {
    PtyEmulator emulator(GetParam().firmware(), device, {.is_paced = true});
    Host rig = host(emulator);
    if (!runs(emulator, rig)) {
      if (HasFailure()) return;
      --i;
      continue;
    }
    const int let_go_before = emulator.motor().times_let_go();
    rig.send(SIGKILL);
    EXPECT_EQ(rig.status(), -1);
    EXPECT_FALSE(std::filesystem::exists(folder / "host.csv")) << "whole or not at all";
    if (!GetParam().has_watchdog) {  // why it is refused unless told
      std::this_thread::sleep_for(300ms);
      EXPECT_NE(emulator.motor().force(), 0.0);
      continue;
    }
    EXPECT_TRUE(within(5s, [&] { return emulator.motor().times_let_go() > let_go_before; }));
    EXPECT_EQ(emulator.motor().force(), 0.0);
  }
}

TEST_P(DriveFault, UnpluggedLink) {
  expect_stop([](PtyEmulator& drive, Host&) { drive.set_fault(Fault::unplugged); }, "brought no position");
}
TEST_P(DriveFault, NoAnswers) {
  expect_stop([](PtyEmulator& drive, Host&) { drive.set_fault(Fault::silent); }, "brought no position");
}
TEST_P(DriveFault, HalfFrames) {
  expect_stop([](PtyEmulator& drive, Host&) { drive.set_fault(Fault::half_frames); }, "brought no position");
}
TEST_P(DriveFault, WrongChecksums) {
  if (!GetParam().has_checksums) return;  // there is nothing to be wrong
  expect_stop([](PtyEmulator& drive, Host&) { drive.set_fault(Fault::wrong_checksum); }, "brought no position");
}
TEST_P(DriveFault, AStalledReader) {
  expect_stop([](PtyEmulator& drive, Host&) { drive.set_fault(Fault::stalled); }, "brought no position");
}
TEST_P(DriveFault, LateAnswers) {
  expect_stop([](PtyEmulator& drive, Host&) { drive.set_fault(Fault::late); }, "brought no position");
}
TEST_P(DriveFault, APositionThatIsNoNumber) {
  if (!GetParam().has_nan) return;  // its positions are whole numbers
  expect_stop([](PtyEmulator& drive, Host&) { drive.set_fault(Fault::not_a_number); }, "not a number");
}
TEST_P(DriveFault, ADriveThatFails) {
  if (!GetParam().has_watchdog) return;  // nor does it tell of faults
  expect_stop([](PtyEmulator& drive, Host&) { drive.set_fault(Fault::failed_drive); }, "stands on");
}
TEST_P(DriveFault, AnInterrupt) {
  expect_stop([](PtyEmulator&, Host& rig) { rig.send(SIGINT); }, "interrupted");
}

TEST_P(DriveFault, ASecondRigOnThePort) {
  for (int i = 0; i < times(1); ++i) {
    PtyEmulator emulator(GetParam().firmware(), device, {.is_paced = true});
    Host rig = host(emulator);
    if (!runs(emulator, rig)) {
      if (HasFailure()) return;
      --i;
      continue;
    }
    Host other = host(emulator, "other");
    EXPECT_EQ(other.status(), 1);
    EXPECT_THAT(other.errors(), HasSubstr("another rig"));
    const int forces = emulator.motor().nonzero_forces();
    EXPECT_TRUE(within(5s, [&] { return emulator.motor().nonzero_forces() > forces; })) << "the first goes on";
    rig.send(SIGINT);
    EXPECT_EQ(rig.status(), 1);
    EXPECT_TRUE(within(5s, [&] { return emulator.motor().force() == 0.0; }));
    expect_whole_record();
  }
}

TEST_P(DriveFault, FirmwareWithoutAWatchdogIsRefused) {
  PtyEmulator emulator(GetParam().firmware(), device);
  emulator.set_fault(Fault::no_watchdog);
  Host rig(folder, std::string(GetParam().name) + ":" + emulator.path(), "host", folder / "host.csv");
  EXPECT_EQ(rig.status(), 1);
  EXPECT_THAT(rig.errors(), HasSubstr("--no-watchdog"));
  EXPECT_EQ(emulator.motor().nonzero_forces(), 0);
}

INSTANTIATE_TEST_SUITE_P(Serial, DriveFault, testing::ValuesIn(test::drive_kinds),
                         [](const auto& kind) { return std::string(kind.param.name); });
INSTANTIATE_TEST_SUITE_P(Can, DriveFault, testing::ValuesIn(test::can_drive_kinds), test::name_of_bus_drive);

}  // namespace
}  // namespace zwidth::rig
