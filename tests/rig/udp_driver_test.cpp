#include "rig/udp_driver.hpp"

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <limits>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "rig/drive_failure.hpp"
#include "rig/measured_as_predicted.hpp"
#include "rig/rig_devices.hpp"
#include "rig/rig_host.hpp"
#include "rig/udp_emulator.hpp"
#include "rig/udp_frame.hpp"

namespace zwidth::rig {
namespace {

using enum DriveProblemCode;
using test::code_of;
using test::UdpEmulator;

std::string hexadecimal(std::span<const std::byte> bytes) {
  std::string text;
  for (const std::byte byte : bytes) {
    text += "0123456789abcdef"[std::to_integer<unsigned>(byte >> 4U)];
    text += "0123456789abcdef"[std::to_integer<unsigned>(byte & std::byte{15})];
  }
  return text;
}

// Written by hand from the table in docs/rig_drives.md: 7, 1.5 s, -0.25 m, 2 m/s, 0.5 N, and zlib.crc32 of that.
TEST(UdpFrame, IsTheDocumentedOne) {
  const auto bytes = encoded({7, 1.5, -0.25, 2.0, 0.5});
  EXPECT_EQ(hexadecimal(bytes),
            "07000000"
            "000000000000f83f"
            "000000000000d0bf"
            "0000000000000040"
            "000000000000e03f"
            "d5bae693");
  const auto frame = decoded_udp_frame(bytes);
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->sequence, 7U);
  EXPECT_EQ(frame->position, -0.25);
  EXPECT_EQ(frame->force, 0.5);
}

TEST(UdpFrame, RefusesEveryFlippedBitAndEveryOtherLength) {
  const auto bytes = encoded({123456, 1.0, 2.0, 3.0, 4.0});
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    auto flipped = bytes;
    flipped.at(bit / 8) ^= std::byte{1} << (bit % 8);
    EXPECT_FALSE(decoded_udp_frame(flipped)) << "bit " << bit;
  }
  std::vector<std::byte> longer(bytes.begin(), bytes.end());
  longer.push_back(std::byte{0});
  EXPECT_FALSE(decoded_udp_frame(longer));
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_FALSE(decoded_udp_frame(std::span(bytes).first(size)));
  }
}

TEST(UdpDriver, ProvesTheWatchdogBySilence) {
  const Device device = test::bench_device(1);
  UdpEmulator emulator(device);
  UdpDriver driver(emulator.address(), 0.02);
  EXPECT_EQ(driver.proves_watchdog(), true);
  EXPECT_EQ(emulator.times_let_go(), 1);
  EXPECT_EQ(emulator.nonzero_forces(), 0) << "with no force at all";
  emulator.set_fault(UdpEmulator::Fault::no_watchdog);
  EXPECT_EQ(driver.proves_watchdog(), false);
  EXPECT_FALSE(driver.facts().watchdog);
}

// A position all the same: walls were rendered that no force reached.
TEST(UdpDriver, ADriveThatHasLetGoGivesNoPosition) {
  const Device device = test::bench_device(1);
  UdpEmulator emulator(device);
  UdpDriver driver(emulator.address(), 0.02);
  EXPECT_TRUE(driver.measure()) << "before the first force it holds none";
  driver.command(1.0);
  ASSERT_TRUE(test::within(std::chrono::seconds(5), [&] { return emulator.nonzero_forces() == 1; }));
  ASSERT_TRUE(test::within(std::chrono::seconds(5), [&] { return emulator.has_let_go(); }));
  EXPECT_FALSE(driver.measure());
  EXPECT_EQ(code_of(driver.trouble()), udp_let_go);
  driver.command(1.0);  // takes hold again
  EXPECT_TRUE(driver.measure());
  EXPECT_FALSE(driver.trouble());
}

TEST(UdpDriver, TellsWhatCannotBeReached) {
  const auto failure = [](const std::string& address) {
    return test::failure_of([&] { UdpDriver driver(address, 1e-3); });
  };
  EXPECT_EQ(code_of(failure("localhost")), address_without_port);
  EXPECT_EQ(code_of(failure("127.0.0.1:")), address_without_port);
  EXPECT_EQ(failure("127.0.0.1:http"), (DriveProblem{no_port_number, {{"most", 65535.0}}, {{"port", "http"}}}));
  EXPECT_EQ(code_of(failure("127.0.0.1:1")), silent_udp);
}

TEST(UdpDriver, AddressesOfBothKinds) {
  for (const auto& [text, host] : {std::pair("[::1]:7", "::1"), std::pair("[fe80::1%eth0]:7", "fe80::1%eth0"),
                                   std::pair("127.0.0.1:7", "127.0.0.1"), std::pair("bench.local:7", "bench.local")}) {
    const auto address = udp_address(text);
    ASSERT_TRUE(address) << text;
    EXPECT_EQ(address->host, host);
    EXPECT_EQ(address->port, "7");
  }
  for (const auto& [text, code] :
       {std::pair("::1:7", address_without_brackets), std::pair("[::1]", address_without_port),
        std::pair("[]:7", address_without_host), std::pair(":7", address_without_host),
        std::pair("", address_without_port), std::pair("[::1]:", address_without_port),
        std::pair("[::1]7", address_without_brackets), std::pair("[::1]:0", no_port_number),
        std::pair("[::1:7", address_without_brackets), std::pair("h:+7", no_port_number),
        std::pair("h:7 ", no_port_number)}) {
    const auto address = udp_address(text);
    ASSERT_FALSE(address) << text;
    EXPECT_EQ(address.error().code, code) << text;
  }
}

// What repeats every frame is a drive at 0 that never lets go.
TEST(UdpDriver, ReachesADriveOnIPv6) {
  const int drive = socket(AF_INET6, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in6 own{};
  own.sin6_family = AF_INET6;
  own.sin6_addr = in6addr_loopback;
  socklen_t size = sizeof own;
  auto* const name = reinterpret_cast<sockaddr*>(&own);  // NOLINT(*-reinterpret-cast): as sockets want it
  ASSERT_EQ(bind(drive, name, size), 0) << "no IPv6 on this machine";
  ASSERT_EQ(getsockname(drive, name, &size), 0);
  std::thread repeats([&] {
    std::array<std::byte, 64> frame{};
    for (;;) {
      sockaddr_in6 from{};
      socklen_t length = sizeof from;
      auto* const sender = reinterpret_cast<sockaddr*>(&from);  // NOLINT(*-reinterpret-cast)
      const ssize_t got = recvfrom(drive, frame.data(), frame.size(), 0, sender, &length);
      if (got <= 1) return;
      sendto(drive, frame.data(), static_cast<std::size_t>(got), 0, sender, length);
    }
  });
  {
    UdpDriver driver("[::1]:" + std::to_string(ntohs(own.sin6_port)), 0.1);
    EXPECT_EQ(driver.measure(), 0.0);
  }
  const int end = socket(AF_INET6, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sendto(end, "", 1, 0, name, size);
  repeats.join();
  close(end);
  close(drive);
}

// Over the link the same numbers as without it: the drive moves one period with each force.
TEST(UdpDriver, TheLimitOverTheLink) {
  const Device device = test::bench_device(2);
  UdpEmulator emulator(device);
  UdpDriver driver(emulator.address(), device.loop().sampling_period, true);
  expect_limit(device, driver);
  EXPECT_EQ(emulator.force(), 0.0);
}

TEST(UdpDriver, IdentificationOverTheLink) {
  const Device device = test::bench_device(1);
  UdpEmulator emulator(device);
  UdpDriver driver(emulator.address(), device.loop().sampling_period, true);
  expect_identified(device, driver);
}

TEST(UdpDriver, TheRelayOverTheLink) {
  const Device device = test::bench_device(1);
  UdpEmulator emulator(device);
  UdpDriver driver(emulator.address(), device.loop().sampling_period, true);
  expect_relay(device, driver);
}

}  // namespace
}  // namespace zwidth::rig
