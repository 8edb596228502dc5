#include "server/http/page.hpp"

#include <zlib.h>

#include <array>
#include <stdexcept>
#include <utility>

#include "server/http/embedded_files.hpp"

namespace zwidth::server {
namespace {

constexpr std::array<std::pair<std::string_view, std::string_view>, 10> content_types{
    {{".html", "text/html; charset=utf-8"},
     {".js", "text/javascript; charset=utf-8"},
     {".css", "text/css; charset=utf-8"},
     {".json", "application/json"},
     {".svg", "image/svg+xml"},
     {".png", "image/png"},
     {".ico", "image/x-icon"},
     {".woff2", "font/woff2"},
     {".txt", "text/plain; charset=utf-8"},
     {".webmanifest", "application/manifest+json"}}};

std::string_view content_type(std::string_view name) {
  for (const auto& [ending, type] : content_types) {
    if (name.ends_with(ending)) return type;
  }
  return "application/octet-stream";
}

std::string gunzipped(std::string_view bytes) {
  constexpr int gzip_alone = 16 + MAX_WBITS;
  z_stream stream{};
  if (::inflateInit2(&stream, gzip_alone) != Z_OK) throw std::runtime_error("zlib does not start");
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  std::string plain;
  std::array<char, 1 << 16> piece{};
  int state = Z_OK;
  while (state == Z_OK) {
    stream.next_out = reinterpret_cast<Bytef*>(piece.data());
    stream.avail_out = piece.size();
    state = ::inflate(&stream, Z_NO_FLUSH);
    plain.append(piece.data(), piece.size() - stream.avail_out);
  }
  ::inflateEnd(&stream);
  if (state != Z_STREAM_END) throw std::runtime_error("an embedded file is damaged");
  return plain;
}

}  // namespace

std::map<std::string, Page, std::less<>> embedded_pages() {
  std::map<std::string, Page, std::less<>> pages;
  for (const EmbeddedFile& file : embedded_front_end()) {
    const bool is_index = file.name == "index.html";
    // Vite names an asset by its contents: another build, another name.
    const bool is_asset = file.name.starts_with("assets/");
    pages.emplace("/" + std::string(is_index ? "" : file.name),
                  Page{content_type(file.name), is_asset ? "public, max-age=31536000, immutable" : "no-cache",
                       file.bytes, gunzipped(file.bytes)});
  }
  return pages;
}

bool takes_gzip(std::string_view accept_encoding) {
  const std::size_t at = accept_encoding.find("gzip");
  if (at == std::string_view::npos) return false;
  std::string_view weight = accept_encoding.substr(at, accept_encoding.find(',', at) - at);
  return weight.find("q=0") == std::string_view::npos ||
         weight.find_first_of("123456789", weight.find("q=0")) != std::string_view::npos;
}

}  // namespace zwidth::server
