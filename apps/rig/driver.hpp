#pragma once

#include <atomic>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "zwidth/drive_problem.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/option_problem.hpp"
#include "zwidth/rig/session.hpp"

namespace zwidth::rig {

/// A drive that cannot be reached, or that may not be used as it is: what() is one line, with the remedy.
struct DriverFailed : std::runtime_error {
  explicit DriverFailed(DriveProblem found);
  /// The same, in parts.
  explicit DriverFailed(DriveProblemCode code, std::vector<Evidence> evidence = {}, std::vector<Subject> subjects = {});
  DriveProblem problem;  ///< what is wrong
};

struct DriverFacts {
  std::string name;
  bool is_simulated = false;             ///< what it measures is what the device's file says
  bool lock_step = false;                ///< its time moves one period with each command: there is no clock to keep
  bool is_zeroed = false;                ///< its positions count from where the wall begins; else from the first one
  std::optional<double> watchdog = {};   ///< s, of the firmware; absent: it has none
  double bytes_per_cycle = 0.0;          ///< on a serial line: question, answer and force
  double force_bytes = 0.0;              ///< of them the force's, which leave after command() has returned
  std::optional<double> byte_rate = {};  ///< bytes/s that the line carries; absent: no serial line
  double bus_time_per_cycle = 0.0;       ///< s, that the same takes on a CAN bus behind the line
  double force_bus_time = 0.0;           ///< s, of it the force's
  bool estimates_velocity = false;       ///< its damper's velocity is that of an estimator which no analysis knows
  DriveSettings settings = {};           ///< what it tells of itself
};

/// Why no damper can run on the drive of the driver of that name: it closes none beside the forces that it is sent.
[[nodiscard]] OptionProblem no_damper_problem(std::string_view name);

/// A device with its drive, in SI units: where the real-time loop ends. A cycle is measure(), then command().
///
/// These two allocate, lock, log and throw nothing, and take no longer than a period. disarm() may be called by another
/// thread than theirs, at any instant; no force goes out after it.
class Driver {
 public:
  Driver() = default;
  Driver(const Driver&) = delete;
  Driver& operator=(const Driver&) = delete;
  virtual ~Driver() = default;

  [[nodiscard]] virtual const DriverFacts& facts() const noexcept = 0;
  /// Has the drive close the wall's damper of this device by itself from arm() on, beside the forces that it gets and
  /// within `force_limit` of both together, N or N m. Before arm(). Throws Error (invalid_argument) where the drive
  /// cannot, DriverFailed where it does not.
  virtual void close_damper(const Device& device, std::optional<double> force_limit);
  /// So many cycles in a row may go without a position. Before arm().
  virtual void allow_missed(unsigned cycles) noexcept { (void)cycles; }
  /// Makes the drive take forces; it starts with none. Throws DriverFailed.
  virtual void arm() = 0;
  /// The position now, m or rad; nothing where none came in time.
  [[nodiscard]] virtual std::optional<double> measure() noexcept = 0;
  /// Why there is no position, where the drive itself said so: it stands on a fault, or has let go. Absent: it did not
  /// say. When the loop does not run.
  [[nodiscard]] virtual std::optional<DriveProblem> trouble() const { return {}; }
  /// Force from now on, N or N m; 0 after disarm().
  void command(double force) noexcept { send(is_disarmed() ? 0.0 : force); }
  /// Zero force, for good, and the drive idle.
  void disarm() noexcept {
    is_disarmed_.store(true, std::memory_order_release);
    send_idle();
  }
  /// How often silence is tried where it does not prove a watchdog: on a busy machine the last force may reach the drive
  /// in the middle of it.
  static constexpr int proofs = 3;

  /// At zero force falls silent for longer than the firmware's watchdog, and asks whether it has let go. Called before
  /// arm(). Absent: there is no firmware. Throws DriverFailed where the link breaks.
  [[nodiscard]] virtual std::optional<bool> proves_watchdog() = 0;

 protected:
  virtual void send(double force) noexcept = 0;
  virtual void send_idle() noexcept = 0;
  [[nodiscard]] bool is_disarmed() const noexcept { return is_disarmed_.load(std::memory_order_acquire); }

 private:
  std::atomic<bool> is_disarmed_ = false;
};

}  // namespace zwidth::rig
