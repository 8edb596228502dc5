// Both ends of the line to a microcontroller: the program's frames, and firmware/zwidth_serial.h as it runs there.
#include "rig/microcontroller_frame.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <string_view>

#include "zwidth_serial.h"

namespace zwidth::rig {
namespace {

using Command = MicrocontrollerCommand;
using State = MicrocontrollerState;

std::string hex_of(std::string_view bytes) {
  std::string text;
  for (const char c : bytes) text += fmt::format("{:02x}", static_cast<unsigned char>(c));
  return text;
}

/// A sketch that has nothing but the header.
class Board {
 public:
  explicit Board(float force_limit = 4.0F, std::uint16_t watchdog = 100) {
    zwidth_serial_begin(&board, force_limit, watchdog);
  }
  /// What it answers to these bytes; empty: nothing.
  std::string told(std::string_view bytes, std::uint32_t now = 0) {
    std::string answers;
    for (const char byte : bytes) {
      if (zwidth_serial_receive(&board, static_cast<std::uint8_t>(byte), now) == 0) continue;
      std::array<std::uint8_t, ZWIDTH_SERIAL_MOST> out{};
      const std::uint8_t count = zwidth_serial_answer(&board, position, 2.0F, out.data());
      answers.append(out.begin(), out.begin() + count);
    }
    return answers;
  }
  std::string told(const SerialFrame& frame, std::uint32_t now = 0) { return told(frame.view(), now); }
  double force(std::uint32_t now = 0, float own = 0.0F) {
    return static_cast<double>(zwidth_serial_force(&board, own, now));
  }

  zwidth_serial_t board{};
  float position = -0.25F;
};

TEST(ZwidthSerial, AForceLimitThatIsNoneLetsNoForceThrough) {
  for (const float limit : {-2.0F, 0.0F, std::numeric_limits<float>::quiet_NaN()}) {
    Board board(limit);
    EXPECT_EQ(board.force(0, 1.0F), 0.0) << "alone";
    (void)board.told(microcontroller_frame(Command::hold, 6));
    (void)board.told(microcontroller_force(0.5, 7));
    EXPECT_EQ(board.force(), 0.0);
  }
}

// By hand from the tables of docs/rig_serial.md, the CRCs bit by bit in Python.
TEST(MicrocontrollerFrame, IsTheDocumentedOne) {
  EXPECT_EQ(hex_of(microcontroller_frame(Command::question, 7).view()), "037107033fae00");
  EXPECT_EQ(hex_of(microcontroller_force(0.5, 8).view()), "036608010101043feb6700");
  Board board;
  EXPECT_EQ(hex_of(board.told(microcontroller_frame(Command::hold, 6))), "0361060201010380be01010240010101037eca00");
  EXPECT_EQ(board.told(microcontroller_force(0.5, 8)), "") << "a force has no answer";
  EXPECT_EQ(board.force(), 0.5);
  EXPECT_EQ(hex_of(board.told(microcontroller_frame(Command::question, 7))),
            "0361070201010380be010102400101043f204b00");
  EXPECT_EQ(hex_of(board.told(microcontroller_frame(Command::description, 9))),
            "03440904010164010101010101058040aeb200");
}

TEST(MicrocontrollerFrame, HasTheBytesThatTheLineIsJudgedBy) {
  Board board;
  EXPECT_EQ(microcontroller_frame(Command::question, 0).view().size(), microcontroller_question_bytes);
  EXPECT_EQ(microcontroller_force(0.0, 0).view().size(), microcontroller_force_bytes);
  EXPECT_EQ(board.told(microcontroller_frame(Command::question, 0)).size(), microcontroller_answer_bytes);
  EXPECT_EQ(microcontroller_answer_bytes, std::size_t{ZWIDTH_SERIAL_MOST});
}

// Every number comes out at the other end, and no byte but the last is 0.
TEST(MicrocontrollerFrame, BothEndsReadEachOther) {
  std::mt19937_64 engine(47);
  std::uniform_int_distribution<std::uint32_t> bits;
  for (int i = 0; i < 2000; ++i) {
    const auto sequence = static_cast<std::uint16_t>(i % 3 == 0 ? bits(engine) & 0xff00U : bits(engine));
    Board board(std::numeric_limits<float>::max());
    (void)board.told(microcontroller_frame(Command::hold, static_cast<std::uint16_t>(sequence - 1)));
    const float force = std::bit_cast<float>(bits(engine) & (i % 5 == 0 ? 0xff0000ffU : 0xffffffffU));
    board.position = std::bit_cast<float>(bits(engine));
    const auto sent = microcontroller_force(static_cast<double>(force), sequence);
    EXPECT_EQ(sent.view().find('\0'), sent.view().size() - 1);
    (void)board.told(sent);
    EXPECT_EQ(board.force(), std::isfinite(force) ? static_cast<double>(force) : 0.0);
    const std::string frame = board.told(microcontroller_frame(Command::question, sequence));
    EXPECT_EQ(frame.find('\0'), frame.size() - 1);
    const auto answer = microcontroller_answer(frame);
    ASSERT_TRUE(answer) << "seed 47, number " << i;
    EXPECT_EQ(answer->sequence, sequence);
    EXPECT_EQ(answer->state, State::holding);
    const auto position = static_cast<double>(board.position);
    EXPECT_TRUE(answer->position == position || (std::isnan(position) && std::isnan(answer->position)));
    EXPECT_EQ(answer->velocity, 2.0);
    EXPECT_EQ(answer->force, board.force());
    EXPECT_FALSE(microcontroller_description(frame));
  }
}

TEST(MicrocontrollerFrame, NeitherEndTakesAFlippedBitOrHalfAFrame) {
  Board sender;
  for (unsigned sequence = 0; sequence < 600; sequence += 7) {
    sender.position = 1e-3F * static_cast<float>(sequence);
    const auto number = static_cast<std::uint16_t>(sequence);
    const std::string answer = sender.told(microcontroller_frame(Command::question, number));
    const std::string described = sender.told(microcontroller_frame(Command::description, number));
    const std::string force(microcontroller_force(1.0 + sequence, number).view());
    for (std::size_t bit = 0; bit < 8 * answer.size(); ++bit) {
      const auto flipped = [bit](std::string bytes) {
        bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ (1 << (bit % 8)));
        return bytes;
      };
      EXPECT_FALSE(microcontroller_answer(flipped(answer))) << sequence << " bit " << bit;
      if (bit < 8 * described.size()) {
        EXPECT_FALSE(microcontroller_description(flipped(described)));
      }
      if (bit >= 8 * force.size()) continue;
      Board board(1e6F);
      (void)board.told(microcontroller_frame(Command::hold, static_cast<std::uint16_t>(number - 1)));
      EXPECT_EQ(board.told(flipped(force)), "");
      EXPECT_EQ(board.force(), 0.0) << sequence << " bit " << bit;
    }
    for (std::size_t size = 0; size < answer.size(); ++size) {
      EXPECT_FALSE(microcontroller_answer(answer.substr(0, size)));
    }
  }
}

// A frame that was cut off or broken costs itself alone.
TEST(MicrocontrollerFrame, TheNextFrameIsWholeAgain) {
  Board board;
  const std::string question(microcontroller_frame(Command::question, 500).view());
  for (std::size_t size = 0; size + 1 < question.size(); ++size) {
    EXPECT_EQ(board.told(question.substr(0, size) + std::string(1, '\0') + question).size(),
              microcontroller_answer_bytes);
    EXPECT_EQ(board.told(std::string(size, '\0') + question).size(), microcontroller_answer_bytes);
  }
  EXPECT_EQ(board.told(std::string(1000, 'x') + std::string(1, '\0') + question).size(), microcontroller_answer_bytes);
}

TEST(ZwidthSerial, LetsGoByItselfAndSaysSo) {
  Board board;
  const auto state = [&](std::uint32_t now) {
    return microcontroller_description(board.told(microcontroller_frame(Command::description, 1), now)).value();
  };
  EXPECT_EQ(state(0).state, State::alone);
  (void)board.told(microcontroller_force(1.0, 2), 10);
  EXPECT_EQ(board.force(10), 0.0) << "nobody took hold";
  (void)board.told(microcontroller_frame(Command::hold, 2), 10);
  EXPECT_EQ(state(10).state, State::holding);
  (void)board.told(microcontroller_force(1.0, 3), 50);
  (void)board.told(microcontroller_frame(Command::question, 4), 149);  // does not feed it
  EXPECT_EQ(board.force(150), 1.0);
  EXPECT_EQ(board.force(151), 0.0) << "100 ms after the last force";
  EXPECT_EQ(state(160).state, State::let_go);
  EXPECT_EQ(state(160).times_let_go, 1U);
  EXPECT_DOUBLE_EQ(state(160).silence, 0.101);
  EXPECT_DOUBLE_EQ(state(160).watchdog, 0.1);
  (void)board.told(microcontroller_force(1.0, 5), 170);
  EXPECT_EQ(board.force(170), 0.0) << "until it is held anew";
  (void)board.told(microcontroller_frame(Command::hold, 6), 180);
  EXPECT_EQ(board.force(180), 0.0);
  (void)board.told(microcontroller_force(-1.0, 7), 181);
  EXPECT_EQ(board.force(181), -1.0);
}

// A loop that hung finds a force among the bytes that waited: it is one that came too late.
TEST(ZwidthSerial, LetsGoBeforeAForceThatCameTooLate) {
  Board board;
  (void)board.told(microcontroller_frame(Command::hold, 1), 0);
  (void)board.told(microcontroller_force(1.0, 2), 0);
  (void)board.told(microcontroller_force(2.0, 3), 300);
  EXPECT_EQ(board.force(300), 0.0);
}

TEST(ZwidthSerial, ItsClockMayBeginAnew) {
  Board board;
  (void)board.told(microcontroller_frame(Command::hold, 1), 0xffffffe0U);
  (void)board.told(microcontroller_force(1.0, 2), 0xfffffff0U);
  EXPECT_EQ(board.force(0x10), 1.0) << "32 ms later";
  EXPECT_EQ(board.force(0x60), 0.0);
}

TEST(ZwidthSerial, TakesNoForceTwiceAndNoOlderOne) {
  Board board;
  (void)board.told(microcontroller_frame(Command::hold, 0xfffe));
  (void)board.told(microcontroller_force(1.0, 0xffff));
  (void)board.told(microcontroller_force(2.0, 1));  // 0 was lost
  EXPECT_EQ(board.force(), 2.0);
  (void)board.told(microcontroller_force(3.0, 0));
  (void)board.told(microcontroller_force(3.0, 1));
  EXPECT_EQ(board.force(), 2.0);
}

TEST(ZwidthSerial, ForceBeyondItsLimitIsCutAndWhatIsNoNumberIsNone) {
  Board board(4.0F);
  (void)board.told(microcontroller_frame(Command::hold, 0));
  (void)board.told(microcontroller_force(-1e3, 1));
  EXPECT_EQ(board.force(), -4.0);
  for (const double force : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    (void)board.told(microcontroller_force(force, 2));
    EXPECT_EQ(board.force(), -4.0) << "as if it had not come: " << force;
  }
  (void)board.told(microcontroller_force(1e300, 3));
  EXPECT_EQ(board.force(), 4.0);
}

// A wall of its own runs until a host takes hold, and not after: what a host stopped stays stopped.
TEST(ZwidthSerial, ItsOwnWallRunsUntilAHostTakesHold) {
  Board board;
  EXPECT_EQ(board.force(0, 3.0F), 3.0);
  EXPECT_EQ(board.force(0, 30.0F), 4.0);
  EXPECT_EQ(board.force(0, std::numeric_limits<float>::quiet_NaN()), 0.0);
  (void)board.told(microcontroller_frame(Command::hold, 0));
  EXPECT_EQ(board.force(0, 3.0F), 0.0);
  (void)board.told(microcontroller_force(1.0, 1));
  EXPECT_EQ(board.force(0, 3.0F), 1.0);
  (void)board.told(microcontroller_frame(Command::release, 2));
  EXPECT_EQ(board.force(0, 3.0F), 0.0);
  (void)board.told(microcontroller_force(1.0, 3));
  EXPECT_EQ(board.force(0, 3.0F), 0.0);
}

TEST(ZwidthSerial, AFaultOfTheSketchIsZeroForceUntilItIsOver) {
  Board board;
  (void)board.told(microcontroller_frame(Command::hold, 0));
  (void)board.told(microcontroller_force(1.0, 1));
  zwidth_serial_fail(&board.board, 17);
  EXPECT_EQ(board.force(), 0.0);
  const auto answer = microcontroller_answer(board.told(microcontroller_frame(Command::hold, 2)));
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->state, 17U);
  zwidth_serial_fail(&board.board, 0);
  (void)board.told(microcontroller_force(1.0, 3));
  EXPECT_EQ(board.force(), 0.0) << "the host takes hold anew";
  (void)board.told(microcontroller_frame(Command::hold, 4));
  (void)board.told(microcontroller_force(1.0, 5));
  EXPECT_EQ(board.force(), 1.0);
}

// A sketch may say in each turn of its loop that nothing is wrong.
TEST(ZwidthSerial, NoFaultThatIsOverChangesNothing) {
  Board board;
  zwidth_serial_fail(&board.board, 0);
  EXPECT_EQ(board.force(0, 3.0F), 3.0) << "alone";
  (void)board.told(microcontroller_frame(Command::hold, 0));
  (void)board.told(microcontroller_force(1.0, 1));
  zwidth_serial_fail(&board.board, 0);
  EXPECT_EQ(board.force(), 1.0) << "holding";
  EXPECT_EQ(board.force(10'000), 0.0) << "let go";
  zwidth_serial_fail(&board.board, 0);
  EXPECT_EQ(board.board.state, ZWIDTH_SERIAL_LET_GO);
}

}  // namespace
}  // namespace zwidth::rig
