// A paddle around an ATmega328P that simavr runs instruction by instruction, its serial line on a pseudo-terminal: what
// `zwidth rig --driver serial:PORT` finds where firmware/examples/hapkit_paddle is loaded into a board. The motor is what
// the pins of PWM and direction say, the sensor what the ADC is given; the paddle's mass moves exactly in between.
//
//   avr_board hapkit_paddle.elf step 1e-3      a cycle takes this long on the board, however long it takes here
//   avr_board hapkit_paddle.elf clock          the board keeps the clock, as far as this machine does
//
// Prints the port; `delay SECONDS jitter SECONDS`, from a position's reading to its force, after 400 forces; and each time
// that the motor falls to zero without being told `zero SECONDS`, since the last force's last byte.
#include <avr_adc.h>
#include <avr_uart.h>
#include <fcntl.h>
#include <poll.h>
#include <sim_avr.h>
#include <sim_elf.h>
#include <stdlib.h>
#include <termios.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <deque>
#include <optional>
#include <string>
#include <string_view>

namespace {

constexpr double clock_rate = 16e6;
constexpr avr_cycle_count_t cycles_of_byte = 160;  // 10 bits at 1 MBd
constexpr int supply = 5000;                       // mV
constexpr avr_cycle_count_t booted = 1'600'000;    // 0.1 s
constexpr avr_cycle_count_t longest_answer = 160'000;
constexpr double of_a_force = 1e-3;  // s, in which it has reached the motor
constexpr int forces_to_tell = 400;

// hapkit_paddle.ino and hapkit_paddle.toml
constexpr double metres_per_count = 1.3e-5;
constexpr double counts_per_flip = 980.0;
constexpr double torque_of_full_duty = 0.03;
constexpr double torque_per_force = 0.0047;
constexpr double mass = 0.05;
constexpr double damping = 2.0;
constexpr double middle = 10'000.0;  // counts

// ATmega328P, in data space
constexpr std::uint16_t port_b = 0x25;  // direction: bit 0
constexpr std::uint16_t tccr0a = 0x44;  // PWM at pin 5: bit 5
constexpr std::uint16_t ocr0b = 0x48;   // its duty
constexpr std::uint16_t port_d = 0x2b;  // pin 5 without PWM: bit 5

double now_here() {
  timespec time{};
  clock_gettime(CLOCK_MONOTONIC, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// A mass in air, under a force that is constant from one change to the next.
class Paddle {
 public:
  double position(double time) {
    move(time);
    return position_;
  }
  void set_force(double force, double time) {
    move(time);
    force_ = force;
  }

 private:
  void move(double time) {
    const double step = time - time_;
    const double end = force_ / damping;
    const double left = std::exp(-damping * step / mass);
    position_ += end * step + (velocity_ - end) * (1.0 - left) * mass / damping;
    velocity_ = end + (velocity_ - end) * left;
    time_ = time;
  }
  double time_ = 0.0;
  double position_ = 0.0;
  double velocity_ = 0.0;
  double force_ = 0.0;
};

class Board {
 public:
  explicit Board(const char* program) {
    avr_global_logger_set([](avr_t*, const int, const char*, va_list) {});  // it would speak on standard output
    elf_firmware_t firmware{};
    if (elf_read_firmware(program, &firmware) != 0) throw std::string("no such program");
    avr_ = avr_make_mcu_by_name("atmega328p");
    if (avr_ == nullptr) throw std::string("simavr knows no atmega328p");
    avr_init(avr_);
    avr_load_firmware(avr_, &firmware);
    avr_->frequency = static_cast<std::uint32_t>(clock_rate);
    avr_->vcc = avr_->avcc = supply;
    std::uint32_t flags = 0;
    avr_ioctl(avr_, AVR_IOCTL_UART_SET_FLAGS('0'), &flags);
    input_ = avr_io_getirq(avr_, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_INPUT);
    sensor_ = avr_io_getirq(avr_, AVR_IOCTL_ADC_GETIRQ, ADC_IRQ_ADC2);
    avr_irq_register_notify(
        avr_io_getirq(avr_, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_OUTPUT),
        [](avr_irq_t*, std::uint32_t byte, void* self) { static_cast<Board*>(self)->say(byte); }, this);
    avr_irq_register_notify(
        avr_io_getirq(avr_, AVR_IOCTL_ADC_GETIRQ, ADC_IRQ_OUT_TRIGGER),
        [](avr_irq_t*, std::uint32_t, void* self) { static_cast<Board*>(self)->read_sensor(); }, this);
    run_until(booted);
  }

  [[nodiscard]] avr_cycle_count_t cycle() const { return avr_->cycle; }
  void hear(std::string_view bytes) {
    for (const char byte : bytes) {
      next_byte_ = std::max(next_byte_, avr_->cycle) + cycles_of_byte;
      heard_.push_back({next_byte_, static_cast<std::uint8_t>(byte)});
    }
    is_force_ = bytes.size() > 1 && bytes[1] == 'f';
  }
  [[nodiscard]] bool has_heard_all() const { return heard_.empty(); }
  /// What has come out of the line until now.
  std::string said() {
    std::string bytes;
    while (!said_.empty() && said_.front().at <= avr_->cycle) {
      bytes += static_cast<char>(said_.front().value);
      said_.pop_front();
    }
    return bytes;
  }
  void run_until(avr_cycle_count_t end) {
    while (avr_->cycle < end) step();
  }
  void step() {
    if (!heard_.empty() && heard_.front().at <= avr_->cycle) {
      avr_raise_irq(input_, heard_.front().value);
      heard_.pop_front();
      if (heard_.empty() && is_force_) force_came_ = avr_->cycle;
    }
    const int state = avr_run(avr_);
    if (state == cpu_Done || state == cpu_Crashed) throw std::string("the program has crashed");
    look_at_motor();
  }

 private:
  struct Byte {
    avr_cycle_count_t at;
    std::uint8_t value;
  };
  [[nodiscard]] double time() const { return static_cast<double>(avr_->cycle) / clock_rate; }

  void say(std::uint32_t byte) {
    last_said_ = std::max(last_said_, avr_->cycle) + cycles_of_byte;
    said_.push_back({last_said_, static_cast<std::uint8_t>(byte)});
    read_for_answer_ = last_read_;
  }
  void read_sensor() {
    const double counts = std::floor(middle + paddle_.position(time()) / metres_per_count);
    const auto reading = static_cast<int>(counts - counts_per_flip * std::floor(counts / counts_per_flip));
    avr_raise_irq(sensor_, static_cast<std::uint32_t>((reading * supply + 1022) / 1023));  // mV, rounded up
    last_read_ = avr_->cycle;
  }
  void look_at_motor() {
    const std::uint8_t* data = avr_->data;
    const bool has_pwm = (data[tccr0a] & 0x20U) != 0;
    const unsigned duty = has_pwm ? data[ocr0b] : (data[port_d] & 0x20U) != 0 ? 255U : 0U;
    const int drive = (data[port_b] & 1U) != 0 ? static_cast<int>(duty) : -static_cast<int>(duty);
    if (drive == drive_) return;
    drive_ = drive;
    const double share = drive / 255.0;
    paddle_.set_force(share * std::abs(share) * torque_of_full_duty / torque_per_force, time());
    if (duty == duty_) return;  // the direction is told first
    duty_ = duty;
    const double since = static_cast<double>(avr_->cycle - force_came_) / clock_rate;
    if (since < of_a_force) {
      tell_delay();
    } else if (duty == 0) {
      std::printf("zero %.6f\n", since);
      std::fflush(stdout);
    }
  }
  void tell_delay() {
    const double delay = static_cast<double>(avr_->cycle - read_for_answer_) / clock_rate;
    ++forces_;
    sum_ += delay;
    squares_ += delay * delay;
    if (forces_ != forces_to_tell) return;
    const double mean = sum_ / forces_;
    std::printf("delay %.9f jitter %.9f\n", mean, std::sqrt(std::max(0.0, squares_ / forces_ - mean * mean)));
    std::fflush(stdout);
  }

  avr_t* avr_ = nullptr;
  avr_irq_t* input_ = nullptr;
  avr_irq_t* sensor_ = nullptr;
  Paddle paddle_;
  std::deque<Byte> heard_;
  std::deque<Byte> said_;
  avr_cycle_count_t next_byte_ = 0;
  avr_cycle_count_t last_said_ = 0;
  avr_cycle_count_t last_read_ = 0;
  avr_cycle_count_t read_for_answer_ = 0;
  avr_cycle_count_t force_came_ = 0;
  bool is_force_ = false;
  int drive_ = 0;
  unsigned duty_ = 0;
  int forces_ = 0;
  double sum_ = 0.0;
  double squares_ = 0.0;
};

struct Terminal {
  Terminal() : master(posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC)) {
    std::array<char, 128> name{};
    if (master < 0 || grantpt(master) != 0 || unlockpt(master) != 0 ||
        ptsname_r(master, name.data(), name.size()) != 0) {
      throw std::string("no pseudo-terminal");
    }
    slave = open(name.data(), O_RDWR | O_NOCTTY | O_CLOEXEC);  // else the master hangs up between two hosts
    termios settings{};
    tcgetattr(slave, &settings);
    cfmakeraw(&settings);
    tcsetattr(slave, TCSANOW, &settings);
    std::printf("%s\n", name.data());
    std::fflush(stdout);
  }
  /// What a host wrote, waiting so many ms.
  [[nodiscard]] std::string read_for(int patience) const {
    pollfd waiting{master, POLLIN, 0};
    std::array<char, 256> bytes{};
    if (poll(&waiting, 1, patience) <= 0) return {};
    const ssize_t count = ::read(master, bytes.data(), bytes.size());
    return {bytes.data(), static_cast<std::size_t>(std::max<ssize_t>(0, count))};
  }
  void write(const std::string& bytes) const {
    if (!bytes.empty()) (void)!::write(master, bytes.data(), bytes.size());
  }

  int master;
  int slave = -1;
};

/// The first whole frame of what has come, taken out of it; empty: there is none.
std::string next_frame(std::string& bytes) {
  const std::size_t end = bytes.find('\0');
  if (end == std::string::npos) return {};
  std::string frame = bytes.substr(0, end + 1);
  bytes.erase(0, end + 1);
  return frame;
}

/// Time moves with the host's frames: a question falls on a whole number of periods, everything else follows at once.
void run_in_steps(Board& board, const Terminal& terminal, double period) {
  const auto cycles = static_cast<avr_cycle_count_t>(std::llround(clock_rate * period));
  std::string rest;
  for (;;) {
    rest += terminal.read_for(-1);
    for (std::string frame = next_frame(rest); !frame.empty(); frame = next_frame(rest)) {
      const bool is_question = frame.size() > 1 && frame[1] == 'q';
      const bool is_force = frame.size() > 1 && frame[1] == 'f';
      if (is_question) board.run_until((board.cycle() / cycles + 1) * cycles);
      board.hear(frame);
      while (!board.has_heard_all()) board.step();
      if (is_force) continue;
      const avr_cycle_count_t until = board.cycle() + longest_answer;
      std::string answer;  // all of it, before the host goes on
      while (board.cycle() < until && (answer.empty() || answer.back() != '\0')) {
        board.step();
        answer += board.said();
      }
      terminal.write(answer);
    }
  }
}

void run_on_clock(Board& board, const Terminal& terminal) {
  constexpr auto slice = static_cast<avr_cycle_count_t>(clock_rate * 50e-6);
  const double begin = now_here() - static_cast<double>(board.cycle()) / clock_rate;
  std::string rest;
  for (;;) {
    const double ahead = static_cast<double>(board.cycle()) / clock_rate - (now_here() - begin);
    rest += terminal.read_for(ahead > 1e-3 ? 1 : 0);
    for (std::string frame = next_frame(rest); !frame.empty(); frame = next_frame(rest)) board.hear(frame);
    if (ahead > 0.0) continue;
    board.run_until(board.cycle() + slice);
    terminal.write(board.said());
  }
}

}  // namespace

int main(int count, char** arguments) {
  const std::string_view mode = count > 2 ? arguments[2] : "";
  if (!(mode == "clock" && count == 3) && !(mode == "step" && count == 4)) {
    std::fputs("usage: avr_board PROGRAM.elf step PERIOD | clock\n", stderr);
    return 2;
  }
  try {
    Board board(arguments[1]);
    const Terminal terminal;
    if (mode == "clock") run_on_clock(board, terminal);
    run_in_steps(board, terminal, std::atof(arguments[3]));
  } catch (const std::string& problem) {
    std::fprintf(stderr, "avr_board: %s\n", problem.c_str());
  }
  return 1;
}
