#pragma once

namespace zwidth {

/// What a segment of a record is multiplied by before its transform.
enum class Window { rectangular, hann, hamming, blackman };

}  // namespace zwidth
