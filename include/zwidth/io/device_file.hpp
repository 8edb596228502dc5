#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "zwidth/io/input_error.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/remark.hpp"

namespace zwidth {

/// Whether a device's text may name files beside it, as a mechanism's.
enum class FilesBeside { read, refused };

/// Reads a device from TOML text.
///
/// `overrides` are "KEY=VALUE", applied in order after the text: loop.delay=0.25e-3,
/// body.motor.damping=0.2, link.0.stiffness=..., link.stiffness=... where there is one link. VALUE is a TOML value; a
/// bare word is taken as a string (loop.sensed=handle). A key that the file left out may be set.
///
/// A device without a name takes that of the file; motion is linear unless given.
///
/// Never throws on any bytes. `source` names the text in errors; files that it names are beside that.
[[nodiscard]] tl::expected<Device, InputError> parse_device(std::string_view text, std::string_view source,
                                                            std::span<const std::string> overrides = {},
                                                            FilesBeside files = FilesBeside::read);

/// Reads a device file ("-": standard input). Refuses what is not a regular file or pipe, is unreadable, is larger than
/// device_file_size_limit, or is not UTF-8 text.
[[nodiscard]] tl::expected<Device, InputError> read_device_file(const std::string& path,
                                                                std::span<const std::string> overrides = {});

/// The device as TOML text that parse_device() reads back to exactly the same values.
///
/// Numbers have as many digits as that takes (at most 17). Throws Error (invalid_argument) where find_problem() finds
/// one.
[[nodiscard]] std::string write_device(const DeviceParameters& parameters);

/// The same with what its user should know as comments at the head, a line each: whoever reads the file later is told too.
[[nodiscard]] std::string write_device(const DeviceParameters& parameters, std::span<const Remark> remarks);

inline constexpr std::size_t device_file_size_limit = std::size_t{1} << 20;  ///< bytes; larger ones are refused

}  // namespace zwidth
