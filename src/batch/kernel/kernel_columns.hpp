#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "batch/kernel/stiffness_kernel.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/model/parameter_values.hpp"

namespace zwidth::internal {

// Memory of one thread.
struct BlockScratch {
  KernelDevices devices;
  KernelAnswers answers;
  KernelScratch kernel;
  std::vector<std::array<double, kernel_inputs>> rows;  // by device
  std::vector<std::vector<std::size_t>> groups;
};

// The numbers of many devices as the kernel takes them.
class KernelColumns {
 public:
  // `changes` must outlive this, and have no problem.
  KernelColumns(const DeviceParameters& base, std::span<const ParameterValues> changes);

  // Whether the structure is one that the kernel knows: one body, or two with one link; no filters of the wall.
  [[nodiscard]] bool suits() const { return suits_; }

  // Of the devices begin to end. Values that make no device are not certain.
  void solve(std::size_t begin, std::size_t end, KernelAnswers& answers, BlockScratch& scratch) const;

 private:
  enum Number : std::size_t {
    actuated_mass,
    other_mass,
    actuated_damping,
    other_damping,
    actuated_stiffness,
    other_stiffness,
    link_stiffness,
    link_damping,
    period,
    delay,
    lag,
    damper,
    velocity_filter,
    user_mass,
    user_damping,
    user_stiffness,
    force_limit,
    numbers
  };
  using Numbers = std::array<double, numbers>;

  [[nodiscard]] Numbers numbers_of(const DeviceParameters& device) const;
  [[nodiscard]] std::size_t number_of(const DeviceParameters& base, const std::string& key) const;
  [[nodiscard]] bool take(std::size_t i, Numbers& values) const;

  bool suits_ = false;
  bool two_bodies_ = false;
  bool collocated_ = true;
  bool holds_actuated_ = true;
  Numbers base_{};
  struct Column {
    std::size_t number;  // `numbers`: no limit depends on it
    std::span<const double> values;
  };
  std::vector<Column> columns_;
};

}  // namespace zwidth::internal
