#pragma once

#include <cstddef>
#include <functional>
#include <string_view>
#include <vector>

namespace zwidth::rig {

/// Every signal of one cycle.
struct FlightRow {
  double time = 0.0;      ///< s of the clock that the loop keeps, from its start
  double latency = 0.0;   ///< s, by which the cycle began late
  double position = 0.0;  ///< m or rad; NaN where none came
  double velocity = 0.0;  ///< as the limits see it, m/s or rad/s
  double wanted = 0.0;    ///< force of the controller, N or N m
  double force = 0.0;     ///< force sent
  double stop = 0.0;      ///< StopReason as a number; 0: none
};

/// The last cycles of a session, in memory that is there from the start. put() allocates, locks and throws nothing.
class FlightRecorder {
 public:
  static constexpr double length = 60.0;  ///< s

  explicit FlightRecorder(double sampling_period);

  void put(const FlightRow& row) noexcept {
    rows_[next_] = row;
    next_ = next_ + 1 == rows_.size() ? 0 : next_ + 1;
    if (count_ < rows_.size()) ++count_;
  }
  [[nodiscard]] std::size_t size() const noexcept { return count_; }
  /// As CSV, the oldest cycle first: columns time_s, force, position, velocity, wanted_force, latency_s, stop.
  void write(const std::function<void(std::string_view)>& sink) const;

 private:
  std::vector<FlightRow> rows_;
  std::size_t next_ = 0;
  std::size_t count_ = 0;
};

}  // namespace zwidth::rig
