// A drive that is not there, on a pseudo-terminal or a UDP socket: what `zwidth rig --driver KIND:PORT` talks to, around
// the device of a file. Its time moves one sampling period with each force. Interrupted, it says which force it leaves.
//
//   build/release/tests/drive_emulator odrive knob.toml        prints the port, /dev/pts/5
//   zwidth rig check knob.toml --driver odrive:/dev/pts/5 --force-limit 0.1 --position-limit 1
#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <string>

#include "rig/drive_kinds.hpp"
#include "rig/pty_emulator.hpp"
#include "rig/udp_emulator.hpp"
#include "zwidth/io/device_file.hpp"

namespace {

using namespace zwidth;

void serve_until_interrupted(const std::string& port, const auto& motor) {
  fmt::print("{}\n", port);
  std::fflush(stdout);
  sigset_t ends;
  sigemptyset(&ends);
  sigaddset(&ends, SIGINT);
  sigaddset(&ends, SIGTERM);
  int signal = 0;
  sigwait(&ends, &signal);
  fmt::print("force {:g}, after {} forces, {} of them not zero\n", motor.force(), motor.forces(),
             motor.nonzero_forces());
}

}  // namespace

int main(int count, char** arguments) {
  std::string names = "udp";
  for (const test::DriveKind& kind : test::drive_kinds) names += fmt::format("|{}", kind.name);
  for (const test::DriveKind& kind : test::can_drive_kinds) names += fmt::format("|{}", kind.name);
  const auto* const kind = test::drive_kind(count > 1 ? arguments[1] : "");
  const bool is_udp = count > 1 && arguments[1] == std::string("udp");
  if (count != 3 || (kind == nullptr && !is_udp)) {
    fmt::print(stderr, "usage: drive_emulator {} DEVICE.toml\n", names);
    return 2;
  }
  const auto device = read_device_file(arguments[2]);
  if (!device || (!is_udp && !device->parameters().driver)) {
    fmt::print(stderr, "{}: {}\n", arguments[2], device ? "has no [driver]" : device.error().str());
    return 2;
  }
  sigset_t ends;
  sigemptyset(&ends);
  sigaddset(&ends, SIGINT);
  sigaddset(&ends, SIGTERM);
  sigprocmask(SIG_BLOCK, &ends, nullptr);  // in all threads: sigwait() takes them
  if (is_udp) {
    const test::UdpEmulator emulator(*device);
    serve_until_interrupted(emulator.address(), emulator);
  } else {
    const int baud = device->parameters().driver->baud.value_or(0);
    const test::PtyEmulator emulator(kind->firmware(), *device,
                                     {.baud = kind->name.ends_with("-can") ? 0 : baud, .is_paced = true});
    serve_until_interrupted(emulator.path(), emulator.motor());
  }
  return 0;
}
