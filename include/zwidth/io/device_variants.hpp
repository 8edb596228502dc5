#pragma once

#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "zwidth/io/input_error.hpp"
#include "zwidth/model/device_variants.hpp"

namespace zwidth {

/// The device with each value of "KEY=VALUE,VALUE", KEY as in an override of parse_device(): loop.delay=0,1e-3. The body
/// that is actuated, sensed or held needs no "loop.": sensed=motor,handle. A list of numbers in brackets is one value.
///
/// Refuses, every value by itself, what an override would be refused for; and fewer than two values, or one twice.
[[nodiscard]] tl::expected<DeviceVariants, std::vector<InputError>> device_variants(const Device& device,
                                                                                    std::string_view assignment);

}  // namespace zwidth
