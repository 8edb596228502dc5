#pragma once

#include <cstdint>
#include <vector>

#include "zwidth/finding.hpp"

namespace zwidth {

/// Why a drive cannot be reached, may not be used as it is, or has no position any more. words_of() of
/// words/drive_problem_text.hpp makes the sentence.
enum class DriveProblemCode : std::uint8_t {
  // its name
  unknown_driver,            ///< no driver is called so
  no_port_named,             ///< a serial port is not named
  no_adapter_named,          ///< an adapter of a CAN bus is not named
  address_without_port,      ///< HOST alone
  address_without_host,      ///< PORT alone
  address_without_brackets,  ///< of IPv6, without brackets
  no_port_number,            ///< `port` is no number from 1 to 65535
  id_out_of_range,           ///< driver.id is not one of that `drive`

  // the way to it
  port_not_opened,            ///< for `reason`
  port_not_permitted,         ///< the same, of the user
  port_busy,                  ///< the same, for another program
  not_a_serial_port,          ///< the file is something else
  port_held,                  ///< another program has locked it
  speed_unknown,              ///< driver.baud is none of those `known`
  speed_refused,              ///< the port does not take it, for `reason`
  port_full,                  ///< it takes no more bytes
  address_unknown,            ///< for `reason`
  address_not_reached,        ///< for `reason`
  bit_rate_unknown,           ///< SLCAN has none like it
  bit_rate_refused,           ///< by the adapter, to whose `command` it says no
  bit_rate_refused_fdcanusb,  ///< by an fdcanusb
  adapter_without_can_fd,     ///< by its answer to `command`
  channel_not_opened,         ///< by its answer to `command`
  adapter_full,               ///< it takes no bytes
  no_socketcan,               ///< the kernel has none, for `reason`
  interface_unknown,          ///< there is none of that name
  interface_down,             ///< it is not up
  interface_without_can_fd,   ///< it is up, for frames of CAN alone
  interface_not_opened,       ///< for `reason`

  // what it carries
  line_too_slow,            ///< the bytes of a cycle
  bus_too_slow,             ///< the frames of a cycle
  too_slow_for_damper,      ///< with what forces beside a damper have more
  watchdog_below_cycle,     ///< the firmware's is shorter than two sampling periods
  sketch_watchdog,          ///< the sketch's is not in its range
  damper_number_not_taken,  ///< the drive has another `said` for `name`

  // silence
  silent,                  ///< it never answers on its line
  silent_on_bus,           ///< it never answers on its bus
  silent_microcontroller,  ///< it never answers
  silent_udp,              ///< it never answers
  silent_now,              ///< it answers no more
  no_heartbeat,            ///< of an ODrive on a bus

  // its settings
  sends_unasked,          ///< an ODrive on a bus sends what would pass for an answer
  odrive_property,        ///< an ODrive answers otherwise than is known
  simplefoc_resistance,   ///< volts and a phase resistance: its unit is not known
  simplefoc_torque,       ///< its way to control torque is not known
  simplefoc_motion,       ///< it stays in another motion control
  moteus_holds,           ///< once its watchdog has let go it would hold its position
  vesc_firmware,          ///< it is older than 6.00
  moteus_refuses_number,  ///< `name`, with what it `said`
  sketch_version,         ///< of its protocol
  sketch_force_limit,     ///< is none

  // it takes no force
  odrive_not_closed_loop,  ///< the axis stays out of closed-loop control
  moteus_other_mode,       ///< it stays in another mode than that of position
  vesc_takes_no_current,   ///< it has a fault, or has let go
  simplefoc_not_enabled,   ///< the motor stays disabled
  microcontroller_idle,    ///< it does not hold
  udp_takes_no_force,      ///< it says that it has let go

  // what it stands on, or did
  odrive_fault,              ///< the axis stands on an error
  moteus_fault,              ///< it is in mode 1
  vesc_fault,                ///< it stands on a fault
  microcontroller_fault,     ///< it stands on a fault
  odrive_let_go,             ///< the axis is in another state
  moteus_let_go,             ///< it is in another mode
  vesc_let_go,               ///< its timeout, or its kill switch
  microcontroller_let_go,    ///< its watchdog
  microcontroller_not_held,  ///< it started anew, or was released
  udp_let_go,                ///< it says so
  turns_not_counted,         ///< the motor turned too far in a cycle
};

/// The last of the list.
inline constexpr DriveProblemCode last_drive_problem = DriveProblemCode::turns_not_counted;

/// A drive's problem, as data.
struct DriveProblem {
  DriveProblemCode code = DriveProblemCode::silent;  ///< what is wrong
  std::vector<Evidence> evidence = {};               ///< its numbers
  std::vector<Subject> subjects = {};                ///< its names
  [[nodiscard]] bool operator==(const DriveProblem&) const = default;
};

}  // namespace zwidth
