#pragma once

#include <cstddef>
#include <vector>

#include "model/extended_precision.hpp"
#include "zwidth/model/modal_form.hpp"

namespace zwidth::internal {

// The closed loop of a sampled plant with delayed feedback, polynomials of x = z - 1 by rising powers:
//
//     numerator z^late / (open z^late + fed_back)
//
// `open` is monic and of the highest degree, fed_back without its x^late being of a lower one. It stays in these parts: as one
// polynomial of x it would lose a digit with every two samples of delay.
struct Feedback {
  std::vector<Extended> numerator;
  std::vector<Extended> open;
  std::vector<Extended> fed_back;
  std::size_t late = 0;
};

// The same as a sum of terms, and where it has its poles.
struct FeedbackForm {
  ModalForm form;                        // in x; none of its modes means anything
  Extended at_once{0.0};                 // what remains where z is large
  std::vector<Complex<Extended>> poles;  // all, in x
};

// `band`: the angle up to which the loop counts, and beyond which only beside what it is there: pi over the number of its
// samples of which one is seen. Throws Error (did_not_converge) where the terms do not add up to the loop on |z| = 1.
FeedbackForm feedback_form(const Feedback& loop, double band);

}  // namespace zwidth::internal
