#include "io/recording_format.hpp"

#include <gtest/gtest.h>

#include <string>

namespace zwidth {
using namespace internal;
namespace {

using namespace std::string_literals;

TEST(RecordingFormat, IsToldByContent) {
  const std::string text_of_mat(124, ' ');
  const std::string users_block(512, ' ');
  EXPECT_EQ(format_of("MATLAB 5.0 MAT-file, Platform: PCWIN64"), RecordingFormat::mat);
  EXPECT_EQ(format_of("MATLAB 7.3 MAT-file"), RecordingFormat::mat);
  EXPECT_EQ(format_of(text_of_mat + "\x00\x01IM"s), RecordingFormat::mat);
  EXPECT_EQ(format_of(text_of_mat + "\x01\x00MI"s), RecordingFormat::mat);
  EXPECT_EQ(format_of("\x89HDF\r\n\x1A\n"), RecordingFormat::mat);
  EXPECT_EQ(format_of(users_block + "\x89HDF\r\n\x1A\n"s), RecordingFormat::mat);
  EXPECT_EQ(format_of("\0\0\0\0\x0A\0\0\0\x01\0\0\0\0\0\0\0\x02\0\0\0x\0........"s),
            RecordingFormat::mat);  // version 4
  EXPECT_EQ(format_of("    -1\n    58\nname\n"), RecordingFormat::uff);
  EXPECT_EQ(format_of("    -1\r\n    58b     1     2\r\n"), RecordingFormat::uff);
  EXPECT_EQ(format_of("\n  \n    -1          \n   151\n"), RecordingFormat::uff);
  EXPECT_EQ(format_of(""), RecordingFormat::text);
  EXPECT_EQ(format_of("-1\n58\n59\n"), RecordingFormat::text);
  EXPECT_EQ(format_of("    -1\n  0.58\n"), RecordingFormat::text);
  EXPECT_EQ(format_of("    -1"), RecordingFormat::text);
  EXPECT_EQ(format_of("t,F,x\n0,1,2\n"), RecordingFormat::text);
  EXPECT_EQ(format_of(std::string(1000, '\0')), RecordingFormat::text);  // refused as text: binary
}

}  // namespace
}  // namespace zwidth
