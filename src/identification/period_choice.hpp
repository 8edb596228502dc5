#pragma once

#include <functional>

#include "zwidth/identification/identification.hpp"

namespace zwidth::internal {

/// identify() with the periods of a force that was found to repeat averaged; or, where something drifts or dies out over
/// them, which leaks into all lines alike or passes for noise, with the first one left out, or none averaged: as that
/// leaves less of the response unexplained, or the critical stiffness less open.
/// `identified`: with such options. Throws what it throws, where no choice has an answer.
[[nodiscard]] Identification with_periods_chosen(
    const IdentifyOptions& options, const Progress& progress,
    const std::function<Identification(const IdentifyOptions&, const Progress&)>& identified);

}  // namespace zwidth::internal
