#include "signal/averaged_spectra.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

#include "signal/fourier.hpp"
#include "signal/window_function.hpp"

namespace zwidth::internal {
namespace {

using Complex = std::complex<double>;

/// Segments between two calls of progress.
constexpr std::size_t progress_stride = 64;

/// Two real signals as the parts of one complex signal, so that one transform gives the spectra of both.
class PackedSignals {
 public:
  PackedSignals(std::span<const double> force, std::span<const double> output, SignalForm form)
      : force_(force), output_(output), form_(form) {
    double force_energy = 0.0;
    double output_energy = 0.0;
    for (std::size_t i = 0; i < size(); ++i) {
      const double f = value(force_, i);
      const double x = value(output_, i);
      force_energy += f * f;
      output_energy += x * x;
    }
    // Of equal size, so that neither drowns in the rounding of the other.
    if (force_energy > 0.0 && output_energy > 0.0) scale_ = std::sqrt(force_energy / output_energy);
  }

  [[nodiscard]] std::size_t size() const { return force_.size() - (form_ == SignalForm::differenced ? 1 : 0); }

  /// What the output is multiplied by.
  [[nodiscard]] double output_scale() const { return scale_; }

  void windowed(std::size_t start, const std::vector<double>& window, std::vector<Complex>& packed) const {
    for (std::size_t i = 0; i < window.size(); ++i) {
      packed[i] = {window[i] * value(force_, start + i), window[i] * scale_ * value(output_, start + i)};
    }
  }

 private:
  [[nodiscard]] double value(std::span<const double> signal, std::size_t i) const {
    return form_ == SignalForm::differenced ? signal[i + 1] - signal[i] : signal[i];
  }

  std::span<const double> force_;
  std::span<const double> output_;
  SignalForm form_;
  double scale_ = 1.0;
};

/// Z = F + j X of real f and x:  F[k] = (Z[k] + conj Z[-k]) / 2,  X[k] = (Z[k] - conj Z[-k]) / 2j. The factors 1/2 are
/// left out: they cancel.
void accumulate(const std::vector<Complex>& packed, AveragedSpectra& sums) {
  const std::size_t length = packed.size();
  for (std::size_t k = 1; k < sums.ff.size(); ++k) {
    const Complex plus = packed[k];
    const Complex minus = packed[length - k];
    const double force_real = plus.real() + minus.real();
    const double force_imag = plus.imag() - minus.imag();
    const double output_real = plus.imag() + minus.imag();
    const double output_imag = minus.real() - plus.real();
    sums.ff[k] += force_real * force_real + force_imag * force_imag;
    sums.xx[k] += output_real * output_real + output_imag * output_imag;
    sums.fx_real[k] += force_real * output_real + force_imag * output_imag;
    sums.fx_imag[k] += force_real * output_imag - force_imag * output_real;
  }
}

}  // namespace

Segments segments_of(std::size_t samples, std::size_t length, Window window, double overlap) {
  Segments segments;
  segments.length = length;
  const double step = std::round((1.0 - overlap) * static_cast<double>(length));
  segments.step = std::max<std::size_t>(1, static_cast<std::size_t>(step));
  segments.count = 1 + (samples - length) / segments.step;
  segments.window = window_function(window, length);
  segments.averages = independent_segments(segments.window, segments.count, segments.step);
  return segments;
}

AveragedSpectra averaged_spectra(std::span<const double> force, std::span<const double> output,
                                 const Segments& segments, SignalForm form, const Progress& progress) {
  const PackedSignals signals(force, output, form);
  const std::vector<double> zeros(segments.length / 2 + 1);
  AveragedSpectra sums{zeros, zeros, zeros, zeros, signals.output_scale()};
  FourierTransform transform(segments.length);
  std::vector<Complex> time(segments.length);
  std::vector<Complex> lines(segments.length);
  for (std::size_t segment = 0; segment < segments.count; ++segment) {
    if (progress && segment % progress_stride == 0) {
      progress(static_cast<double>(segment) / static_cast<double>(segments.count));
    }
    signals.windowed(segment * segments.step, segments.window, time);
    transform.forward(time, lines);
    accumulate(lines, sums);
  }
  return sums;
}

}  // namespace zwidth::internal
