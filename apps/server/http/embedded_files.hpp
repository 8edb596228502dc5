#pragma once

#include <span>
#include <string_view>

namespace zwidth::server {

/// A file that was put into the program when it was built (cmake/zwidth_embed.cmake).
struct EmbeddedFile {
  std::string_view name;  ///< "index.html", "assets/index-B2x9.js"
  std::string_view bytes;
};

/// The front end as Vite builds it, each file gzipped; without it one page that says how to build it.
[[nodiscard]] std::span<const EmbeddedFile> embedded_front_end();

/// devices/, as they are.
[[nodiscard]] std::span<const EmbeddedFile> embedded_devices();

}  // namespace zwidth::server
