// A drive that is not there, on a pseudo-terminal: what `zwidth rig --driver KIND:PORT` talks to, around the device of a
// file. Its time moves one sampling period with each force.
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
#include "zwidth/io/device_file.hpp"

int main(int count, char** arguments) {
  using namespace zwidth;
  std::string names;
  for (const test::DriveKind& kind : test::drive_kinds)
    names += fmt::format("{}{}", names.empty() ? "" : "|", kind.name);
  const auto* const kind = std::ranges::find(test::drive_kinds, count > 1 ? arguments[1] : "", &test::DriveKind::name);
  if (count != 3 || kind == test::drive_kinds.end()) {
    fmt::print(stderr, "usage: drive_emulator {} DEVICE.toml\n", names);
    return 2;
  }
  const auto device = read_device_file(arguments[2]);
  if (!device || !device->parameters().driver) {
    fmt::print(stderr, "{}: {}\n", arguments[2], device ? "has no [driver]" : device.error().str());
    return 2;
  }
  sigset_t ends;
  sigemptyset(&ends);
  sigaddset(&ends, SIGINT);
  sigaddset(&ends, SIGTERM);
  sigprocmask(SIG_BLOCK, &ends, nullptr);  // in all threads: sigwait() takes them
  const test::PtyEmulator emulator(kind->firmware(), *device, {.is_paced = true});
  fmt::print("{}\n", emulator.path());
  std::fflush(stdout);
  int signal = 0;
  sigwait(&ends, &signal);
  return 0;
}
