#include "model/exact_modal_form.hpp"

#include <utility>

#include "model/exact_partial_fractions.hpp"

namespace zwidth::internal {

struct ExactlyFound {
  IntegerPolynomial denominator;
  KnownPoles poles;
};

ModalForm exact_modal_form(const Device& device, const WeightedPath& path, const DrivePath& drive,
                           const PoleLabels& labels, std::shared_ptr<ExactlyFound>& found) {
  if (!found) found = std::make_shared<ExactlyFound>();
  ExactFraction fraction = device.is_mechanical() ? exact_fraction(device, path, found->denominator)
                                                  : exact_fraction(*device.parameters().transfer_function);
  return exact_partial_fractions(std::move(fraction), drive, labels, found->poles);
}

}  // namespace zwidth::internal
