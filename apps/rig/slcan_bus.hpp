#pragma once

#include <atomic>

#include "rig/can_bus.hpp"
#include "rig/serial_input.hpp"
#include "rig/serial_port.hpp"

namespace zwidth::rig {

/// A CAN bus behind an adapter on a serial port: SLCAN (CANable, candleLight, Lawicel), or the lines of an fdcanusb. Which
/// of them it is, is told by what it answers: an fdcanusb calls SLCAN's commands errors; an adapter that says nothing, as a
/// CANable does, is one of SLCAN.
class SlcanBus : public CanBus {
 public:
  /// Throws DriverFailed where the port is not to be had, or the adapter takes no such rate.
  SlcanBus(const CanAdapter& adapter, const CanBitRates& rates);
  ~SlcanBus() override;

  bool send(const CanFrame& frame) noexcept override;
  [[nodiscard]] std::optional<CanFrame> receive(std::int64_t until) noexcept override;
  [[nodiscard]] bool is_gone() const noexcept override { return is_gone_; }
  void drop_unsent() noexcept override { port_.drop_unsent(); }

 private:
  enum class Answer { none, taken, refused };

  [[nodiscard]] bool is_fdcanusb();
  /// What the adapter says to a command.
  Answer told(std::string_view command);
  void open_fdcanusb(const CanBitRates& rates);
  void open_slcan(const CanBitRates& rates);

  SerialPort port_;
  SerialInput input_;
  bool is_fdcanusb_ = false;
  bool has_changed_rate_ = false;  // of an fdcanusb, which keeps it until it starts anew
  bool is_gone_ = false;
};

}  // namespace zwidth::rig
