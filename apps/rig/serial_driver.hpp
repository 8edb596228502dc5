#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "rig/byte_port.hpp"
#include "rig/driver.hpp"
#include "rig/serial_frame.hpp"
#include "rig/serial_input.hpp"
#include "zwidth/design/drive_gains.hpp"
#include "zwidth/model/motor_drive.hpp"

namespace zwidth::rig {

/// Where a drive hangs, and how the loop asks it.
struct SerialLink {
  std::string port;              ///< "/dev/ttyUSB0", or the adapter of a CAN bus
  MotorDrive drive;              ///< of the device file
  double sampling_period = 0.0;  ///< s
  bool lock_step = false;        ///< the drive is a simulation whose time moves with the forces it gets
  bool is_can = false;           ///< the port is an adapter of a CAN bus, on which the drive hangs
};

inline constexpr std::int64_t lock_step_patience = 500'000'000;  ///< ns, for an answer where no clock is kept
inline constexpr double cycles_within_watchdog = 2.0;            ///< of the loop, at least

/// Throws DriverFailed where the line does not carry so many bytes a cycle.
void require_fast_line(double bytes_per_cycle, double baud, double sampling_period);

/// With what a serial line carries, at driver.baud or otherwise. Throws DriverFailed where that is too little for the loop.
[[nodiscard]] DriverFacts on_serial_line(DriverFacts facts, const SerialLink& link, int otherwise);

using OpenPort = std::function<std::unique_ptr<BytePort>()>;
/// That serial port, at driver.baud or otherwise.
[[nodiscard]] OpenPort serial_port_of(const SerialLink& link, int otherwise);

/// What the drives on serial lines and CAN buses share: a question and its answer, then a force; units; what came too late.
///
/// Answers carry no number of their question. One that did not come in time is still owed: nothing more is asked until it
/// comes, and is dropped, so that no position is ever a period older than it seems. One that has not come when all cycles
/// but one that may be missed are over counts as lost, and the drive is asked again: one lost answer does not end a session.
/// It may come all the same, so a mark is asked for first: a drive answers in order, and what comes before its answer to the
/// mark is older. Where that answer is lost, too, no position is taken any more.
class SerialDriver : public Driver {
 public:
  [[nodiscard]] const DriverFacts& facts() const noexcept override { return facts_; }
  void allow_missed(unsigned cycles) noexcept override;
  [[nodiscard]] std::optional<double> measure() noexcept override;
  [[nodiscard]] std::optional<DriveProblem> trouble() const override;

 protected:
  /// What a frame from the drive says.
  enum class Meaning { position, broken, mark, other };  // broken: an answer that cannot be used
  /// Why an answer cannot be used.
  enum class Trouble { none, fault, let_go, lost_count };
  struct Heard {
    Meaning meaning = Meaning::other;
    double turns = 0.0;  ///< of the motor
    Trouble trouble = Trouble::none;
    long code = 0;  ///< of a fault, or of the state into which it has gone
  };

  /// Throws DriverFailed where the port is not to be had, or its line or the firmware's watchdog does not carry the loop.
  SerialDriver(DriverFacts facts, const SerialLink& link, int default_baud)
      : SerialDriver(on_serial_line(std::move(facts), link, default_baud), link, serial_port_of(link, default_baud)) {}
  /// The same through any port, which is opened last.
  SerialDriver(DriverFacts facts, const SerialLink& link, const OpenPort& open);

  /// How many bytes the first frame has, its end included; 0: it is not whole yet. A line unless overridden.
  [[nodiscard]] virtual std::size_t frame_size(std::string_view bytes) const noexcept;
  [[nodiscard]] virtual Heard hear(std::string_view frame) noexcept = 0;
  [[nodiscard]] virtual SerialFrame question() noexcept = 0;
  /// Asks for something else than any question, so that its answer (Meaning::mark) is known among theirs.
  [[nodiscard]] virtual SerialFrame mark() const noexcept = 0;
  [[nodiscard]] virtual SerialFrame torque_frame(double torque) const noexcept = 0;
  /// The trouble by the drive's own numbers. Never asked for none, or for what hear() does not tell.
  [[nodiscard]] virtual DriveProblem problem_of(Trouble trouble, long code) const = 0;
  /// That it never answers.
  [[nodiscard]] virtual DriveProblem unanswered() const;

  void send(double force) noexcept override { port_->write(torque_frame(force * drive_.torque_per_force()).view()); }

  // While nothing runs on the clock:
  using Understood = std::function<std::optional<std::string>(std::string_view frame)>;
  static constexpr std::int64_t setup_patience = 500'000'000;  ///< ns, for an answer: a busy machine hands it on late
  /// Writes the frame, and waits for what is understood of those that come; nothing where none is.
  [[nodiscard]] std::optional<std::string> ask(std::string_view frame, const Understood& understood,
                                               std::int64_t patience = setup_patience);
  /// The same, several times if need be; throws DriverFailed where the drive never answers.
  [[nodiscard]] std::string ask_until_answered(std::string_view frame, const Understood& understood, int tries = 4);
  /// Throws DriverFailed where the port is full.
  void tell(std::string_view frame);
  void forget_input() noexcept;

  /// What the drive must close by itself: none unless close_damper() was called.
  struct Damper {
    std::vector<DriveNumber> numbers;
    std::optional<double> torque_limit;  ///< N m, of the motor: spring and damper together
    double damping = 0.0;                ///< N m s/rad, at the motor
  };
  [[nodiscard]] const std::optional<Damper>& damper() const noexcept { return damper_; }
  /// Throws Error (invalid_argument) as damper_numbers() does.
  void set_damper(const Device& device, DriveFirmware firmware, std::optional<double> force_limit);
  /// Throws DriverFailed where what the drive says is not the number that it was told, to the digits that it prints.
  static void require_taken(std::string_view name, double told, std::string_view said);
  /// So many more bytes in each force than at first, and so much more of a bus's time, s. Throws DriverFailed where the line
  /// does not carry them.
  void add_force_bytes(double bytes, double bus_time = 0.0);

  [[nodiscard]] BytePort& port() noexcept { return *port_; }
  [[nodiscard]] double sampling_period() const noexcept { return sampling_period_; }
  [[nodiscard]] const MotorDrive& drive() const noexcept { return drive_; }
  /// Of the motor, N m: what the drive's own limits leave.
  void set_torque_limit(double torque) noexcept;
  [[nodiscard]] DriveSettings& settings() noexcept { return facts_.settings; }
  void set_watchdog(std::optional<double> watchdog) noexcept { facts_.watchdog = watchdog; }

 private:
  /// The first whole frame of what has come; empty: there is none. Valid until the next call.
  [[nodiscard]] std::string_view next_frame() noexcept;
  [[nodiscard]] bool fill(std::int64_t until) noexcept { return input_.fill(*port_, until); }
  /// Reads until an answer comes: what it says; nothing where none does until then.
  [[nodiscard]] std::optional<Heard> answer(std::int64_t until) noexcept;

  DriverFacts facts_;
  std::optional<Damper> damper_;
  double sampling_period_;
  MotorDrive drive_;
  std::unique_ptr<BytePort> port_;
  bool is_can_;
  std::int64_t patience_;  // ns, for an answer
  SerialInput input_;
  bool is_owed_ = false;     // the answer to the last question
  int marks_owed_ = 0;       // until they come, answers are to older questions
  std::int64_t asked_ = 0;   // ns, when that was
  std::int64_t expiry_ = 0;  // ns, after which it is lost
  Heard last_;               // answer of a cycle
};

}  // namespace zwidth::rig
