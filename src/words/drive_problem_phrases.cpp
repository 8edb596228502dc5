#include <algorithm>
#include <array>
#include <span>

#include "words/phrase.hpp"
#include "zwidth/error.hpp"
#include "zwidth/words/drive_problem_text.hpp"

namespace zwidth {
namespace {

// The sentence of a drive's problem, in the syntax of phrase.hpp.
struct DriveProblemPhrase {
  DriveProblemCode code{};
  const char* name = "";
  const char* what = "";
  const char* remedy = "";
};

std::span<const DriveProblemPhrase> phrases_of_the_way() {
  using enum DriveProblemCode;
  static constexpr const char* adapters =
      "a serial port with an SLCAN adapter or an fdcanusb, /dev/ttyACM0 or with its speed /dev/ttyUSB0@115200, or a "
      "SocketCAN interface, can0";
  static constexpr const char* hosts = "udp:HOST:PORT, of IPv6 udp:[HOST]:PORT";
  static constexpr std::array phrases{
      DriveProblemPhrase{unknown_driver, "unknown_driver", "is none", "{drivers}"},
      DriveProblemPhrase{no_port_named, "no_port_named", "names no port", "a serial port, such as /dev/ttyUSB0"},
      DriveProblemPhrase{no_adapter_named, "no_adapter_named", "names no port or interface", adapters},
      DriveProblemPhrase{address_without_port, "address_without_port", "has no port", hosts},
      DriveProblemPhrase{address_without_host, "address_without_host", "has no host", hosts},
      DriveProblemPhrase{address_without_brackets, "address_without_brackets", "an address of IPv6 stands in brackets",
                         hosts},
      DriveProblemPhrase{no_port_number, "no_port_number", "port {port} is none", "1 to {most:n}"},
      DriveProblemPhrase{id_out_of_range, "id_out_of_range", "driver.id is {id:n}",
                         "{?drive=odrive|an ODrive has the axes {least:n} and {most:n}}{?drive=moteus|a moteus has "
                         "{least:n} to {most:n}}{?drive=vesc-can|{least:n} to {most:n}, the next one is this "
                         "program's}{?drive=odrive-can|{least:n} to {most:n}, the axis's node id}"},
      DriveProblemPhrase{port_not_opened, "port_not_opened", "cannot be opened: {reason}"},
      DriveProblemPhrase{port_not_permitted, "port_not_permitted", "cannot be opened: {reason}",
                         "add yourself to the port's group (dialout) and log in again"},
      DriveProblemPhrase{port_busy, "port_busy", "cannot be opened: {reason}",
                         "another program has it: close that, or the other rig"},
      DriveProblemPhrase{not_a_serial_port, "not_a_serial_port", "is no serial port"},
      DriveProblemPhrase{port_held, "port_held", "is held by another program, perhaps another rig",
                         "one at a time may drive a motor"},
      DriveProblemPhrase{speed_unknown, "speed_unknown", "driver.baud is {baud:n}", "one of {known}"},
      DriveProblemPhrase{speed_refused, "speed_refused", "does not take its speed: {reason}",
                         "set driver.baud to one that the port has"},
      DriveProblemPhrase{port_full, "port_full",
                         "the port takes no more bytes: the drive does not read, or is unplugged"},
      DriveProblemPhrase{address_unknown, "address_unknown", "no such address: {reason}"},
      DriveProblemPhrase{address_not_reached, "address_not_reached", "cannot be reached: {reason}"},
      DriveProblemPhrase{bit_rate_unknown, "bit_rate_unknown",
                         "driver.baud is {rate:n} bit/s, which SLCAN adapters do not have", "one of {known}"},
      DriveProblemPhrase{bit_rate_refused, "bit_rate_refused",
                         "the adapter refuses {command}: it does not have that bit rate"},
      DriveProblemPhrase{bit_rate_refused_fdcanusb, "bit_rate_refused_fdcanusb",
                         "the fdcanusb does not take {rate:n} bit/s"},
      DriveProblemPhrase{adapter_without_can_fd, "adapter_without_can_fd",
                         "the adapter refuses {command}: it has no CAN FD",
                         "take an fdcanusb, or an interface of SocketCAN"},
      DriveProblemPhrase{channel_not_opened, "channel_not_opened",
                         "the adapter refuses {command}: the channel does not open", "unplug it and plug it in again"},
      DriveProblemPhrase{adapter_full, "adapter_full", "the adapter takes no bytes: it does not read, or is unplugged"},
      DriveProblemPhrase{no_socketcan, "no_socketcan", "the CAN interface {interface} cannot be opened: {reason}",
                         "this kernel has no SocketCAN (modprobe can_raw)"},
      DriveProblemPhrase{interface_unknown, "interface_unknown",
                         "the CAN interface {interface} cannot be opened: {reason}",
                         "ip link shows those that there are. A serial port has a / in its name"},
      DriveProblemPhrase{interface_down, "interface_down", "the CAN interface {interface} cannot be opened: {reason}",
                         "ip link set INTERFACE up type can bitrate RATE"},
      DriveProblemPhrase{interface_without_can_fd, "interface_without_can_fd",
                         "the CAN interface {interface} cannot be opened: {reason}",
                         "it needs CAN FD: ip link set INTERFACE up type can bitrate 1000000 dbitrate 5000000 fd on"},
      DriveProblemPhrase{interface_not_opened, "interface_not_opened",
                         "the CAN interface {interface} cannot be opened: {reason}"}};
  return phrases;
}

std::span<const DriveProblemPhrase> phrases_of_load() {
  using enum DriveProblemCode;
  static constexpr std::array phrases{
      DriveProblemPhrase{
          line_too_slow, "line_too_slow",
          "the line is too slow: {bytes:n} bytes per cycle at {baud:n} Bd leave {carried_hz:n} Hz at most, the loop "
          "runs "
          "at {wanted_hz:n} Hz",
          "{?sufficient_baud|set the drive and driver.baud to {sufficient_baud:n} or more, or }loop.sampling_period to "
          "{period:.4g} s or more"},
      DriveProblemPhrase{
          bus_too_slow, "bus_too_slow",
          "the line is too slow: the frames of a cycle at {rate:n} bit/s leave {carried_hz:n} Hz at most, the loop "
          "runs "
          "at {wanted_hz:.6g} Hz",
          "{?sufficient_rate|set the drive and driver.baud to {sufficient_rate:n} or more, or }loop.sampling_period to "
          "{period:.6g} s or more"},
      DriveProblemPhrase{too_slow_for_damper, "too_slow_for_damper", "the line is too slow for the damper's frames",
                         "loop.sampling_period to {period:.6g} s or more"},
      DriveProblemPhrase{watchdog_below_cycle, "watchdog_below_cycle",
                         "the firmware lets go after {watchdog:exact} s without a force, the loop sends one every "
                         "{period:exact} s",
                         "set loop.sampling_period to {most:exact} s or less"},
      DriveProblemPhrase{sketch_watchdog, "sketch_watchdog",
                         "the sketch's watchdog lets go after {watchdog:.6g} s without a force",
                         "{least:.6g} s, two sampling periods, to {most:.6g} s"},
      DriveProblemPhrase{damper_number_not_taken, "damper_number_not_taken",
                         "the drive has {name} at {said} instead of {told:.6g}: it closes another damper"}};
  return phrases;
}

std::span<const DriveProblemPhrase> phrases_of_drives() {
  using enum DriveProblemCode;
  static constexpr const char* find_cause = "find its cause with odrivetool (dump_errors), then clear it";
  static constexpr std::array phrases{
      DriveProblemPhrase{silent, "silent", "the drive does not answer",
                         "check port, power, wiring, and that driver.baud is the drive's{?firmware|; on its UART it "
                         "needs firmware of {firmware} or newer}"},
      DriveProblemPhrase{silent_on_bus, "silent_on_bus", "the drive does not answer",
                         "check adapter, power, wiring and termination, that driver.id is the drive's on the bus, and "
                         "that driver.baud is the bus's bit rate"},
      DriveProblemPhrase{silent_microcontroller, "silent_microcontroller", "the microcontroller does not answer",
                         "check port and power, that its sketch is built around zwidth_serial.h, and that driver.baud "
                         "is the sketch's"},
      DriveProblemPhrase{silent_udp, "silent_udp", "the drive does not answer",
                         "check address and port, and that no other rig holds it"},
      DriveProblemPhrase{silent_now, "silent_now", "the drive does not answer any more"},
      DriveProblemPhrase{
          no_heartbeat, "no_heartbeat", "no heartbeat of node {node:n} is heard",
          "check adapter, power, wiring and termination, that driver.id is the axis's node id, that driver.baud is the "
          "bus's bit rate (can.config.baud_rate), and that heartbeat_rate_ms (0.6: heartbeat_msg_rate_ms) is 100 or "
          "less"},
      DriveProblemPhrase{sends_unasked, "sends_unasked",
                         "the drive sends its position or supply voltage unasked, which would pass for answers",
                         "set axis0.config.can.encoder_rate_ms and bus_vi_rate_ms (0.6: encoder_msg_rate_ms, "
                         "bus_voltage_msg_rate_ms) to 0"},
      DriveProblemPhrase{odrive_property, "odrive_property", "the drive answers \"{said}\" to axis{axis:n}.{name}",
                         "is its firmware 0.5 or 0.6?"},
      DriveProblemPhrase{simplefoc_resistance, "simplefoc_resistance",
                         "motor {motor} controls torque by volts and has a phase resistance: SimpleFOC 2.3 then takes "
                         "amperes for a target, 2.4 volts",
                         "make the motor without a resistance, or control a current (motor.torque_controller)"},
      DriveProblemPhrase{simplefoc_torque, "simplefoc_torque",
                         "motor {motor} controls torque by \"{said}\", which is not known",
                         "volt, dc curr or foc curr (motor.torque_controller)"},
      DriveProblemPhrase{simplefoc_motion, "simplefoc_motion",
                         "motor {motor} stays in motion control \"{said}\" instead of {wanted}"},
      DriveProblemPhrase{moteus_holds, "moteus_holds",
                         "once its watchdog has let go moteus {id:n} would hold its position with its own gains "
                         "(servo.timeout_mode {mode:n})",
                         "conf set servo.timeout_mode to 12, 15 or 0, then conf write"},
      DriveProblemPhrase{vesc_firmware, "vesc_firmware",
                         "the drive's firmware is {firmware}, whose answers do not tell whether it has let go",
                         "6.00 or newer: update it with VESC Tool"},
      DriveProblemPhrase{moteus_refuses_number, "moteus_refuses_number",
                         "moteus {id:n} does not take {name}: it says \"{said}\""},
      DriveProblemPhrase{sketch_version, "sketch_version", "the sketch speaks version {version:n} of the protocol",
                         "{known:n} is known: build it with the zwidth_serial.h of this program"},
      DriveProblemPhrase{sketch_force_limit, "sketch_force_limit", "the sketch's force limit is none",
                         "give zwidth_serial_begin() more than 0 N or N m"},
      DriveProblemPhrase{odrive_not_closed_loop, "odrive_not_closed_loop",
                         "{?node|node {node:n}}{?axis|axis {axis:n}} does not go into closed-loop control, error "
                         "{error:x}",
                         "calibrate motor and encoder first (odrivetool, dump_errors)"},
      DriveProblemPhrase{moteus_other_mode, "moteus_other_mode",
                         "moteus {id:n} does not go into its position mode but stays in mode {mode:n}{?mode=12|, zero "
                         "velocity: another host commands it}{?mode=15|, brake: another host commands it}",
                         "{?mode=12|end that one}{?mode=15|end that one}{!mode=12|{!mode=15|calibrate it first}}"},
      DriveProblemPhrase{vesc_takes_no_current, "vesc_takes_no_current",
                         "the drive does not take a current: a fault, its kill switch, or another app holds the motor"},
      DriveProblemPhrase{simplefoc_not_enabled, "simplefoc_not_enabled", "motor {motor} does not enable",
                         "does initFOC() of the sketch succeed?"},
      DriveProblemPhrase{microcontroller_idle, "microcontroller_idle", "the microcontroller takes no force"},
      DriveProblemPhrase{udp_takes_no_force, "udp_takes_no_force",
                         "the drive does not take a force: it says that it has let go"},
      DriveProblemPhrase{odrive_fault, "odrive_fault",
                         "{?node|node {node:n}}{?axis|axis {axis:n}} stands on error {error:x}{?watchdog|, its "
                         "watchdog's among them}",
                         find_cause},
      DriveProblemPhrase{moteus_fault, "moteus_fault", "moteus {id:n} stands on a fault",
                         "find its cause with tview, then stop it (d stop)"},
      DriveProblemPhrase{vesc_fault, "vesc_fault", "the drive stands on fault {fault:n}", "VESC Tool tells its cause"},
      DriveProblemPhrase{microcontroller_fault, "microcontroller_fault",
                         "the microcontroller stands on fault {fault:n}"},
      DriveProblemPhrase{odrive_let_go, "odrive_let_go", "node {node:n} has let go: it is in state {state:n}"},
      DriveProblemPhrase{
          moteus_let_go, "moteus_let_go",
          "moteus {id:n} has let go: it is in mode {mode:n}{?mode=0|, stopped}{?mode=11|, its "
          "watchdog's}{?mode=12|, zero velocity: another host commands it}{?mode=15|, brake: another "
          "host commands it}",
          "{?mode=11|the loop is too slow, or the line too busy}{?mode=12|end that one}{?mode=15|end that "
          "one}"},
      DriveProblemPhrase{vesc_let_go, "vesc_let_go",
                         "the drive has let go: its timeout (App Settings) is too short for the loop, or its kill "
                         "switch is on"},
      DriveProblemPhrase{microcontroller_let_go, "microcontroller_let_go",
                         "the microcontroller says that its watchdog has let go"},
      DriveProblemPhrase{microcontroller_not_held, "microcontroller_not_held",
                         "the microcontroller says that no host holds it: it has started anew, or was released"},
      DriveProblemPhrase{udp_let_go, "udp_let_go", "the drive says that it has let go"},
      DriveProblemPhrase{turns_not_counted, "turns_not_counted",
                         "the motor turned by more than {most:.4g} of a turn from one cycle to the next, and a VESC "
                         "tells its position modulo {?modulo=1|a turn}{!modulo=1|{modulo:.4g} turns}",
                         "move more slowly (a lower velocity limit), or make loop.sampling_period shorter"}};
  return phrases;
}

const DriveProblemPhrase& phrase_of(DriveProblemCode code) {
  for (const std::span<const DriveProblemPhrase> list :
       {phrases_of_the_way(), phrases_of_load(), phrases_of_drives()}) {
    const auto found = std::ranges::find(list, code, &DriveProblemPhrase::code);
    if (found != list.end()) return *found;
  }
  throw Error(ErrorCode::invalid_argument, "a drive's problem has no words");
}

}  // namespace

std::string_view name_of(DriveProblemCode code) { return phrase_of(code).name; }

std::string text(const DriveProblem& problem) {
  const DriveProblemPhrase& phrase = phrase_of(problem.code);
  const Finding facts{.evidence = problem.evidence, .subjects = problem.subjects};
  const std::string what = internal::filled_in(facts, phrase.what);
  const std::string remedy = internal::filled_in(facts, phrase.remedy);
  return remedy.empty() ? what : what + "; " + remedy;
}

}  // namespace zwidth
