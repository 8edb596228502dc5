#pragma once

// modal_form() without rounding, where double-double does not carry. Who includes this needs no exact numbers itself.

#include <memory>

#include "model/device_lengths.hpp"
#include "model/pole_groups.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/model/modal_form.hpp"

namespace zwidth::internal {

// Except where |G| is below this share of its largest value at a pole: a critical stiffness 1/|G| is beyond use there.
inline constexpr double irrelevant_below = 1e-9;

// What all paths of a device have in common, as far as it is known: the denominator and its poles.
struct ExactlyFound;

// `path`: of a device with bodies or coordinates. `found`: empty for the first path of a device, and given again for its others.
// Throws Error (did_not_converge) for more bodies than the exact determinant can take, and where terms of
// ModalTerm::max_degree still cancel too much.
ModalForm exact_modal_form(const Device& device, const WeightedPath& path, const DrivePath& drive,
                           const PoleLabels& labels, std::shared_ptr<ExactlyFound>& found);

}  // namespace zwidth::internal
