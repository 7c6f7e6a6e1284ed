// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/manual/manual_command.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <csignal>
#include <cstdio>
#include <memory>

#include "adapters/asio/asio_runtime.hpp"
#include "adapters/asio/key_input.hpp"
#include "adapters/asio/key_mode.hpp"
#include "gateway/commands/client/manual_client.hpp"
#include "gateway/commands/common/end_signals.hpp"
#include "gateway/commands/common/exit_codes.hpp"
#include "gateway/commands/manual/manual_screen.hpp"
#include "gateway/image/register_map.hpp"
#include "gateway/upstream/modbus_tcp/session/device_identification.hpp"

namespace axisgate::commands {
namespace {

constexpr Duration kLookPeriod = std::chrono::milliseconds(100);
constexpr Duration kTurnPeriod = std::chrono::milliseconds(50);
constexpr std::size_t kRoleAt = 7;

/// One command, from its connection to its end.
class ManualMotion {
 public:
  ManualMotion(const ManualArguments& arguments, HostPort place, boost::asio::io_context& io);
  /// To its end: the plan as it is then.
  [[nodiscard]] ManualPlan run();

 private:
  void connected();
  void greet(Bytes reply);
  void look();
  void seen(Bytes registers_reply, Bytes inputs_reply, std::uint32_t answered);
  void pump();
  void turn();
  void take_keys(Bytes typed);
  void end(std::string_view why);
  void await_signal();
  void show();
  [[nodiscard]] Instant now() const { return runtime_.now(); }

  boost::asio::io_context& io_;
  AsioRuntime runtime_;
  ManualArguments arguments_;
  HostPort place_;
  ManualPlan plan_;
  ManualListener listener_;
  ManualKeys keys_;
  ManualScreen screen_;
  std::unique_ptr<KeyMode> key_mode_;
  std::vector<Byte> registers_reply_;
  bool greeted_ = false;
  bool looking_ = false;
  bool asked_to_end_ = false;
  Instant next_look_ = kLongAgo;
  Instant last_turn_;
  boost::asio::signal_set signals_;
  std::unique_ptr<KeyInput> input_;
  std::unique_ptr<Timer> turn_timer_;
  std::unique_ptr<Timer> plan_timer_;
  ManualClient client_;  // last, so that it goes first: it calls back
};

ManualMotion::ManualMotion(const ManualArguments& arguments, HostPort place, boost::asio::io_context& io)
    : io_(io),
      runtime_(io),
      arguments_(arguments),
      place_(std::move(place)),
      plan_(arguments, runtime_.now()),
      screen_([this] { end("nobody reads what is shown"); }),
      last_turn_(runtime_.now()),
      signals_(io, SIGINT, SIGTERM, SIGQUIT),
      turn_timer_(runtime_.make_timer([this] { turn(); })),
      plan_timer_(runtime_.make_timer([this] {
        plan_.on_time(now());
        pump();
      })),
      client_(io, [this](const std::string& why) {
        plan_.lost(why);
        pump();
      }) {
  if (!hangups_are_ignored()) signals_.add(SIGHUP);
  // They would end this program, and the motor would turn on.
  for (const int signal : {SIGUSR1, SIGUSR2, SIGALRM, SIGVTALRM, SIGPROF, SIGXCPU}) signals_.add(signal);
}

ManualPlan ManualMotion::run() {
  await_signal();
  const bool terminal = ::isatty(STDIN_FILENO) == 1;
  const bool jogs = arguments_.task == ManualTask::jog;
  if (jogs) key_mode_ = std::make_unique<KeyMode>(STDIN_FILENO);
  if (terminal)
    input_ = std::make_unique<KeyInput>(
        io_, STDIN_FILENO, jogs ? KeyInput::Wants::bytes : KeyInput::Wants::end_alone,
        [this](Bytes typed) { take_keys(typed); }, [this] { end("the terminal is gone"); });
  turn_timer_->expires_at(now() + kTurnPeriod);
  client_.connect(place_, [this] { connected(); });
  io_.run();
  screen_.clear();
  return plan_;
}

void ManualMotion::connected() {
  client_.ask(read_registers_request(0, kGatewayRegisters), [this](Bytes reply) { greet(reply); });
  client_.ask(identification_request(modbus_tcp::kNumbersObject), [this](Bytes reply) {
    listener_.float_numbers = identification_in(reply) == "float";
    greeted_ = true;
    look();
  });
}

void ManualMotion::greet(Bytes reply) {
  const auto fail = [this](std::string_view why) {
    plan_.fail(why, now());
    pump();
  };
  const auto registers = registers_in(reply, kGatewayRegisters);
  if (!registers) return fail("register 0 is answered with an exception: no axisgate there");
  std::array<std::uint16_t, kGatewayRegisters> gateway{};
  std::copy(registers->begin(), registers->end(), gateway.begin());
  listener_.order = word_order(gateway);
  if (listener_.order == WordOrder::unknown)
    return fail("registers 10 and 11 do not hold the test value: no axisgate there");
  if (gateway[kRoleAt] < static_cast<std::uint16_t>(Role::operator_))
    return fail("this computer is a viewer here: the gateway's key \"allow\" must give it the role operator");
  pump();  // a stop waits for no more than this: it is an axisgate, and it may stop
}

void ManualMotion::look() {
  if (looking_ || !greeted_ || plan_.over()) return;
  looking_ = true;
  next_look_ = now() + kLookPeriod;
  const std::uint32_t answered = plan_.answered();
  const std::uint16_t first = address_of(Block::axis, arguments_.axis);
  client_.ask(read_registers_request(first, kManualRegisters),
              [this](Bytes reply) { registers_reply_.assign(reply.begin(), reply.end()); });
  client_.ask(read_inputs_request(first, kAxisInputCount), [this, answered](Bytes reply) {
    looking_ = false;
    seen(registers_reply_, reply, answered);
  });
}

void ManualMotion::seen(Bytes registers_reply, Bytes inputs_reply, std::uint32_t answered) {
  const auto registers = registers_in(registers_reply, kManualRegisters);
  const auto inputs = inputs_in(inputs_reply, kAxisInputCount);
  const ModbusException exception = exception_in(registers_reply);
  if (registers && inputs) {
    plan_.on_view(manual_view(*registers, *inputs, listener_), answered, now());
  } else if (exception == ModbusException::gateway_target_failed) {
    plan_.on_view({}, answered, now());  // a listener with "offline_reads": "exception"
  } else {
    plan_.fail(exception == ModbusException::illegal_data_address
                   ? fmt::format("this gateway has no axis {}", arguments_.axis)
                   : fmt::format("axis {} cannot be read: {}", arguments_.axis, exception_text(exception)),
               now());
  }
  show();
  pump();
}

/// What the plan has to say goes out, and its next moment is waited for.
void ManualMotion::pump() {
  for (const std::string& note : plan_.take_notes()) screen_.say(note);
  for (const ManualWrite& write : plan_.take()) {
    const Rational units = plan_.view() ? plan_.view()->units_per_rev : Rational(1);
    const auto request = manual_request(write, arguments_.axis, listener_, units);
    if (!request) {
      plan_.refuse_number(now());
      return pump();
    }
    client_.ask(*request, [this](Bytes reply) {
      const std::uint32_t before = plan_.answered();
      plan_.on_answer(exception_in(reply), now());
      pump();
      if (plan_.answered() != before) look();  // a heartbeat's answer is none that anything waits for
    });
  }
  plan_timer_->expires_at(plan_.due());
  if (!plan_.over()) return;
  client_.close();
  io_.stop();
}

/// Again and again, so that a process which was stopped, or had no processor, notices.
void ManualMotion::turn() {
  if (now() - last_turn_ > ManualPlan::kKeyLapse) {
    if (key_mode_) key_mode_->forget_keys();
    plan_.on_stall(now());
  }
  last_turn_ = now();
  turn_timer_->expires_at(last_turn_ + kTurnPeriod);
  if (now() >= next_look_) look();
  pump();
}

void ManualMotion::take_keys(Bytes typed) {
  if (now() - last_turn_ > ManualPlan::kKeyLapse) return turn();  // old keys
  plan_.on_keys(keys_.take(typed), now());
  show();
  pump();
}

void ManualMotion::end(std::string_view why) {
  plan_.end(why, now());
  pump();
}

void ManualMotion::await_signal() {
  signals_.async_wait([this](const boost::system::error_code& error, int signal) {
    if (error) return;
    await_signal();
    if (signal != SIGHUP && std::exchange(asked_to_end_, true)) {
      plan_.end_at_once();
      return pump();
    }
    end(signal == SIGINT ? "Ctrl-C" : signal == SIGHUP ? "the terminal is gone" : fmt::format("signal {}", signal));
  });
}

void ManualMotion::show() {
  if (plan_.over() || !plan_.view()) return;
  const std::string doing = plan_.doing();
  screen_.show(manual_line(arguments_.axis, *plan_.view(), doing), doing, now());
}

/// Whole numbers of 9 digits and 9 places behind the point: every product with a unit is exact.
std::optional<Rational> typed_decimal(const std::string& typed) {
  const std::size_t point = typed.find('.');
  constexpr std::size_t kMost = 10;  // digits and a sign
  if (typed.substr(0, point).size() > kMost || (point != std::string::npos && typed.size() - point > kMost))
    return std::nullopt;
  return Rational::parse(typed);
}

int tell_end(const ManualOptions& options, const ManualPlan& plan) {
  const std::string_view name = text(options.arguments.task);
  if (plan.exit_code() == 0)
    fmt::print("{}\n", plan.words());
  else
    fmt::print(stderr, "axisgate {}: {}\n", name, plan.words());
  return plan.exit_code();
}

}  // namespace

std::string turns_mistake(const std::string& typed) {
  if (typed_decimal(typed)) return {};
  return fmt::format("'{}' is no number of turns: write 12.5 or -3, up to 9 digits on each side of the point", typed);
}

std::string rpm_mistake(const std::string& typed) {
  const auto rpm = typed_decimal(typed);
  if (rpm && rpm->numerator() > 0) return {};
  return fmt::format("'{}' is no speed: write a number of rpm above 0, such as 60 or 12.5", typed);
}

int run(const ManualOptions& options) {
  ManualArguments arguments = options.arguments;
  if (arguments.task == ManualTask::jog && (::isatty(STDIN_FILENO) != 1 || ::isatty(STDOUT_FILENO) != 1)) {
    fmt::print(stderr,
               "axisgate jog: needs a terminal, for keys are its buttons; for a script there is axisgate move\n");
    return kWrongCommandLine;
  }
  if (arguments.task == ManualTask::move) arguments.turns = typed_decimal(options.turns).value_or(Rational());
  if (!options.rpm.empty()) arguments.rpm = typed_decimal(options.rpm);
  auto found = find_typed_axis(std::string(text(arguments.task)), options.typed);
  if (!found) return 1;
  arguments.axis = found->number;
  if (!found->said.empty()) fmt::print("{}\n", found->said);
  std::fflush(stdout);  // which axis it is must be read before it moves
  // A terminal or pipe that nobody reads is told by the write.
  if (std::signal(SIGPIPE, SIG_IGN) == SIG_ERR) return 1;
  ManualPlan ended(arguments, {});
  {
    // A scope of its own: the terminal is as it was before the last word is said.
    boost::asio::io_context io(1);
    ManualMotion motion(arguments, std::move(found->place), io);
    ended = motion.run();
  }
  return tell_end(options, ended);
}

}  // namespace axisgate::commands
