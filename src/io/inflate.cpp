#include "io/inflate.hpp"

#include <zlib.h>

#include <algorithm>

#include "zwidth/error.hpp"

namespace zwidth::internal {
namespace {

constexpr std::size_t least_room = std::size_t{1} << 16;
constexpr std::size_t most_at_once = std::size_t{1} << 30;  // zlib counts in 32 bits

class Stream {
 public:
  Stream() {
    if (inflateInit(&z_) != Z_OK) throw Error(ErrorCode::did_not_converge, {.code = ProblemCode::zlib_cannot_start});
  }
  ~Stream() { inflateEnd(&z_); }
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;

  z_stream& operator*() { return z_; }

 private:
  z_stream z_{};
};

}  // namespace

tl::expected<std::vector<unsigned char>, InflateFailure> inflate_all(std::span<const unsigned char> input,
                                                                     std::size_t limit) {
  Stream stream;
  z_stream& z = *stream;
  std::vector<unsigned char> output;
  std::size_t size = 0;
  int state = Z_OK;
  while (state != Z_STREAM_END) {
    if (z.avail_in == 0) {
      const std::size_t taken = std::min(input.size(), most_at_once);
      z.next_in = const_cast<unsigned char*>(input.data());  // zlib's interface, though it only reads
      z.avail_in = static_cast<uInt>(taken);
      input = input.subspan(taken);
    }
    if (size == output.size()) {
      if (size >= limit) return tl::unexpected(InflateFailure::too_large);
      output.resize(std::min(limit, std::max(least_room, 2 * size)));
    }
    const std::size_t room = std::min(output.size() - size, most_at_once);
    z.next_out = output.data() + size;
    z.avail_out = static_cast<uInt>(room);
    state = ::inflate(&z, Z_NO_FLUSH);
    size += room - z.avail_out;
    if (state != Z_OK && state != Z_STREAM_END) return tl::unexpected(InflateFailure::damaged);
  }
  output.resize(size);
  return output;
}

}  // namespace zwidth::internal
