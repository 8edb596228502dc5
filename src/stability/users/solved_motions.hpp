#pragma once

#include <complex>
#include <cstddef>
#include <vector>

#include "model/device_matrices.hpp"
#include "zwidth/model/device.hpp"

namespace zwidth::internal {

// Motions per force at one body by solving (K - w² M + jw D) x = f in long double. Far above all modes a body several
// links away moves as a high power of 1/w, of which a sum of modal terms, each of 1/w², keeps no digit; elimination
// loses none there, and beside a zero of the motion three fewer.
class SolvedMotions {
 public:
  SolvedMotions() = default;
  // The device must have bodies.
  SolvedMotions(const Device& device, std::size_t forced);

  void add_body(std::size_t body) { motions_.push_back({body, body}); }
  void add_length(std::size_t first, std::size_t second) { motions_.push_back({first, second}); }

  // Of each, in the order in which they came.
  void responses(double frequency, std::complex<double>* values) const;

 private:
  struct Motion {
    std::size_t body = 0;
    std::size_t past = 0;  // another body; the same: past ground
  };

  DeviceMatrices<long double> matrices_;
  std::size_t forced_ = 0;
  std::vector<Motion> motions_;
};

}  // namespace zwidth::internal
