#include "cli/structure_arguments.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "cli/input_problem.hpp"
#include "cli/option_refusal.hpp"
#include "cli/request_context.hpp"
#include "cli/subcommand.hpp"
#include "zwidth/identification/identification.hpp"
#include "zwidth/io/device_file.hpp"
#include "zwidth/io/message_words.hpp"
#include "zwidth/model/parameter.hpp"

namespace zwidth::cli {
namespace {

constexpr const char* structure_group = "Structure";

std::string nearest_or_all(const std::string& word, const std::vector<std::string>& known) {
  const std::string nearest = nearest_word(word, known);
  return nearest.empty() ? fmt::format("; one of {}", fmt::join(known, ", "))
                         : fmt::format("; did you mean {}?", nearest);
}

void check(const NamedStructureOptions& options) {
  constexpr std::pair<std::string_view, std::string_view> own_options[] = {{"sampling_period", "--sampling-period"}};
  if (const auto problem = find_problem(options)) refuse(*problem, own_options);
}

Structure structure_by_name(const StructureArguments& arguments, std::optional<double> record_period,
                            std::span<const Recording> recordings) {
  const NamedStructureOptions options{asked_motion(arguments), arguments.sampling_period, record_period,
                                      stated_motion(recordings)};
  check(options);
  const NamedStructure named = named_structure(arguments.structure, options).value();
  auto device = parse_device(write_device(named.parameters), arguments.structure, arguments.overrides);
  if (!device) refuse_input(device.error());
  return {*std::move(device), named.values};
}

Device structure_from_file(const StructureArguments& arguments) {
  if (!arguments.motion.empty()) {
    throw BadInput("--motion", "is for a named structure",
                   "a device file says itself what its motion is; leave out the option");
  }
  std::vector<std::string> overrides = arguments.overrides;
  if (arguments.sampling_period) {
    check(NamedStructureOptions{.sampling_period = arguments.sampling_period});
    overrides.push_back(fmt::format("loop.sampling_period={}", *arguments.sampling_period));
  }
  auto device = read_named_device(*arguments.command, arguments.structure, overrides);
  if (!device) {
    const InputPlace& place = device.error().place;
    const bool is_no_device = place.line == 0 && place.key.empty();  // there is no file of the name
    refuse_input(device.error(), is_no_device ? "--structure" : "");
  }
  if (!device->has_bodies()) {
    throw BadInput("--structure", fmt::format("{}: is a transfer function", arguments.structure), "a device of bodies");
  }
  return *std::move(device);
}

}  // namespace

std::optional<Motion> asked_motion(const StructureArguments& arguments) {
  if (arguments.motion.empty()) return std::nullopt;
  return arguments.motion == "rotary" ? Motion::rotary : Motion::linear;
}

void add_structure_arguments(CLI::App& command, StructureArguments& arguments) {
  arguments.command = &command;
  command.add_option("--structure", arguments.structure, "Device file to fit, or rigid, two-body or three-body")
      ->type_name("DEVICE")
      ->required()
      ->group(structure_group);
  command
      .add_option("--free", arguments.free,
                  "Keys to fit; all (the default): masses, dampings, link stiffnesses;\n"
                  "stiffness to ground, delay and lag where the structure has them;\n"
                  "a delay where the record shows one")
      ->type_name("KEYS")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->group(structure_group);
  command.add_option("--locked", arguments.locked, "Bodies held still in the experiment")
      ->type_name("BODIES")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->group(structure_group);
  command.add_option("--set", arguments.overrides, "Override a key of the structure; may be repeated")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false)
      ->group(structure_group);
  command
      .add_option("--motion", arguments.motion,
                  "Of a named structure: linear or rotary; else by\nthe columns' units, else linear")
      ->type_name("KIND")
      ->check(CLI::IsMember({"linear", "rotary"}))
      ->group(structure_group);
  command
      .add_option("--sampling-period", arguments.sampling_period,
                  "Of the loop to judge, in s; else the structure's or record's")
      ->type_name("S")
      ->group(structure_group);
}

Structure structure(const StructureArguments& arguments, std::optional<double> record_period,
                    std::span<const Recording> recordings) {
  Structure structure = names_structure(arguments.structure) ? structure_by_name(arguments, record_period, recordings)
                                                             : Structure{structure_from_file(arguments)};
  const Device& device = structure.device;
  std::vector<std::string> names;
  for (const Body& body : device.bodies()) names.push_back(body.name);
  for (const std::string& name : arguments.locked) {
    if (std::ranges::count(names, name) == 0) {
      throw BadInput("--locked", fmt::format("there is no body {}{}", name, nearest_or_all(name, names)));
    }
  }
  const std::vector<std::string> keys = parameter_keys(device.parameters());
  for (const std::string& given : arguments.free) {
    if (given != "all" && std::ranges::count(keys, full_parameter_key(device.parameters(), given)) == 0) {
      throw BadInput("--free", fmt::format("no parameter is called {}{}", given, nearest_or_all(given, keys)));
    }
  }
  return structure;
}

}  // namespace zwidth::cli
