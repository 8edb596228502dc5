#include "identification/model/motion_model.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "identification/model/segment_player.hpp"

namespace zwidth::internal {

MotionModel::MotionModel(DeviceFamily family, MotionTerms terms, std::vector<ForceMotionRecord> records, int substeps)
    : family_(std::move(family)), terms_(std::move(terms)), records_(std::move(records)), substeps_(substeps) {
  for (const ForceMotionRecord& record : records_) {
    double squares = 0.0;
    for (std::size_t k = 1; k < record.position.size(); ++k)
      squares += std::pow(record.position[k] - record.position[k - 1], 2);
    const double change = std::sqrt(squares / static_cast<double>(record.position.size()));
    double largest = 0.0;
    for (const double each : record.force) largest = std::max(largest, std::abs(each));
    constexpr double typical_samples = 10.0;
    units_.push_back({change * typical_samples, change / record.sampling_period, largest});
  }
  const Device device = family_.recorded_device(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(numbers().size())));
  bodies_ = static_cast<Eigen::Index>(device.bodies().size());
  sensed_ = static_cast<Eigen::Index>(device.loop().sensed);
  for (const Body& body : device.bodies()) names_.push_back(body.name);
}

Eigen::VectorXd MotionModel::recorded_state(const Segment& segment) const {
  constexpr std::size_t reach = 5;
  const ForceMotionRecord& record = records_[segment.record];
  const std::size_t begin = segment.first < reach ? 0 : segment.first - reach;
  const std::size_t end = std::min(record.position.size(), segment.first + reach + 1);
  const auto n = static_cast<double>(end - begin);
  const double middle = 0.5 * static_cast<double>(begin + end - 1);
  double mean = 0.0;
  double slope = 0.0;
  double squares = 0.0;
  for (std::size_t k = begin; k < end; ++k) mean += record.position[k] / n;
  for (std::size_t k = begin; k < end; ++k) {
    slope += (static_cast<double>(k) - middle) * (record.position[k] - mean);
    squares += std::pow(static_cast<double>(k) - middle, 2);
  }
  slope /= squares;
  Eigen::VectorXd state = Eigen::VectorXd::Zero(states());
  state(0) = (mean + slope * (static_cast<double>(segment.first) - middle)) / units_[segment.record].position;
  state.tail(bodies_).setConstant(slope / record.sampling_period / units_[segment.record].velocity);
  return state;
}

std::optional<std::vector<PlayedSegment>> MotionModel::play(const Eigen::VectorXd& x,
                                                            const std::vector<Segment>& segments,
                                                            const std::vector<Eigen::VectorXd>& states,
                                                            bool with_slopes) const {
  if (!family_.has_device_at(x)) return std::nullopt;
  const auto numbers = static_cast<Eigen::Index>(this->numbers().size());
  const Eigen::Index columns = numbers + this->states();
  std::vector<PlayedSegment> played(segments.size());
  std::optional<PlayedDevice> device;
  for (std::size_t s = 0; s < segments.size(); ++s) {
    const Segment& segment = segments[s];
    const ForceMotionRecord& record = records_[segment.record];
    const Units& units = units_[segment.record];
    if (!device || segments[s - 1].record != segment.record) {
      device.emplace(family_, terms_, names_, segment.record, units.largest_force, record.sampling_period, substeps_, x,
                     with_slopes);
    }
    SegmentPlayer player(*device, bodies_, columns);
    Eigen::VectorXd unit(this->states());
    unit.head(bodies_).setConstant(units.position);
    unit.tail(bodies_).setConstant(units.velocity);
    player.x.head(this->states()) = states[s].cwiseProduct(unit);
    if (sensed_ != 0) player.x(0) -= player.x(sensed_);  // the state has the sensed body's place
    for (Eigen::Index i = 0; with_slopes && i < this->states(); ++i) player.slopes(i, numbers + i) = unit(i);
    if (with_slopes && sensed_ != 0) player.slopes(0, numbers + sensed_) = -unit(sensed_);

    player.bend_as_recorded(record, segment.first);

    PlayedSegment& out = played[s];
    out.positions.resize(static_cast<Eigen::Index>(segment.count));
    out.slopes.resize(with_slopes ? static_cast<Eigen::Index>(segment.count) : 0, columns);
    const std::ptrdiff_t first = static_cast<std::ptrdiff_t>(segment.first) - device->delay_samples;
    const auto share_at = [&](std::size_t k) {
      return static_cast<double>(segment.first + k) / static_cast<double>(record.position.size());
    };
    DriveForce older = player.given(record, first - 1, share_at(0));
    if (player.x.size() > this->states()) player.x(this->states()) = older.force;  // the lagged force
    for (std::size_t k = 0; k < segment.count; ++k) {
      const auto row = static_cast<Eigen::Index>(k);
      out.positions(row) = player.x(0) + (sensed_ == 0 ? 0.0 : player.x(sensed_));
      if (with_slopes) {
        const double* first_body = player.slopes.row(0).data();
        const double* beside = player.slopes.row(sensed_).data();
        for (Eigen::Index c = 0; c < columns; ++c)
          out.slopes(row, c) = sensed_ == 0 ? first_body[c] : first_body[c] + beside[c];
      }
      const double share = share_at(k);
      for (int part = 0; part < device->before.count; ++part) player.move(device->before, older, share);
      const DriveForce newer = player.given(record, first + static_cast<std::ptrdiff_t>(k), share);
      for (const auto& [number, slope] : device->instants) {
        if (with_slopes)
          player.slopes.col(number).head(player.x.size()) += device->input * ((older.force - newer.force) * slope);
      }
      for (int part = 0; part < device->after.count; ++part) player.move(device->after, newer, share);
      older = newer;
    }
    constexpr double beyond = 1e12;
    const bool stays = std::isfinite(player.x(0)) && out.positions.cwiseAbs().maxCoeff() < beyond * units.position;
    if (!stays) return std::nullopt;
  }
  return played;
}

}  // namespace zwidth::internal
