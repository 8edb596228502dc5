#pragma once

// The critical stiffness of many devices of one structure at once, in vectors: see docs/batch.md.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace zwidth::internal {

// The numbers of a device that the kernel reads, one column each.
enum class KernelInput : std::size_t {
  actuated_mass,       // of the actuated body; the only one of a rigid device. A user who holds it is added
  actuated_damping,    // to ground
  actuated_stiffness,  // to ground; of a rigid device alone
  other_mass,
  other_damping,
  link_stiffness,
  link_damping,
  period,
  with_new,  // as SamplingInstants
  with_old,
  lag,  // time constant of the actuator
  damper,
  velocity_filter_hz,
  count
};
inline constexpr std::size_t kernel_inputs = static_cast<std::size_t>(KernelInput::count);

inline constexpr std::size_t most_kernel_delay = 12;  // whole samples: beyond, the powers of |z - 1|² lose digits

// What the devices of one call have in common.
struct KernelGroup {
  bool two_bodies = false;
  bool collocated = true;   // the sensed body is the actuated one
  bool fractional = false;  // with_old > 0
  bool lag = false;
  bool damper = false;
  bool filter = false;            // of the damper's velocity
  std::size_t delay_samples = 0;  // of the plant, a fractional one included
};

// Columns of equal length.
struct KernelDevices {
  std::array<std::vector<double>, kernel_inputs> inputs;

  [[nodiscard]] std::vector<double>& operator[](KernelInput input) { return inputs[static_cast<std::size_t>(input)]; }
  [[nodiscard]] const std::vector<double>& operator[](KernelInput input) const {
    return inputs[static_cast<std::size_t>(input)];
  }
};

// Of every device: whether its answer is certain, and then what it is: finite, and sound.
struct KernelAnswers {
  std::vector<double> stiffness;
  std::vector<double> frequency;           // rad/s
  std::vector<std::int16_t> mode;          // as BatchStiffness::mode
  std::vector<std::int8_t> poles_leaving;  // as BatchStiffness::poles_leaving
  std::vector<std::uint8_t> certain;       // 0: the device is to be asked one by one
};

// Reused from call to call, so that nothing is allocated within.
struct KernelScratch {
  std::vector<double> terms;
  std::vector<double> polynomial;  // the coefficients, then their sizes
  std::vector<double> tasks;
  std::vector<std::int64_t> task_device;
  std::vector<double> roots;
  std::vector<std::int64_t> root_device;
  std::vector<std::uint16_t> intervals;  // looked at of each device
};

// The first `count` devices of the columns, which must be of length padded(count) at least; so must the answers be.
void solve_group(const KernelGroup& group, const KernelDevices& devices, std::size_t count, KernelAnswers& answers,
                 KernelScratch& scratch);

// Lengths of columns are whole numbers of the longest vectors.
[[nodiscard]] constexpr std::size_t padded(std::size_t count) { return (count + 7) / 8 * 8; }

}  // namespace zwidth::internal
