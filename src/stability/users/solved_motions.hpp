#pragma once

#include <complex>
#include <utility>
#include <vector>

#include "model/device_matrices.hpp"
#include "zwidth/model/device.hpp"

namespace zwidth::internal {

// Motions per force at one point by solving (K - w² M + jw D) x = f in long double. Far above all modes a body several
// links away moves as a high power of 1/w, of which a sum of modal terms, each of 1/w², keeps no digit; elimination
// loses none there, and beside a zero of the motion three fewer.
class SolvedMotions {
 public:
  SolvedMotions() = default;
  // The device must have bodies or coordinates.
  SolvedMotions(const Device& device, Weights forced);

  void add(Weights motion) { motions_.push_back(std::move(motion)); }

  // Of each, in the order in which they came.
  void responses(double frequency, std::complex<double>* values) const;

 private:
  DeviceMatrices<long double> matrices_;
  Weights forced_;
  std::vector<Weights> motions_;
};

}  // namespace zwidth::internal
