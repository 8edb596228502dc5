#pragma once

#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "zwidth/identification/identification.hpp"
#include "zwidth/identification/record_fit.hpp"

namespace zwidth::internal {

/// Whether fewer points of a response stand out of their noise (by three deviations) than so many numbers need.
[[nodiscard]] bool is_drowned(const FrequencyResponse& response, std::size_t numbers);

/// What is to be judged.
struct JudgedFit {
  const RecordFit& fit;
  const Device& structure;
  const IdentifyOptions& options;
  const CriticalStiffness& critical;  ///< of fit.fit.device, in its wall
  const std::optional<ShownFriction>& friction;
};

struct Judgement {
  std::vector<Remark> remarks;
  Trust trust;         ///< of the critical stiffness
  Trust device_trust;  ///< of the device for any other purpose: open numbers count too
  /// The response shows the device's critical stiffness without any model, within a factor of 2.
  bool is_measured = false;
};

/// How far the fitted device may be relied on; see identify().
[[nodiscard]] Judgement judge(const JudgedFit& judged);

/// A sound answer whose recordings show a force that is not linear (find_nonlinearity()) becomes doubtful.
void judge_nonlinearity(Identification& result, std::span<const Recording> recordings, const IdentifyOptions& options);

/// K_CR with the wall's damper and filters, as analyze() gives it.
[[nodiscard]] CriticalStiffness limit_of(const Device& device);

/// Of a structure whose values are placeholders: the numbers of the bodies held still, which no recording of that
/// experiment shows.
[[nodiscard]] std::vector<std::string> unseen_placeholders(const std::vector<std::string>& locked,
                                                           IdentifyOptions::StructureValues values);

/// What the structure only assumes (Uncertainty::assumed) and the data do not determine stays assumed in the fitted
/// device, as do these placeholders; for it all these are doubtful. Where the structure's file is doubtful or refused and a
/// mass, spring or damper of it is not determined by the data, all these are so too.
void keep_what_is_assumed(const Device& structure, std::span<const ParameterEstimate> estimates,
                          std::vector<std::string> placeholders, Device& fitted, std::initializer_list<Trust*> trusts);

/// The verdict into the fitted device's [uncertainty], so that its file keeps it.
[[nodiscard]] Device with_trust(const Device& device, const Trust& trust);

/// Keys of what a fit determined or left open, in full.
[[nodiscard]] std::vector<std::string> keys_of(const ParameterFit& fit);

}  // namespace zwidth::internal
