#pragma once

#include "stability/second_route/pole_count.hpp"
#include "zwidth/model/modal_form.hpp"
#include "zwidth/remark.hpp"
#include "zwidth/stability/analysis.hpp"

namespace zwidth::internal {

/// What the limit and the wall of one rate are judged by.
struct OneRate {
  OneRate(const Device& device, const ModalForm& form)
      : plant(filtered_plant(sample(form, {device.loop().sampling_period, device.loop().delay}),
                             device.parameters().wall.filters)),
        poles(device) {}
  FilteredPlant plant;
  PoleCount poles;
};

/// The wall given, and whether the second route agrees on it.
void judge_wall(const Device& device, const FilteredPlant& plant, const PoleCount& poles, Analysis& analysis);
/// The same of a damper in a loop of its own.
void judge_two_rate_wall(const Device& device, Analysis& analysis);

/// Whether what hits the wall rings for long, though it is stable.
void judge_damping_of_wall(Analysis& analysis);

/// What is known of one loop alone.
[[nodiscard]] Remark left_out_beside_damper_loop(const char* what);

}  // namespace zwidth::internal
