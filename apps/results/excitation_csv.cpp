#include "results/excitation_csv.hpp"

#include <fmt/format.h>

#include <iterator>

namespace zwidth::report {

void write_excitation_csv(const Excitation& excitation, double rate, Motion motion, const Sink& sink) {
  constexpr std::size_t piece_size = std::size_t{1} << 16;
  fmt::memory_buffer piece;
  const auto put = std::back_inserter(piece);
  fmt::format_to(put, "time_s,{}\n", motion == Motion::rotary ? "torque_N_m" : "force_N");
  for (std::size_t k = 0; k < excitation.samples.size(); ++k) {
    fmt::format_to(put, "{},{:.9g}\n", static_cast<double>(k) / rate, excitation.samples[k]);
    if (piece.size() >= piece_size) {
      sink({piece.data(), piece.size()});
      piece.clear();
    }
  }
  sink({piece.data(), piece.size()});
}

}  // namespace zwidth::report
