#include "stability/users/disc_pieces.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

namespace zwidth::internal {
namespace {

using std::numbers::pi;
constexpr double clear_ellipse = 2.5;      // sum of semi-axes, see interpolation_error()
constexpr double sums_accuracy = 1e-12;    // relative to the largest value of a piece
constexpr double rounding_of_sums = 1e-8;  // above sums_accuracy, where halving a piece does not help
constexpr double still_converging = 0.25;
constexpr double narrowest_sums = 1e-9;  // of Nyquist
constexpr std::size_t most_sum_pieces = 120;
constexpr double first_ratio = 4.0;     // of the ends of a piece
constexpr double most_turning = 8.0;    // rad of the delay in a piece
constexpr double of_slowest = 0.5;      // the first piece ends at this share of the slowest pole
constexpr double beside_pieces = 0.05;  // of Nyquist
constexpr double towards_zero = 0.03;   // where a piece that begins at a zero of Re Y is divided
constexpr double around_zero = 0.25;    // of its image: how far pieces are counted from there, at most
constexpr double lowest_end = 1e-9;     // rad per sample, of the first piece

using Singularity = AliasSums::Singularity;

bool is_clear(double begin, double end, const std::vector<Singularity>& singularities) {
  return std::all_of(singularities.begin(), singularities.end(), [&](const Singularity& each) {
    return ellipse_through(begin, end, each.position, each.depth) >= clear_ellipse;
  });
}

/// Where the sums over the other aliases see the modes: at their images on either side of a whole number of 2 pi/T.
std::vector<Singularity> images_of(const ModalForm& form, double period) {
  const double nyquist = pi / period;
  std::vector<Singularity> images;
  for (const Mode& mode : form.modes) {
    if (mode.damping_ratio >= 1.0) continue;  // images of real poles lie at 2 pi k/T
    const double frequency = mode.frequency * std::sqrt(1.0 - mode.damping_ratio * mode.damping_ratio);
    const double depth = mode.frequency * mode.damping_ratio;
    const double folded = std::abs(std::remainder(frequency, 2.0 * nyquist));
    if (frequency > nyquist) images.push_back({folded, depth});
    images.push_back({2.0 * nyquist - folded, depth});
  }
  return images;
}

/// The same of the zeros of Re Y, the poles of discs; those of the frequency itself are taken off by a factor.
void add_zeros(const TerminationDiscs& discs, double period, std::vector<Singularity>& images) {
  const double nyquist = pi / period;
  const auto add = [&](double frequency, double depth) {
    if (depth > nyquist) return;
    const double folded = std::abs(std::remainder(frequency, 2.0 * nyquist));
    if (frequency > nyquist) images.push_back({folded, depth});
    images.push_back({2.0 * nyquist - folded, depth});
  };
  for (const DissipationZeros::Zero& zero : discs.zeros().others) add(zero.position, zero.depth);
  for (const SharpZero& zero : discs.zeros().sharp) {  // what is not near enough to be taken off
    const double folded = std::abs(std::remainder(zero.frequency, 2.0 * nyquist));
    if (folded > beside_pieces * nyquist && folded < (1.0 - beside_pieces) * nyquist) {
      images.push_back({2.0 * nyquist - folded, zero.depth * zero.frequency});
      images.push_back({-folded, zero.depth * zero.frequency});
    }
  }
}

/// Poles of the wall's filters, s = log(1 + delta)/T, and their images above Nyquist.
std::vector<Singularity> poles_of(const std::vector<FilterSection>& filters, double period) {
  std::vector<Singularity> poles;
  for (const FilterSection& section : filters) {
    std::complex<double> first = -section.denominator[0];
    std::complex<double> second = first;
    if (section.degree == 2) {
      const double half = -0.5 * section.denominator[1];
      const std::complex<double> root = std::sqrt(std::complex<double>(half * half - section.denominator[0]));
      first = half + root;
      second = half - root;
    }
    for (const std::complex<double>& delta : {first, second}) {
      if (section.degree == 0 || std::abs(1.0 + delta) < 1e-12) continue;
      const std::complex<double> s = std::log(1.0 + delta) / period;
      poles.push_back({std::abs(s.imag()), std::abs(s.real())});
      poles.push_back({2.0 * pi / period - std::abs(s.imag()), std::abs(s.real())});
    }
  }
  return poles;
}

}  // namespace

AliasSums::AliasSums(const TerminationDiscs& discs, double period, const std::vector<Singularity>& images)
    : near_(interpolated_sums([&](double w) { return discs.near_aliases(w); }, pi / period, images)),
      far_(interpolated_sums([&](double w) { return discs.far_aliases(w); }, pi / period, {})) {}

template <typename Sums>
AliasSums::Pieces AliasSums::interpolated_sums(const Sums& sums_at, double nyquist,
                                               const std::vector<Singularity>& images) {
  struct Range {
    double begin;
    double end;
    double error;  // of twice the range, relative
  };
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Pieces pieces;
  std::vector<Range> ranges{{0.0, nyquist, infinity}};
  std::size_t left = most_sum_pieces;
  while (!ranges.empty()) {
    const Range range = ranges.back();
    ranges.pop_back();
    const bool is_last = left == 0 || range.end - range.begin < narrowest_sums * nyquist;
    const double middle = 0.5 * (range.begin + range.end);
    double relative = infinity;
    if (is_last || is_clear(range.begin, range.end, images)) {
      if (left > 0) --left;
      Piece piece{range.begin, range.end, {}, {}, {}, 0.0};
      double largest = 0.0;
      for (std::size_t i = 0; i < interpolation_points; ++i) {
        const auto sums = sums_at(middle + 0.5 * (range.end - range.begin) * interpolation_nodes()[i]);
        piece.real[i] = sums.centre.real();
        piece.imaginary[i] = sums.centre.imag();
        piece.radius[i] = sums.radius;
        largest = std::max({largest, sums.radius, std::abs(sums.centre)});
      }
      piece.error =
          interpolation_error(piece.real) + interpolation_error(piece.imaginary) + interpolation_error(piece.radius);
      relative = piece.error / largest;
      const bool is_rounding = relative <= rounding_of_sums && relative > still_converging * range.error;
      if (is_last || relative <= sums_accuracy || is_rounding) {
        pieces.push_back(piece);
        continue;
      }
    }
    ranges.push_back({middle, range.end, relative});
    ranges.push_back({range.begin, middle, relative});
  }
  return pieces;
}

const AliasSums::Piece& AliasSums::piece_at(const Pieces& pieces, double frequency) {
  const auto piece = std::lower_bound(pieces.begin(), pieces.end(), frequency,
                                      [](const Piece& each, double at) { return each.end < at; });
  return piece == pieces.end() ? pieces.back() : *piece;
}

void AliasSums::add(const Piece& piece, double frequency, Value& value) {
  const double x = std::clamp((2.0 * frequency - piece.begin - piece.end) / (piece.end - piece.begin), -1.0, 1.0);
  const InterpolatedAt interpolated(x);
  value.sums.centre += std::complex<double>(interpolated(piece.real), interpolated(piece.imaginary));
  value.sums.radius += interpolated(piece.radius);
  value.error += piece.error;
}

AliasSums::Value AliasSums::at(double frequency) const {
  Value value;
  add(piece_at(near_, frequency), frequency, value);
  add(piece_at(far_, frequency), frequency, value);
  return value;
}

TerminationDiscs::Place DiscPieces::Piece::place_at(double x) const {
  if (begins_at_rest()) return {0.0, end * std::sqrt(0.5 * (1.0 + x))};
  const double offset = 0.5 * (begin + end) + 0.5 * (end - begin) * x;
  return {base, side * offset};
}

DiscPieces::DiscPieces(const TerminationDiscs& discs, const Device& device)
    : discs_(&discs), period_(device.loop().sampling_period) {
  // Centre and radius of a disc have no pole at a mode: the user may hold it still, or make it any other.
  if (!discs.zeros().are_complete) singularities_ = images_of(discs.held_form(), period_);
  add_zeros(discs, period_, singularities_);
  sums_ = AliasSums(discs, period_, singularities_);
  for (const Singularity& each : poles_of(discs.free_plant().filters, period_)) singularities_.push_back(each);
  const double nyquist = pi / period_;
  double slowest = nyquist;
  for (const ModalTerm& term : discs.held_form().terms) {
    // The least root of s^k + ... + d1 s + d0 is no smaller than d0/(sum of the others at 1).
    const auto zeros = static_cast<std::size_t>(std::max(term.integrators, 0));
    if (zeros >= term.degree || term.denominator[zeros] == 0.0) continue;
    const double next = zeros + 1 < term.degree ? term.denominator[zeros + 1] : 1.0;
    const double lowest = next != 0.0 ? std::abs(term.denominator[zeros] / next) : nyquist;
    const double mean = std::pow(std::abs(term.denominator[zeros]), 1.0 / static_cast<double>(term.degree - zeros));
    slowest = std::min({slowest, lowest, mean});
  }
  for (const Singularity& each : singularities_) slowest = std::min(slowest, std::hypot(each.position, each.depth));
  // Of |E| the poles, and the zero of the tracking.
  const DrivePath drive = drive_path_of(device.parameters());
  if (drive.lag > 0.0) slowest = std::min(slowest, 1.0 / drive.lag);
  if (drive.tracking > 0.0) slowest = std::min(slowest, 0.5 * drive.tracking);
  most_width_ = most_turning / (device.loop().delay + period_);
  std::vector<double> images;
  for (const TerminationDiscs::SharpImage& each : discs.sharp_images()) {
    if (each.image > 0.0 && each.image <= nyquist) images.push_back(each.image);
  }
  std::sort(images.begin(), images.end());
  images.erase(std::unique(images.begin(), images.end()), images.end());
  if (!images.empty()) slowest = std::min(slowest, images.front());
  double begin = std::min({of_slowest * slowest, 0.25 * nyquist, most_width_});
  begin = std::max(begin, lowest_end / period_);
  add_first(0.0, begin);
  // Around the images pieces on either side, to the middle between two at most.
  for (std::size_t i = 0; i < images.size(); ++i) {
    const double image = images[i];
    const double next = i + 1 < images.size() ? images[i + 1] : nyquist + (nyquist - image);
    const double widest = std::min(around_zero * image, 0.5 * most_width_);
    const double below = std::min(widest, i > 0 ? 0.5 * (image - images[i - 1]) : image - begin);
    const double above = std::min(widest, 0.5 * (next - image));
    if (image - below > begin) add_between(begin, image - below);
    if (below > 0.0) add_first(0.0, below, image, -1.0);
    if (above > 0.0) add_first(0.0, above, image, 1.0);
    begin = image + above;
  }
  add_between(begin, nyquist);
  first_pieces_ = pieces_.size();
}

/// Pieces whose ends are not too far apart.
void DiscPieces::add_between(double begin, double end) {
  while (begin < end) {
    double next = std::min({first_ratio * begin, begin + most_width_, end});
    if (next > 0.8 * end) next = end;
    add_first(begin, std::min(next, begin + most_width_));
    begin = pieces_.back().end;
  }
}

void DiscPieces::add_first(double begin, double end, double base, double side) {
  pieces_.emplace_back();
  pieces_.back().base = base;
  pieces_.back().side = side;
  pieces_.back().begin = begin;
  pieces_.back().end = end;
}

void DiscPieces::divide(std::size_t index) {
  if (pieces_[index].first_half >= 0) return;
  const double base = pieces_[index].base;
  const double side = pieces_[index].side;
  const double begin = pieces_[index].begin;
  const double end = pieces_[index].end;
  double middle = end > 4.0 * begin ? std::sqrt(begin * end) : 0.5 * (begin + end);
  if (begin == 0.0) middle = base == 0.0 ? end / 3.0 : towards_zero * end;
  pieces_[index].first_half = static_cast<int>(pieces_.size());
  pieces_[index].second_half = static_cast<int>(pieces_.size() + 1);
  const int depth = pieces_[index].depth + 1;
  add_first(begin, middle, base, side);
  pieces_.back().depth = depth;
  add_first(middle, end, base, side);
  pieces_.back().depth = depth;
}

bool DiscPieces::is_clear_of_poles(std::size_t index, double further) const {
  const Piece& piece = pieces_[index];
  const double begin = piece.lowest();
  const double end = piece.highest();
  const auto clear = [&](const Singularity& each) {
    if (!piece.begins_at_rest()) return ellipse_through(begin, end, each.position, each.depth) >= clear_ellipse;
    const std::complex<double> square =
        std::complex<double>(each.position, each.depth) * std::complex<double>(each.position, each.depth);
    return ellipse_through(0.0, end * end, square.real(), square.imag()) >= clear_ellipse;
  };
  return std::all_of(singularities_.begin(), singularities_.end(), clear) &&
         (!std::isfinite(further) || clear({0.0, further}));
}

const DiscPieces::Piece& DiscPieces::sampled(std::size_t index) {
  Piece& piece = pieces_[index];
  if (piece.is_sampled) return piece;
  for (std::size_t i = 0; i < interpolation_points; ++i) {
    const TerminationDiscs::Place place = piece.place_at(interpolation_nodes()[i]);
    const double frequency = place.frequency();
    const AliasSums::Value others = sums_.at(frequency);
    const TerminationDiscs::SplitDisc split = discs_->with_others(place, others.sums, piece.highest());
    const double mirrored = piece.begins_at_rest() ? discs_->mirrored_measures(frequency) : 1.0;
    piece.nodes[i] = {frequency, split.disc, split.factor * mirrored, split.shared * others.error};
  }
  piece.is_sampled = true;
  return piece;
}

TerminationDiscs::Disc DiscPieces::at(const TerminationDiscs::Place& place) const {
  return discs_->with_others(place, sums_.at(place.frequency()).sums, place.frequency()).disc;
}

}  // namespace zwidth::internal
