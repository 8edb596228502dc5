#pragma once

#include <map>
#include <string>
#include <string_view>

namespace zwidth::server {

/// A file of the front end as it is served.
struct Page {
  std::string_view content_type;
  std::string_view cache_control;
  std::string_view gzipped;
  std::string plain;  ///< for who does not take gzip
};

/// The embedded front end by path: "/", "/assets/index-B2x9.js".
[[nodiscard]] std::map<std::string, Page, std::less<>> embedded_pages();

/// Whether an Accept-Encoding header takes gzip.
[[nodiscard]] bool takes_gzip(std::string_view accept_encoding);

}  // namespace zwidth::server
