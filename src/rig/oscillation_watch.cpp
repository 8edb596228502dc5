#include "zwidth/rig/oscillation_watch.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "require_argument.hpp"
#include "zwidth/signal/ring_down.hpp"

namespace zwidth {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double highest_share = 0.98;  // of Nyquist's frequency
constexpr int rises_of_growth = 4;      // windows in a row
constexpr double growth = 1.5;          // over them
constexpr int least_crossings = 8;      // of the mean, in a window of the lowest frequency
constexpr double least_share = 0.1;     // of the window's swing
constexpr std::size_t shortest_window = 16;

}  // namespace

OscillationWatch::OscillationWatch(std::span<const double> frequencies, double sampling_period, double floor)
    : period_(sampling_period), floor_(floor) {
  internal::require_positive({"sampling period", sampling_period, "s"});
  internal::require_not_negative({"floor", floor});
  for (const double frequency : frequencies) {
    const double step = frequency * sampling_period;
    if (!(step > 0.0 && step < highest_share * pi) || count_ == most_frequencies) continue;
    Band& band = bands_[count_++];
    band.frequency = frequency;
    band.length =
        std::max(shortest_window, static_cast<std::size_t>(std::lround(ring_window_cycles * 2.0 * pi / step)));
    band.turn = std::polar(1.0, -step);
    band.window_turn = std::polar(1.0, 2.0 * pi / static_cast<double>(band.length));
    band.scale = 4.0 / static_cast<double>(band.length);
    for (std::size_t n = 0; n < band.length; ++n) {
      const auto index = static_cast<double>(n);
      band.leakage += (0.5 - 0.5 * std::cos(index * std::arg(band.window_turn))) * std::polar(1.0, -step * index);
    }
    sweep_.length = std::max(sweep_.length, band.length);
  }
}

bool OscillationWatch::Rise::update(double amplitude) noexcept {
  if (amplitude > last && last > 0.0) {
    if (windows++ == 0) lowest = last;
  } else {
    windows = 0;
  }
  before = last;
  last = amplitude;
  return windows >= rises_of_growth && amplitude > growth * lowest;
}

bool OscillationWatch::advance(Band& band, double position) const noexcept {
  const double weight = 0.5 - 0.5 * band.hann.real();
  band.sum += weight * position * band.carrier;
  band.position_sum += position;
  band.square_sum += position * position;
  band.carrier *= band.turn;
  band.hann *= band.window_turn;
  if (++band.sample < band.length) return false;
  const auto length = static_cast<double>(band.length);
  const double mean = band.position_sum / length;
  const double amplitude = band.scale * std::abs(band.sum - mean * band.leakage);
  const double variance = band.square_sum / length - mean * mean;
  const bool moves_it = amplitude * amplitude > 2.0 * least_share * least_share * variance;
  band.sample = 0;
  band.position_sum = band.square_sum = 0.0;
  band.sum = 0.0;
  band.carrier = band.hann = 1.0;
  return band.rise.update(amplitude) && amplitude > floor_ && moves_it;
}

bool OscillationWatch::sweep(double position) noexcept {
  const bool is_above = position > sweep_.mean;
  if (is_above != sweep_.is_above) ++sweep_.crossings;
  sweep_.is_above = is_above;
  sweep_.position_sum += position;
  sweep_.square_sum += position * position;
  if (++sweep_.sample < sweep_.length) return false;
  const auto length = static_cast<double>(sweep_.length);
  const double mean = sweep_.position_sum / length;
  const double amplitude = std::sqrt(std::max(0.0, 2.0 * (sweep_.square_sum / length - mean * mean)));
  const int crossings = sweep_.crossings;
  sweep_ = {.length = sweep_.length, .mean = mean, .is_above = position > mean};
  const bool oscillates = crossings >= least_crossings;
  if (!oscillates) sweep_rise_ = {};
  if (!oscillates || !sweep_rise_.update(amplitude) || !(amplitude > floor_)) return false;
  if (!detected_) frequency_ = pi * crossings / (length * period_);
  return true;
}

WatchedSwing OscillationWatch::strongest() const noexcept {
  const Band* most = nullptr;
  for (std::size_t i = 0; i < count_; ++i) {
    if (most == nullptr || bands_[i].rise.last > most->rise.last) most = &bands_[i];
  }
  if (most == nullptr) return {};
  WatchedSwing swing{most->frequency, most->rise.last, 0.0};
  const bool has_both = most->rise.before > 0.0 && most->rise.last > 0.0;
  if (has_both) {
    swing.growth_rate = std::log(most->rise.last / most->rise.before) / (static_cast<double>(most->length) * period_);
  }
  return swing;
}

bool OscillationWatch::update(double position) noexcept {
  if (!started_) {
    started_ = true;
    origin_ = position;
  }
  for (std::size_t i = 0; i < count_; ++i) {
    if (!advance(bands_[i], position - origin_) || detected_) continue;
    detected_ = true;
    frequency_ = bands_[i].frequency;
  }
  if (count_ > 0 && sweep(position - origin_)) detected_ = true;
  return detected_;
}

}  // namespace zwidth
