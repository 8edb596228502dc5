#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "rig/driver.hpp"
#include "rig/microcontroller_frame.hpp"
#include "rig/serial_driver.hpp"
#include "rig/serial_input.hpp"
#include "rig/serial_port.hpp"

namespace zwidth::rig {

/// A microcontroller with firmware/zwidth_serial.h on a serial port or USB: one question and one force per cycle, in SI
/// units of the device, so that of [driver] the baud rate and the sign alone count.
///
/// Answers repeat the sequence of their question: one that is late or lost costs its own cycle and no other. It lets go by
/// itself where no force comes, says so, and takes none until it is held anew.
class MicrocontrollerDriver : public Driver {
 public:
  /// Throws DriverFailed where the port is not to be had, nothing answers within three seconds, or what answers stands
  /// on a fault, speaks another version, or has a watchdog or a line that does not carry the loop.
  explicit MicrocontrollerDriver(const SerialLink& link);

  [[nodiscard]] const DriverFacts& facts() const noexcept override { return facts_; }
  void arm() override;
  [[nodiscard]] std::optional<double> measure() noexcept override;
  [[nodiscard]] std::optional<DriveProblem> trouble() const override;
  [[nodiscard]] std::optional<bool> proves_watchdog() override;

 protected:
  void send(double force) noexcept override;
  void send_idle() noexcept override;

 private:
  [[nodiscard]] std::uint16_t next_sequence() noexcept;
  /// What `decode` makes of the answer to the command, waiting that long.
  template <typename Decode>
  [[nodiscard]] auto answer(MicrocontrollerCommand command, Decode decode, std::int64_t patience) noexcept;
  [[nodiscard]] std::optional<std::string_view> next_frame() noexcept;
  [[nodiscard]] bool fill(std::int64_t until) noexcept { return input_.fill(port_, until); }
  /// The same, several times if need be. Throws DriverFailed where it never answers, as description() does.
  template <typename Decode>
  [[nodiscard]] auto ask_until_answered(MicrocontrollerCommand command, Decode decode);
  [[nodiscard]] MicrocontrollerDescription description();
  void require_usable(const MicrocontrollerDescription& found, double sampling_period) const;

  DriverFacts facts_;
  double sign_;        // of [driver]
  double force_sign_;  // and of its forces
  SerialPort port_;
  std::int64_t patience_;  // ns, for a position
  SerialInput input_;
  std::atomic<unsigned> sequence_ = 0;
  bool is_armed_ = false;
  unsigned trouble_ = MicrocontrollerState::holding;  // state that it had instead
};

}  // namespace zwidth::rig
