#pragma once

#include <CLI/App.hpp>
#include <string>
#include <vector>

#include "cli/recording_arguments.hpp"
#include "cli/structure_arguments.hpp"
#include "zwidth/identification/time_domain.hpp"

namespace zwidth::cli {

/// What only `identify --method time-domain` takes.
struct TimeDomainArguments {
  double segment = TimeDomainOptions{}.segment;
};

/// Declares the options; `arguments` must outlive the parsing.
void add_time_domain_options(CLI::App& command, TimeDomainArguments& arguments);

/// Throws BadInput for options on the command line that only other methods have.
void check_time_domain_options(const CLI::App& command);

/// Throws BadInput for options on the command line that only the fit in time has.
void refuse_time_domain_options(const CLI::App& command);

/// Reads the recordings and fits the structure. Throws BadInput: a file or a record that is refused; WorkFailed.
[[nodiscard]] TimeDomainIdentification fitted_in_time(const RecordingArguments& recording,
                                                      const StructureArguments& structure_given,
                                                      const TimeDomainArguments& arguments);

}  // namespace zwidth::cli
