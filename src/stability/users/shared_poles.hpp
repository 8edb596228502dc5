#pragma once

#include <complex>
#include <cstddef>
#include <vector>

#include "zwidth/model/modal_form.hpp"

namespace zwidth::internal {

// Several modal forms of one device, evaluated together: their denominators are the same.
class SharedPoles {
 public:
  void add(const ModalForm& form);
  [[nodiscard]] std::size_t size() const noexcept { return forms_.size(); }

  // response() of each, in the order in which they came; false where the terms of one cancel beyond 6 digits.
  [[nodiscard]] bool responses(double frequency, std::complex<double>* values) const;

 private:
  [[nodiscard]] bool sum_each(double frequency, std::complex<double>* values) const;

  struct Pair {  // s² + d1 s + d0
    double d0 = 0.0;
    double d1 = 0.0;
    std::vector<double> numerators;  // n0 and n1 of each form
  };

  std::vector<ModalForm> forms_;
  std::vector<Pair> pairs_;
  bool are_shared_ = true;  // by all forms, and no other poles
};

}  // namespace zwidth::internal
