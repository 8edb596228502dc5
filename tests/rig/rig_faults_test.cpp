// The program as a real process against a drive on a real socket, and what goes wrong between them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "rig/printing_process.hpp"
#include "rig/rig_host.hpp"
#include "rig/udp_emulator.hpp"
#include "zwidth/io/device_file.hpp"

namespace zwidth::rig {
namespace {

using namespace std::chrono_literals;
using test::Host;
using test::times;
using test::UdpEmulator;
using test::within;
using Fault = UdpEmulator::Fault;
using testing::AnyOf;
using testing::HasSubstr;

constexpr double period = 0.05;  // s: machines that tests run on pause for many milliseconds

constexpr int most_cycles_after = 4;  // with a force: three, and one that was under way

Device slow_device() {
  DeviceParameters parameters;
  parameters.name = "slow device";
  parameters.bodies.push_back({"body", 2.0, 8.0, 0.0, 0.0});
  parameters.loop.sampling_period = period;
  parameters.wall.stiffness = 20.0;
  parameters.actuator.force_limit = 20.0;
  return Device(parameters);
}

class RigFault : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (std::filesystem::temp_directory_path() / "zwidth_rig_XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder = name;
    setenv("XDG_STATE_HOME", (folder / "state").c_str(), 1);
    std::ofstream(folder / "device.toml") << write_device(slow_device().parameters());
  }
  void TearDown() override { std::filesystem::remove_all(folder); }

  /// Whether it runs, with a force. A machine that pauses for three periods stops any rig: that is tried again, three
  /// times at most.
  [[nodiscard]] bool runs(const UdpEmulator& emulator, Host& host) {
    const auto has_force = [&] { return emulator.nonzero_forces() > 5; };
    if (within(20s, [&] { return has_force() || host.has_ended(); }) && has_force()) return true;
    EXPECT_THAT(host.errors(),
                AnyOf(HasSubstr("came late"), HasSubstr("stood still"), HasSubstr("brought no position")));
    EXPECT_LT(++pauses, 4) << host.errors();
    return false;
  }

  /// The record is there as a whole: a header, rows of seven numbers, the last of them without a force.
  void expect_whole_record() const {
    std::ifstream file(folder / "record.csv");
    std::string line;
    ASSERT_TRUE(std::getline(file, line));
    EXPECT_EQ(line, "time_s,force,position,velocity,wanted_force,latency_s,stop");
    std::string last;
    int rows = 0;
    while (std::getline(file, line)) {
      EXPECT_EQ(std::count(line.begin(), line.end(), ','), 6) << line;
      last = line;
      ++rows;
    }
    EXPECT_GT(rows, 3);
    std::stringstream cells(last);
    std::string time;
    std::string force;
    std::getline(std::getline(cells, time, ','), force, ',');
    EXPECT_EQ(std::stod(force), 0.0) << last;
  }
  void expect_no_crumbs() const {
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      EXPECT_THAT(entry.path().filename().string(),
                  AnyOf("device.toml", "record.csv", "host.errors", "other.errors", "udp_drive"));
    }
  }

  /// The rig runs, with a force; then comes `fault`, and the rig stops by itself.
  void expect_stop(const std::function<void(UdpEmulator&, Host&)>& fault, const testing::Matcher<std::string>& reason) {
    for (int i = 0; i < times(5); ++i) {
      UdpEmulator emulator(slow_device());
      Host host(folder, "udp:" + emulator.address(), "host", folder / "record.csv");
      if (!runs(emulator, host)) {
        if (HasFailure()) return;
        --i;
        continue;
      }
      const int forces_before = emulator.nonzero_forces();
      fault(emulator, host);
      EXPECT_EQ(host.status(), 1) << host.errors();
      EXPECT_LE(emulator.nonzero_forces() - forces_before, most_cycles_after) << "run " << i;
      EXPECT_THAT(host.errors(), reason);
      emulator.set_fault(Fault::none);
      EXPECT_TRUE(within(5s, [&] { return emulator.force() == 0.0; })) << "run " << i;
      expect_whole_record();
      expect_no_crumbs();
      if (HasFailure()) return;
    }
  }

  /// A machine that pauses for three periods stops the rig too, and earlier.
  static testing::Matcher<std::string> stopped_by(const std::string& reason) {
    return AnyOf(HasSubstr(reason), HasSubstr("came late"), HasSubstr("stood still"));
  }

  std::filesystem::path folder;
  int pauses = 0;  // of the machine, before a fault
};

TEST_F(RigFault, AKilledHostLeavesTheDriveToItsWatchdog) {
  for (int i = 0; i < times(5); ++i) {
    UdpEmulator emulator(slow_device());
    Host host(folder, "udp:" + emulator.address(), "host", folder / "record.csv");
    if (!runs(emulator, host)) {
      if (HasFailure()) return;
      --i;
      continue;
    }
    const int let_go_before = emulator.times_let_go();
    host.send(SIGKILL);
    EXPECT_EQ(host.status(), -1);
    EXPECT_TRUE(within(5s, [&] { return emulator.times_let_go() > let_go_before; }));
    EXPECT_EQ(emulator.force(), 0.0);
    EXPECT_FALSE(std::filesystem::exists(folder / "record.csv")) << "whole or not at all";
    expect_no_crumbs();
  }
}

TEST_F(RigFault, UnpluggedLink) {
  expect_stop([](UdpEmulator& drive, Host&) { drive.set_fault(Fault::silent); }, stopped_by("brought no position"));
}
TEST_F(RigFault, HalfFrames) {
  expect_stop([](UdpEmulator& drive, Host&) { drive.set_fault(Fault::half_frames); },
              stopped_by("brought no position"));
}
TEST_F(RigFault, WrongChecksums) {
  expect_stop([](UdpEmulator& drive, Host&) { drive.set_fault(Fault::wrong_checksum); },
              stopped_by("brought no position"));
}
TEST_F(RigFault, AStalledReader) {
  expect_stop([](UdpEmulator& drive, Host&) { drive.set_fault(Fault::stalled); }, stopped_by("brought no position"));
}
TEST_F(RigFault, LateAnswers) {
  expect_stop([](UdpEmulator& drive, Host&) { drive.set_fault(Fault::late); }, stopped_by("brought no position"));
}
TEST_F(RigFault, APositionThatIsNoNumber) {
  expect_stop([](UdpEmulator& drive, Host&) { drive.set_fault(Fault::not_a_number); }, stopped_by("not a number"));
}
TEST_F(RigFault, AnInterrupt) {
  expect_stop([](UdpEmulator&, Host& host) { host.send(SIGINT); }, stopped_by("interrupted"));
}
TEST_F(RigFault, ATermination) {
  expect_stop([](UdpEmulator&, Host& host) { host.send(SIGTERM); }, stopped_by("interrupted"));
}
TEST_F(RigFault, ATerminalThatCloses) {
  expect_stop([](UdpEmulator&, Host& host) { host.send(SIGHUP); }, stopped_by("interrupted"));
}
// Ctrl-Z put the program to sleep, with its force on a drive that has no watchdog; Ctrl-\ lost the record.
TEST_F(RigFault, APutToSleep) {
  expect_stop([](UdpEmulator&, Host& host) { host.send(SIGTSTP); }, stopped_by("interrupted"));
}
TEST_F(RigFault, AQuit) {
  expect_stop([](UdpEmulator&, Host& host) { host.send(SIGQUIT); }, stopped_by("interrupted"));
}
TEST_F(RigFault, AHostThatIsHeldUpBeyondThreeCycles) {
  expect_stop(
      [](UdpEmulator&, Host& host) {
        host.send(SIGSTOP);
        std::this_thread::sleep_for(400ms);
        host.send(SIGCONT);
      },
      AnyOf(HasSubstr("came late"), HasSubstr("stood still")));
}

TEST_F(RigFault, AFullDiskForTheRecord) {
  for (int i = 0; i < times(5); ++i) {
    UdpEmulator emulator(slow_device());
    Host host(folder, "udp:" + emulator.address(), "host", "/dev/full");
    if (!runs(emulator, host)) {
      if (HasFailure()) return;
      --i;
      continue;
    }
    host.send(SIGINT);
    EXPECT_EQ(host.status(), 1);
    EXPECT_THAT(host.errors(), HasSubstr("/dev/full"));
    EXPECT_THAT(host.errors(), HasSubstr("flight record: " + (folder / "state/zwidth/flight-").string()))
        << "elsewhere";
    EXPECT_TRUE(within(5s, [&] { return emulator.force() == 0.0; }));
  }
}

TEST_F(RigFault, ASecondRigOnTheSameDrive) {
  for (int i = 0; i < times(5); ++i) {
    UdpEmulator emulator(slow_device());
    Host host(folder, "udp:" + emulator.address(), "host", folder / "record.csv");
    if (!runs(emulator, host)) {
      if (HasFailure()) return;
      --i;
      continue;
    }
    Host other(folder, "udp:" + emulator.address(), "other", folder / "other.csv");
    EXPECT_EQ(other.status(), 1);
    EXPECT_THAT(other.errors(), HasSubstr("no other rig holds it"));
    host.send(SIGINT);
    EXPECT_EQ(host.status(), 1);
    EXPECT_TRUE(within(5s, [&] { return emulator.force() == 0.0; }));
    expect_whole_record();
    expect_no_crumbs();
  }
}

TEST_F(RigFault, TheExampleInCIsSuchADrive) {
  const std::string drive = folder / "udp_drive";
  ASSERT_EQ(std::system(("cc -std=c99 -O1 -Wall -Wextra -Werror -o " + drive +
                         " " ZWIDTH_SOURCE_DIR "/examples/udp_drive/udp_drive.c -lm")
                            .c_str()),
            0);
  const test::PrintingProcess example({drive, "0"});
  int port = 0;
  ASSERT_EQ(std::sscanf(example.line().c_str(), "port %d", &port), 1);
  Host host(folder, "udp:127.0.0.1:" + std::to_string(port), "host", folder / "record.csv");
  EXPECT_EQ(example.line(), "takes hold\n") << "to prove the watchdog";
  EXPECT_EQ(example.line(), "let go\n");
  EXPECT_EQ(example.line(), "takes hold\n");
  host.send(SIGKILL);
  EXPECT_EQ(example.line(), "let go\n");
}

// The file says how it was measured, and analyze takes it; a study takes the delays as they varied.
TEST_F(RigFault, CheckWritesTheMeasuredDelay) {
  UdpEmulator emulator(slow_device());
  const std::string found = folder / "found.toml";
  const std::string check = ZWIDTH_PROGRAM " rig check " + (folder / "device.toml").string() +
                            " --driver udp:" + emulator.address() +
                            " --position-limit 1 --duration 1 --output-device " + found + " --delays " +
                            (folder / "delays.txt").string() + " > " + (folder / "text").string() + " 2>&1";
  int status = -1;
  for (int i = 0; i < 3 && status != 0; ++i) status = std::system(check.c_str());  // a machine that pauses stops it
  ASSERT_EQ(status, 0) << std::ifstream(folder / "text").rdbuf();
  const auto device = read_device_file(found);
  ASSERT_TRUE(device) << device.error().str();
  EXPECT_GT(device->loop().delay, 0.0);
  EXPECT_LT(device->loop().delay, period) << "the answer came within its cycle";
  std::stringstream text;
  text << std::ifstream(found).rdbuf();
  EXPECT_THAT(text.str(), testing::StartsWith("# loop.delay: "));
  EXPECT_THAT(text.str(), HasSubstr("simulate --jitter "));
  EXPECT_EQ(std::system((ZWIDTH_PROGRAM " analyze " + found + " > /dev/null").c_str()), 0);
  std::ofstream(folder / "study.toml") << "[[parameter]]\nkey = \"loop.delay\"\ndistribution = \"file\"\n"
                                          "file = \"delays.txt\"\n";
  EXPECT_EQ(std::system((ZWIDTH_PROGRAM " study " + found + " --study " + (folder / "study.toml").string() +
                         " --samples 200 > /dev/null")
                            .c_str()),
            0);
}

TEST_F(RigFault, FirmwareWithoutAWatchdogIsRefused) {
  UdpEmulator emulator(slow_device());
  emulator.set_fault(Fault::no_watchdog);
  Host host(folder, "udp:" + emulator.address(), "host", folder / "record.csv");
  EXPECT_EQ(host.status(), 1);
  EXPECT_THAT(host.errors(), HasSubstr("--no-watchdog"));
  EXPECT_EQ(emulator.nonzero_forces(), 0);
}

}  // namespace
}  // namespace zwidth::rig
