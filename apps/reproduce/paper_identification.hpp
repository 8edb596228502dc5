#pragma once

#include <cstdint>
#include <string>

#include "zwidth/identification/identification.hpp"

namespace zwidth::report {

/// The experiment of Figs. 4 and 8 as we play it: the paper prints its band and the encoder; the rest is ours.
struct PaperChirp {
  double lowest_hz = 10.0;
  double highest_hz = 200.0;
  double duration = 20.0;      ///< s
  double rest = 1.0;           ///< s without force before and after, so that the ends of the band count in full
  double amplitude = 10.0;     ///< N
  double force_noise = 0.005;  ///< standard deviation of white noise, as part of the amplitude
  std::uint64_t seed = 1;      ///< of the noise
};

/// "10 to 200 Hz in 20 s, 10 N, white force noise of 0.5 %, encoder step 3.14 µm, seed 1": what a reader must know.
[[nodiscard]] std::string paper_chirp_text(const PaperChirp& chirp, const DeviceParameters& device);

/// The cable of a device of the paper identified from a synthetic record: handle locked, chirp on the motor, masses and
/// damping to ground known, stiffness and damping of the cable fitted without a guess; not
/// judged, nor analysed.
[[nodiscard]] Identification identified_cable(const DeviceParameters& device, const PaperChirp& chirp = {});

}  // namespace zwidth::report
