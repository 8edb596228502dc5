#pragma once

#include <optional>
#include <vector>

#include "model/exact_poles.hpp"
#include "model/extended_precision.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/model/modal_form.hpp"

namespace zwidth::internal {

// What all paths of a device have in common, as far as it is known.
struct FoundPoles {
  std::optional<std::vector<Complex<Extended>>> poles;  // those that are not 0, nor the lag's
  bool do_not_converge = false;                         // in double-double
  KnownPoles exact;
  IntegerPolynomial exact_denominator;
};

// modal_form() of one device along several paths: their poles, most of the work, are found once.
class ModalForms {
 public:
  // A device with bodies, which must outlive this.
  ModalForms(const Device& device, ActuatorLag lag);

  // Throws Error (no_such_body), and as modal_form() does.
  [[nodiscard]] ModalForm along(Path path);

 private:
  const Device& device_;
  double lag_;
  FoundPoles found_;
};

}  // namespace zwidth::internal
