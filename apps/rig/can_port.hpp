#pragma once

#include <memory>
#include <utility>

#include "rig/byte_port.hpp"
#include "rig/can_bus.hpp"
#include "rig/serial_frame.hpp"

namespace zwidth::rig {

/// A CAN bus as a port of bytes: what a driver writes becomes frames, what frames say becomes bytes that it reads.
class CanPort : public BytePort {
 public:
  explicit CanPort(std::unique_ptr<CanBus> bus) : bus_(std::move(bus)) {}

  bool write(std::string_view bytes) noexcept override;
  [[nodiscard]] std::ptrdiff_t read(std::span<char> bytes, std::int64_t until) noexcept override;
  void drop_unsent() noexcept override { bus_->drop_unsent(); }

 protected:
  /// How many bytes the first piece that makes frames has; 0: none is whole.
  [[nodiscard]] virtual std::size_t piece(std::string_view bytes) const noexcept = 0;
  /// The frame of such a piece; nothing where it makes none.
  [[nodiscard]] virtual std::optional<CanFrame> frame_of(std::string_view piece) const noexcept = 0;
  /// What a frame says, in bytes; none where it is for somebody else or not whole.
  [[nodiscard]] virtual SerialFrame bytes_of(const CanFrame& frame) noexcept = 0;

 private:
  std::unique_ptr<CanBus> bus_;
  SerialFrame said_;  // and not read yet
  std::size_t read_ = 0;
};

/// As if an fdcanusb were there: lines that send frames, and lines of frames that have come.
class CanLinePort : public CanPort {
 public:
  using CanPort::CanPort;

 protected:
  [[nodiscard]] std::size_t piece(std::string_view bytes) const noexcept override;
  [[nodiscard]] std::optional<CanFrame> frame_of(std::string_view piece) const noexcept override;
  [[nodiscard]] SerialFrame bytes_of(const CanFrame& frame) noexcept override;
};

}  // namespace zwidth::rig
